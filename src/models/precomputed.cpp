#include "models/precomputed.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "effect/frame_constants.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "effect/tables.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/try.hpp"
#include "precomputed_shaders.hpp"

namespace tyndall::models {
namespace {

constexpr std::uint32_t kIntegrationSteps = 16;
// Buffers and dispatches are far below the limits of every device.
constexpr std::size_t kBatchRays = 65536;

// Mirrors setup_block of shaders/probe/precomputed.comp.
struct Setup {
  shared::TableShape shape;
  std::uint32_t integrate_single;
  std::uint32_t steps;
  std::uint32_t visible_ground;
  std::uint32_t unused;
};

shared::ProbeRay probe_ray(const shared::Medium& medium, const RayQuery& query) {
  shared::ProbeRay out = {};
  if (!query.sky_irradiance) {
    out = prepare_probe_ray(medium, ray_from_query(query));
    const bool integrate = tables_lack_single(query.altitude_m, std::cos(query.sun_zenith_rad), medium.planet_radius_m);
    out.integrate_single = integrate ? 1 : 0;
    return out;
  }
  out.altitude_m = static_cast<float>(query.altitude_m);
  out.cos_sun_zenith = static_cast<float>(std::cos(query.sun_zenith_rad));
  out.end_m = -1.0F;
  return out;
}

// No frames are drawn, so their pipelines are not needed. The tables are the same.
Params without_frames(Params params) {
  params.scattering.enabled = false;
  return params;
}

}  // namespace

struct PrecomputedModel::State {
  gpu::Host* host;
  Params params;
  std::unique_ptr<Effect> effect;
  gpu::Pipeline pipeline;
  gpu::Handle<VkSampler> linear;
  tables::Report origin;
};

PrecomputedModel::PrecomputedModel(std::unique_ptr<State> state) : state_(std::move(state)) {}
PrecomputedModel::PrecomputedModel(PrecomputedModel&&) noexcept = default;
PrecomputedModel& PrecomputedModel::operator=(PrecomputedModel&&) noexcept = default;
PrecomputedModel::~PrecomputedModel() = default;

Result<void> PrecomputedModel::set_params(const Params& params) {
  TYNDALL_TRY(state_->effect->set_params(without_frames(params)));
  state_->params = params;
  return {};
}

const Params& PrecomputedModel::params() const { return state_->params; }

Effect& PrecomputedModel::effect() { return *state_->effect; }

const tables::Report& PrecomputedModel::origin() const { return state_->origin; }

Result<PrecomputedModel> PrecomputedModel::create(gpu::Host& host, const Params& params, const tables::MakeReady& how) {
  const gpu::Device& device = host.device();
  auto state = std::make_unique<State>();
  state->host = &host;
  DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical_device;
  info.device = device.device;
  info.get_instance_proc_addr = host.get_instance_proc_addr();
  info.pipeline_cache = device.pipeline_cache;
  EffectDesc desc;
  desc.max_extent = {16, 16};
  desc.frames_in_flight = 1;
  desc.timings = host.timestamps();
  desc.pipeline_threads = gpu::Host::pipeline_threads();
  desc.table_pipelines_later = true;
  state->params = params;
  TYNDALL_ASSIGN(Effect effect, Effect::create(info, desc, without_frames(params)));
  state->effect = std::make_unique<Effect>(std::move(effect));
  TYNDALL_ASSIGN(state->pipeline, gpu::create_compute_pipeline(device, params.scattering.color == ColorMode::spectral
                                                                           ? shaders::precomputed_comp_spectral
                                                                           : shaders::precomputed_comp));
  TYNDALL_ASSIGN(state->linear, gpu::create_sampler(device, {}));
  TYNDALL_ASSIGN(state->origin, tables::make_ready(host, *state->effect, how));
  return PrecomputedModel(std::move(state));
}

Result<std::vector<Answer>> PrecomputedModel::answer(std::span<const RayQuery> queries, bool visible_ground) {
  std::vector<Answer> out(queries.size());
  if (queries.empty()) return out;
  State& s = *state_;
  const gpu::Device& device = s.host->device();
  const Params& params = s.params;
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  Setup setup = {};
  setup.shape = table_shape(params);
  setup.integrate_single = params.scattering.single == SingleScattering::integration ? 1 : 0;
  setup.steps = kIntegrationSteps;
  setup.visible_ground = visible_ground ? 1 : 0;

  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const auto filled = [&](const char* name, const void* data, std::size_t size) -> Result<gpu::Buffer> {
    TYNDALL_ASSIGN(gpu::Buffer buffer, gpu::create_buffer(device, name, size, kUsage, gpu::MemoryKind::upload));
    std::memcpy(buffer.mapped, data, size);
    return buffer;
  };
  std::vector<std::byte> medium_block(kMediumBlockBytes);
  std::memcpy(medium_block.data(), &medium, sizeof medium);
  if (const PhaseRows rows = phase_rows(params, params.scattering.color); !rows.empty()) {
    std::memcpy(medium_block.data() + sizeof medium, rows.data(), kPhaseBytes);
  }
  const std::size_t batch = std::min(queries.size(), kBatchRays);
  TYNDALL_ASSIGN(const gpu::Buffer medium_buffer, filled("probe_medium", medium_block.data(), medium_block.size()));
  TYNDALL_ASSIGN(const gpu::Buffer setup_buffer, filled("probe_setup", &setup, sizeof setup));
  TYNDALL_ASSIGN(
      const gpu::Buffer ray_buffer,
      gpu::create_buffer(device, "probe_rays", batch * sizeof(shared::ProbeRay), kUsage, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(const gpu::Buffer result_buffer,
                 gpu::create_buffer(device, "probe_results", batch * sizeof(shared::ProbeResult), kUsage,
                                    gpu::MemoryKind::readback));
  const ScatteringTables tables = s.effect->scattering_tables();
  const VkSampler linear = s.linear.get();
  constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;
  const gpu::NamedResource resources[] = {
      gpu::named_buffer("medium_block", medium_buffer.buffer.get()),
      gpu::named_buffer("setup_block", setup_buffer.buffer.get()),
      gpu::named_buffer("ray_block", ray_buffer.buffer.get()),
      gpu::named_buffer("result_block", result_buffer.buffer.get()),
      gpu::named_image("single_rayleigh", tables.single_rayleigh.view, kLayout, linear),
      gpu::named_image("single_mie", tables.single_mie.view, kLayout, linear),
      gpu::named_image("high_orders", tables.high_orders.view, kLayout, linear),
      gpu::named_image("sky_irradiance", s.effect->light_tables().sky_irradiance, kLayout, linear),
  };
  const auto wide = [](const Vec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  for (std::size_t first = 0; first < queries.size(); first += batch) {
    const std::size_t count = std::min(batch, queries.size() - first);
    auto* const rays = static_cast<shared::ProbeRay*>(ray_buffer.mapped);
    for (std::size_t i = 0; i < count; ++i) rays[i] = probe_ray(medium, queries[first + i]);
    // The last batch also evaluates rays of the one before, whose results are not read.
    TYNDALL_TRY(s.host->run([&](VkCommandBuffer cmd) -> Result<void> {
      if (Result<void> bound = gpu::bind(s.host->sets(), cmd, s.pipeline, resources); !bound) return bound;
      gpu::dispatch(device, cmd, s.pipeline, static_cast<std::uint32_t>(batch));
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    const auto* results = static_cast<const shared::ProbeResult*>(result_buffer.mapped);
    for (std::size_t i = 0; i < count; ++i) {
      const shared::ProbeResult& r = results[i];
      out[first + i] = {wide(r.radiance), wide(r.transmittance), r.radiance_fourth, r.transmittance_fourth};
    }
  }
  return out;
}

}  // namespace tyndall::models
