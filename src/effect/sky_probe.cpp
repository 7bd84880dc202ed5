#include "tyndall/sky_probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "effect/effect_state.hpp"
#include "effect/frame_constants.hpp"
#include "effect/invalid.hpp"
#include "effect/limits.hpp"
#include "effect/sky_cube.hpp"
#include "effect/sky_probe_steps.hpp"
#include "effect/spectral_medium.hpp"
#include "gpu/guard.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// The largest alignment that Vulkan allows devices to require of offsets.
constexpr VkDeviceSize kMediumOffset = 256;
static_assert(sizeof(shared::SkyProbeConstants) <= kMediumOffset);
constexpr VkDeviceSize kSlotBytes = kMediumOffset + (kMediumBlockBytes + 255) / 256 * 256;
constexpr VkDeviceSize kCoefficientBytes = 9 * 4 * sizeof(float);
constexpr VkDeviceSize kRowBytes = VkDeviceSize{shared::kSkyProbeRows} * shared::kSkyProbeSums * 4 * sizeof(float);
constexpr VkBufferUsageFlags kConstantsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kRowsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kCoefficientsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

Result<void> check(const char* where, const SkyProbeDesc& desc) {
  const std::uint32_t frames = desc.frames_in_flight;
  if (frames >= 1 && frames <= 8) return check_cube_size(where, desc.cube_size);
  return invalid(std::string(where) + ": invalid frames_in_flight " + std::to_string(frames) + "; expected 1 to 8");
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

double dot(const Vec3& a, const Vec3& b) {
  return static_cast<double>(a.x) * static_cast<double>(b.x) + static_cast<double>(a.y) * static_cast<double>(b.y) +
         static_cast<double>(a.z) * static_cast<double>(b.z);
}

Result<void> check_unit(const char* name, const Vec3& v) {
  if (finite(v) && std::abs(dot(v, v) - 1.0) < 2e-3) return {};
  return invalid(std::string("SkyProbe::record: ") + name + " is not a unit vector; its squared length is " +
                 std::to_string(dot(v, v)) + "; expected 1");
}

Result<void> check_inputs(const SkyProbeInputs& inputs, const Params& params) {
  TYNDALL_TRY(check_unit("SkyProbeInputs::up", inputs.up));
  TYNDALL_TRY(check_unit("Sun::direction_to_sun", inputs.sun.direction_to_sun));
  const Vec3& e = inputs.sun.irradiance;
  if (!finite(e) || e.x < 0.0F || e.y < 0.0F || e.z < 0.0F) {
    return invalid("SkyProbe::record: Sun::irradiance is negative or not finite; expected three values of at least 0");
  }
  const float lowest_m = -0.25F * params.planet.radius_m;
  if (!(inputs.altitude_m >= lowest_m && inputs.altitude_m <= params.atmosphere.height_m)) {
    return invalid("SkyProbe::record: SkyProbeInputs::altitude_m is " + std::to_string(inputs.altitude_m) +
                   "; expected " + std::to_string(lowest_m) + " (a quarter of planet.radius_m below the sea) to " +
                   std::to_string(params.atmosphere.height_m) + " (atmosphere.height_m)");
  }
  if (params.scattering.medium == MediumKind::homogeneous) {
    return invalid("SkyProbe::record: scattering.medium is homogeneous, which has no sky; expected atmosphere");
  }
  return {};
}

Vec3 sum(const Vec3& a, double s, const Vec3& b, double t) {
  const auto of = [&](float x, float y) {
    return static_cast<float>(static_cast<double>(x) * s + static_cast<double>(y) * t);
  };
  return {of(a.x, b.x), of(a.y, b.y), of(a.z, b.z)};
}

shared::SkyProbeConstants constants_of(const SkyProbeInputs& inputs, const Params& params, std::uint32_t cube_size) {
  shared::SkyProbeConstants out = {};
  const Vec3& sun = inputs.sun.direction_to_sun;
  const Vec3 up = sum(inputs.up, 1.0 / std::sqrt(dot(inputs.up, inputs.up)), {}, 0.0);
  const double cosine = std::clamp(dot(up, sun) / std::sqrt(dot(sun, sun)), -1.0, 1.0);
  Vec3 ahead = sum(sun, 1.0, up, -dot(up, sun));
  // The sine is not computed from the cosine, because the cosine is rounded to 1 near the zenith.
  double sine = std::sqrt(dot(ahead, ahead) / dot(sun, sun));
  // Any horizontal direction will do for a sun at the zenith or below the nadir.
  if (sine < 1e-6) {
    const Vec3 axis = std::abs(up.x) < 0.5F ? Vec3(1.0F, 0.0F, 0.0F) : Vec3(0.0F, 1.0F, 0.0F);
    ahead = sum(axis, 1.0, up, -dot(axis, up));
    sine = 0.0;
  }
  ahead = sum(ahead, 1.0 / std::sqrt(dot(ahead, ahead)), {}, 0.0);
  const float scale = params.scattering.scale;
  const Vec3& e = inputs.sun.irradiance;
  out.up = up;
  out.ahead = ahead;
  out.side = {up.y * ahead.z - up.z * ahead.y, up.z * ahead.x - up.x * ahead.z, up.x * ahead.y - up.y * ahead.x};
  out.cos_sun_zenith = static_cast<float>(cosine);
  out.sin_sun_zenith = static_cast<float>(sine);
  out.altitude_m = inputs.altitude_m;
  out.irradiance = {e.x * scale, e.y * scale, e.z * scale};
  out.integrate_single = tables_lack_single(inputs.altitude_m, cosine, params.planet.radius_m) ? 1 : 0;
  out.shape = table_shape(params);
  out.cube_size = cube_size;
  return out;
}

MemoryUsage plan(const gpu::Device& device, const SkyProbeDesc& desc) {
  MemoryUsage out;
  out.persistent = gpu::buffer_bytes(device, kRowBytes, kRowsUsage) +
                   gpu::buffer_bytes(device, kCoefficientBytes, kCoefficientsUsage) +
                   sky_cube_bytes(device, desc.cube_size);
  out.host = gpu::buffer_bytes(device, kSlotBytes * desc.frames_in_flight, kConstantsUsage);
  return out;
}

}  // namespace

