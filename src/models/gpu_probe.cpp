#include "models/gpu_probe.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/descriptors.hpp"
#include "gpu/try.hpp"
#include "probe_shaders.hpp"

namespace tyndall::models {
namespace {

constexpr std::size_t kBatchRays = 16384;  // takes well below a second on a CPU device

std::array<double, 3> widened(const Vec3& v) { return {v.x, v.y, v.z}; }

// Evaluates rays with the pipeline of one of the shaders of shaders/probe. The shader reads the medium, the rays and
// the resources in `more`.
Result<std::vector<Answer>> evaluate(gpu::Host& host, const gpu::Pipeline& pipeline,
                                     const shared::SpectralMedium& medium, const PhaseRows& phase,
                                     std::span<const gpu::NamedResource> more, std::span<const Ray> rays,
                                     const std::function<void(std::size_t)>& progress) {
  std::vector<Answer> answers;
  if (rays.empty()) return answers;
  const gpu::Device& device = host.device();
  const std::size_t batch = std::min(rays.size(), kBatchRays);
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  TYNDALL_ASSIGN(const gpu::Buffer medium_buffer,
                 gpu::create_buffer(device, "probe_medium", kMediumBlockBytes, kStorage, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(
      const gpu::Buffer ray_buffer,
      gpu::create_buffer(device, "probe_rays", batch * sizeof(shared::ProbeRay), kStorage, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(const gpu::Buffer result_buffer,
                 gpu::create_buffer(device, "probe_results", batch * sizeof(shared::ProbeResult), kStorage,
                                    gpu::MemoryKind::readback));
  std::memcpy(medium_buffer.mapped, &medium, sizeof medium);
  if (!phase.empty()) {
    std::memcpy(static_cast<std::byte*>(medium_buffer.mapped) + sizeof medium, phase.data(), kPhaseBytes);
  }
  auto* const prepared = static_cast<shared::ProbeRay*>(ray_buffer.mapped);
  const auto* const results = static_cast<const shared::ProbeResult*>(result_buffer.mapped);

  answers.reserve(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i) prepared[i] = prepare_probe_ray(medium, rays[first + i]);
    TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
      // The shader derives the number of rays from the size of their buffer.
      std::vector<gpu::NamedResource> resources = {
          gpu::named_buffer("medium_block", medium_buffer.buffer.get()),
          gpu::named_buffer("ray_block", ray_buffer.buffer.get(), 0, count * sizeof(shared::ProbeRay)),
          gpu::named_buffer("result_block", result_buffer.buffer.get(), 0, count * sizeof(shared::ProbeResult)),
      };
      resources.insert(resources.end(), more.begin(), more.end());
      if (Result<void> bound = gpu::bind(host.sets(), cmd, pipeline, resources); !bound) return bound;
      gpu::dispatch(device, cmd, pipeline, static_cast<std::uint32_t>(count));
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    for (std::size_t i = 0; i < count; ++i) {
      const shared::ProbeResult& r = results[i];
      answers.push_back({widened(r.radiance), widened(r.transmittance), r.radiance_fourth, r.transmittance_fourth});
    }
    if (progress) progress(first + count);
  }
  return answers;
}

}  // namespace

Result<std::vector<Answer>> single_scattering_on_gpu(gpu::Host& host, const shared::SpectralMedium& medium,
                                                     const PhaseRows& phase, ColorMode color, std::span<const Ray> rays,
                                                     const std::function<void(std::size_t)>& progress) {
  if (rays.empty()) return std::vector<Answer>();
  TYNDALL_ASSIGN(const SingleScatteringOnGpu model, SingleScatteringOnGpu::create(host, color));
  return model.answer(medium, phase, rays, progress);
}

Result<SingleScatteringOnGpu> SingleScatteringOnGpu::create(gpu::Host& host, ColorMode color) {
  SingleScatteringOnGpu out;
  out.host_ = &host;
  const bool spectral = color == ColorMode::spectral;
  TYNDALL_ASSIGN(out.pipeline_, gpu::create_compute_pipeline(
                                    host.device(), spectral ? shaders::single_comp_spectral : shaders::single_comp));
  return out;
}

Result<std::vector<Answer>> SingleScatteringOnGpu::answer(const shared::SpectralMedium& medium, const PhaseRows& phase,
                                                          std::span<const Ray> rays,
                                                          const std::function<void(std::size_t)>& progress) const {
  return evaluate(*host_, pipeline_, medium, phase, {}, rays, progress);
}

Result<std::vector<Answer>> single_scattering_on_gpu(gpu::Host& host, const shared::Medium& medium,
                                                     std::span<const Ray> rays,
                                                     const std::function<void(std::size_t)>& progress) {
  return single_scattering_on_gpu(host, {medium, {}}, {}, ColorMode::rgb, rays, progress);
}

Result<std::vector<Answer>> oneil_on_gpu(gpu::Host& host, const OneilModel& model, std::span<const Ray> rays) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const std::size_t table_bytes = model.table.size() * sizeof model.table[0];
  TYNDALL_ASSIGN(const gpu::Buffer constants,
                 gpu::create_buffer(host.device(), "oneil", sizeof model.constants, kStorage, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(const gpu::Buffer table,
                 gpu::create_buffer(host.device(), "oneil_table", table_bytes, kStorage, gpu::MemoryKind::upload));
  std::memcpy(constants.mapped, &model.constants, sizeof model.constants);
  std::memcpy(table.mapped, model.table.data(), table_bytes);
  const gpu::NamedResource more[] = {gpu::named_buffer("oneil_block", constants.buffer.get()),
                                     gpu::named_buffer("oneil_table_block", table.buffer.get())};
  TYNDALL_ASSIGN(const gpu::Pipeline pipeline, gpu::create_compute_pipeline(host.device(), shaders::oneil_comp));
  return evaluate(host, pipeline, {model.medium, {}}, {}, more, rays, {});
}

}  // namespace tyndall::models
