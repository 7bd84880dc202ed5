// Looks up the cube map of a sky probe with tyndall/sky_probe.glsl.
#pragma once

#include <array>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/descriptors.hpp"
#include "gpu/try.hpp"
#include "gpu_test.hpp"
#include "sky_test_shaders.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {

// queries: directions, and the roughness in w.
inline std::vector<glm::dvec3> look_up(gpu::Host& host, const SkyCube& cube, const std::vector<glm::vec4>& queries) {
  const gpu::Device& device = host.device();
  const VkDeviceSize size = queries.size() * sizeof(glm::vec4);
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  Result<gpu::Buffer> from = gpu::create_buffer(device, "queries", size, kUsage, gpu::MemoryKind::upload);
  Result<gpu::Buffer> to = gpu::create_buffer(device, "results", size, kUsage, gpu::MemoryKind::readback);
  Result<gpu::Pipeline> pipeline = gpu::create_compute_pipeline(device, shaders::sky_cube_look_ups_comp);
  EXPECT_OK(from);
  EXPECT_OK(to);
  EXPECT_OK(pipeline);
  std::memcpy(from.value().mapped, queries.data(), size);
  const gpu::NamedResource resources[] = {
      gpu::named_image("sky_cube", cube.view, VK_IMAGE_LAYOUT_GENERAL, cube.sampler),
      gpu::named_buffer("query_block", from.value().buffer.get()),
      gpu::named_buffer("result_block", to.value().buffer.get())};
  EXPECT_OK(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    TYNDALL_TRY(gpu::bind(host.sets(), cmd, pipeline.value(), resources));
    gpu::dispatch(device, cmd, pipeline.value(), static_cast<std::uint32_t>(queries.size()));
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::vector<glm::dvec3> out;
  const auto* results = static_cast<const float*>(to.value().mapped);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    out.emplace_back(results[4 * i], results[4 * i + 1], results[4 * i + 2]);
  }
  return out;
}

}  // namespace tyndall