struct TYNDALL_HIDDEN SkyProbe::State {
  Effect::State* effect = nullptr;
  SkyProbeDesc desc;
  PipelineCache pipelines;
  SetCache sets;
  FrameRing ring;
  std::uint64_t calls = 0;  // successful calls of record()
  gpu::Buffer constants;    // a slot per pending call
  gpu::Buffer rows, coefficients;
  SkyCubeMap cube;
  std::array<std::vector<Step>, 2> steps;  // for tables with scattering.color = rgb, and with spectral
  // The update: its constants, the tables that it reads, and its slices.
  shared::SkyProbeConstants probe = {};
  shared::SpectralMedium medium = {};
  PhaseRows phase;  // phase function of the aerosol
  std::uint64_t tables_version = 0;
  std::uint32_t done = 0;
  bool cleared = false;

  Result<void> create_objects();
  Result<Progress> record(VkCommandBuffer cmd, const SkyProbeInputs& wanted, std::uint32_t budget);
  [[nodiscard]] BoundResources bind_resources(VkDeviceSize offset) const;
};

Result<void> SkyProbe::State::create_objects() {
  const std::uint32_t frames = desc.frames_in_flight;
  phase.reserve(shared::kPhaseNodes);
  const gpu::Device& device = effect->device;
  pipelines.create(device, effect->desc.pipeline_threads);
  sets.create(device, frames);
  std::vector<PipelineKey> keys;
  std::vector<SetKey> set_keys;
  steps = {sky_probe_steps(ColorMode::rgb, desc.cube_size), sky_probe_steps(ColorMode::spectral, desc.cube_size)};
  for (const std::vector<Step>& list : steps) {
    for (const Step& step : list) {
      if (std::find(keys.begin(), keys.end(), step.pipeline) != keys.end()) continue;
      keys.push_back(step.pipeline);
      set_keys.push_back(set_key(step));
    }
  }
  TYNDALL_TRY(pipelines.make(keys));
  TYNDALL_TRY(sets.make(set_keys, pipelines));
  EffectDesc slots;
  slots.frames_in_flight = frames;
  TYNDALL_ASSIGN(ring, FrameRing::create(device, slots));
  TYNDALL_ASSIGN(constants, gpu::create_buffer(device, "sky_probe", kSlotBytes * frames, kConstantsUsage,
                                               gpu::MemoryKind::constants));
  TYNDALL_ASSIGN(rows, gpu::create_buffer(device, "sky_probe_rows", kRowBytes, kRowsUsage, gpu::MemoryKind::device));
  TYNDALL_ASSIGN(coefficients, gpu::create_buffer(device, "sky_coefficients", kCoefficientBytes, kCoefficientsUsage,
                                                  gpu::MemoryKind::device));
  TYNDALL_ASSIGN(cube, SkyCubeMap::create(device, desc.cube_size));
  return {};
}

BoundResources SkyProbe::State::bind_resources(VkDeviceSize offset) const {
  BoundResources out;
  const VkBuffer buffer = constants.buffer.get();
  out.set(Resource::sky_probe, buffer, offset, sizeof(shared::SkyProbeConstants));
  out.set(Resource::medium, buffer, offset + kMediumOffset, kMediumBlockBytes);
  out.set(Resource::sky_probe_rows, rows.buffer.get());
  out.set(Resource::sky_coefficients, coefficients.buffer.get());
  cube.bind(out);
  const auto table = [&](Resource resource, TableId id) {
    out.set(resource, effect->tables.table(id).view.get(), VK_IMAGE_LAYOUT_GENERAL, effect->linear.get());
  };
  table(Resource::single_rayleigh, TableId::single_rayleigh);
  table(Resource::single_mie, TableId::single_mie);
  table(Resource::high_orders, TableId::high_orders);
  table(Resource::sky_irradiance_table, TableId::sky_irradiance);
  return out;
}

