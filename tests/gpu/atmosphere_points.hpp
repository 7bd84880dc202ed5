// Evaluates the functions of tyndall/atmosphere.glsl on a device, with the images of an effect, as an engine does.
#pragma once

#include <cstring>
#include <vector>

#include "atmosphere_test_shaders.hpp"
#include "effect_frame.hpp"
#include "tyndall/atmosphere.hpp"

namespace tyndall {

enum Function {
  sun_irradiance,
  sky_irradiance,
  sky_radiance,
  to_sky,
  between,
  between_shadowed,
  froxel,
  through_froxels
};

// Mirrors the structure of atmosphere_points.comp.
struct Query {
  float from[3];
  float function;
  float other[3];
  float steps;
  float plane[4];
};
struct Answer {
  glm::dvec3 light, transmittance;
};

inline Query query(Function function, const glm::dvec3& from, const glm::dvec3& other, double steps = 0.0) {
  Query q = {};
  for (int i = 0; i < 3; ++i) {
    q.from[i] = static_cast<float>(from[i]);
    q.other[i] = static_cast<float>(other[i]);
  }
  q.function = static_cast<float>(function);
  q.steps = static_cast<float>(steps);
  q.plane[3] = 1.0F;  // lit everywhere
  return q;
}

// `clouds`: the map for inputs.clouds_from_position, with a sampler; null for none.
inline std::vector<Answer> evaluate_points(gpu::Host& host, const Effect& effect, const Params& params,
                                           const AtmosphereInputs& inputs, const std::vector<Query>& queries,
                                           const VkDescriptorImageInfo* clouds = nullptr) {
  const Result<AtmosphereConstants> constants = atmosphere_constants(params, inputs);
  const gpu::Device& device = host.device();
  const bool spectral = params.scattering.color == ColorMode::spectral;
  const bool rows = params.atmosphere.mie_phase >= MiePhase::draine;  // only tested with four wavelengths
  Result<gpu::Pipeline> pipeline =
      gpu::create_compute_pipeline(device, rows       ? shaders::atmosphere_points_comp_spectral_phase
                                           : spectral ? shaders::atmosphere_points_comp_spectral
                                           : clouds   ? shaders::atmosphere_points_comp_clouds
                                                      : shaders::atmosphere_points_comp);
  const auto buffer = [&](const void* data, std::size_t size, VkBufferUsageFlags usage) {
    Result<gpu::Buffer> out = gpu::create_buffer(device, "test", size, usage, gpu::MemoryKind::readback);
    EXPECT_OK(out);
    if (data != nullptr) std::memcpy(out.value().mapped, data, size);
    return std::move(out).value();
  };
  std::vector<Answer> out(queries.size());
  EXPECT_OK(constants);
  EXPECT_OK(pipeline);
  if (!constants.ok() || !pipeline.ok()) return out;
  const gpu::Buffer block = buffer(&constants.value(), sizeof(AtmosphereConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  const gpu::Buffer in = buffer(queries.data(), queries.size() * sizeof(Query), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const gpu::Buffer answers = buffer(nullptr, queries.size() * 32, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  std::vector<gpu::NamedResource> resources = {gpu::named_buffer("tyndall_constants_block", block.buffer.get()),
                                               gpu::named_buffer("query_block", in.buffer.get()),
                                               gpu::named_buffer("answer_block", answers.buffer.get())};
  AtmospherePhase phase;
  if (rows) EXPECT_OK(atmosphere_phase(params, phase));
  const gpu::Buffer phase_rows = buffer(&phase, sizeof phase, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  if (rows) resources.push_back(gpu::named_buffer("tyndall_phase_rows_block", phase_rows.buffer.get()));
  const AtmosphereImages images = atmosphere_images(effect);
  for (const gpu::Binding& binding : pipeline.value().bindings) {
    if (binding.binding < 4) continue;  // TYNDALL_FIRST_BINDING is 3
    if (clouds != nullptr && binding.binding == 10) {
      resources.push_back(gpu::named_image(binding.name, clouds->imageView, clouds->imageLayout, clouds->sampler));
      continue;
    }
    // Without the froxel volume, a table stands for its images. It is not read.
    const VkDescriptorImageInfo& info = images.list[binding.binding - 4 < images.count ? binding.binding - 4 : 1];
    resources.push_back(gpu::named_image(binding.name, info.imageView, info.imageLayout, info.sampler));
  }
  EXPECT_OK(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    if (Result<void> bound = gpu::bind(host.sets(), cmd, pipeline.value(), resources); !bound.ok()) return bound;
    gpu::dispatch(device, cmd, pipeline.value(), static_cast<std::uint32_t>(queries.size()));
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  const auto* values = static_cast<const float*>(answers.mapped);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* v = values + 8 * i;
    out[i] = {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}};
  }
  return out;
}

}  // namespace tyndall