Result<Progress> SkyProbe::State::record(VkCommandBuffer cmd, const SkyProbeInputs& wanted, std::uint32_t budget) {
  const Params params = effect->table_params();
  const std::vector<Step>& slices = steps[params.scattering.color == ColorMode::spectral ? 1 : 0];
  const auto total = static_cast<std::uint32_t>(slices.size());
  TYNDALL_TRY(check_inputs(wanted, params));
  if (!effect->tables.ready()) {
    return invalid("SkyProbe::record: the tables were never built; expected record_precompute() or "
                   "record_load_tables() until precompute_progress() is complete");
  }
  if (budget == 0) return Progress{done, total};
  if (!ring.take(calls, 0)) {
    return invalid("SkyProbe::record: the commands of an earlier call have not completed or were never submitted; "
                   "expected at most frames_in_flight pending calls, and a new SkyProbe after commands were dropped");
  }
  // The parts of an update must come from the same tables.
  const bool other_tables = calls == 0 || tables_version != effect->tables.version();
  if (done == total || other_tables) done = 0;
  if (other_tables) phase_rows(params, params.scattering.color, phase);
  if (done == 0) {
    tables_version = effect->tables.version();
    probe = constants_of(wanted, params, desc.cube_size);
    medium = spectral_medium_from_params(params);
  }
  const gpu::Device& device = effect->device;
  const std::uint32_t slot = ring.slot(calls, 0);
  const VkDeviceSize offset = kSlotBytes * slot;
  std::memcpy(static_cast<std::byte*>(constants.mapped) + offset, &probe, sizeof probe);
  std::memcpy(static_cast<std::byte*>(constants.mapped) + offset + kMediumOffset, &medium, sizeof medium);
  if (!phase.empty()) {
    std::memcpy(static_cast<std::byte*>(constants.mapped) + offset + kMediumOffset + sizeof medium, phase.data(),
                kPhaseBytes);
  }
  if (!cleared) {
    device.vk.CmdFillBuffer(cmd, coefficients.buffer.get(), 0, kCoefficientBytes, 0);
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    cube.record_clear(cmd);
    cleared = true;
  }
  const BoundResources resources = bind_resources(offset);
  sets.begin(slot);
  StepRecorder recorder(device, cmd, pipelines, sets, slot, resources, nullptr);
  for (const Resource resource : {Resource::sky_probe_rows, Resource::sky_cube_radiance, Resource::sky_cube_texels}) {
    recorder.assume(resource, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  }
  for (; budget > 0 && done < total; --budget, ++done) {
    const bool last = done + 1 == total;
    if (last) {
      // The caller's commands may read the coefficients in any stage.
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
    }
    TYNDALL_TRY(recorder.record(slices[done]));
    if (last) cube.record_copy(cmd);
  }
  ring.record_end(cmd, calls, 0);
  ++calls;
  return Progress{done, total};
}

SkyProbe::SkyProbe(std::unique_ptr<State> state) : state_(std::move(state)) {}
SkyProbe::SkyProbe(SkyProbe&&) noexcept = default;
SkyProbe& SkyProbe::operator=(SkyProbe&&) noexcept = default;
SkyProbe::~SkyProbe() = default;

Result<MemoryUsage> SkyProbe::query_memory(const DeviceInfo& info, const SkyProbeDesc& desc) {
  return guarded("SkyProbe::query_memory", [&]() -> Result<MemoryUsage> {
    TYNDALL_TRY(check_desc(info, {}));
    TYNDALL_TRY(check("SkyProbe::query_memory", desc));
    gpu::Device device;
    TYNDALL_TRY(open_checked_device(device, info));
    return plan(device, desc);
  });
}

Result<SkyProbe> SkyProbe::create(Effect& effect, const SkyProbeDesc& desc) {
  return guarded("SkyProbe::create", [&]() -> Result<SkyProbe> {
    if (!effect.state_) return invalid("SkyProbe::create: the Effect was moved from; expected a valid one");
    TYNDALL_TRY(check("SkyProbe::create", desc));
    auto state = std::make_unique<State>();
    state->effect = effect.state_.get();
    state->desc = desc;
    TYNDALL_TRY(state->create_objects());
    return SkyProbe(std::move(state));
  });
}

Result<Progress> SkyProbe::record(VkCommandBuffer cmd, const SkyProbeInputs& inputs, std::uint32_t budget) {
  return guarded("SkyProbe::record", [&]() -> Result<Progress> {
    if (!state_) return invalid("SkyProbe::record: the SkyProbe was moved from; expected a valid one");
    if (cmd == VK_NULL_HANDLE) {
      return invalid("SkyProbe::record: the command buffer is null; expected one that is being recorded");
    }
    return state_->record(cmd, inputs, budget);
  });
}

SkyCoefficients SkyProbe::coefficients() const {
  if (!state_) return {};
  return {state_->coefficients.buffer.get(), 0, kCoefficientBytes};
}

SkyCube SkyProbe::cube() const { return state_ ? state_->cube.cube() : SkyCube{}; }

MemoryUsage SkyProbe::memory() const {
  if (!state_) return {};
  return {state_->rows.bytes + state_->coefficients.bytes + state_->cube.bytes(), 0, state_->constants.bytes};
}

}  // namespace tyndall
