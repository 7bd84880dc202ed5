// The insides of the effect: creation, changes of settings and the recording of a frame. Reads from top to bottom
// like the frame itself; the numbers come from frame_constants.cpp, the checks from check.cpp and limits.cpp.
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "effect/effect_state.hpp"
#include "effect/frame_constants.hpp"
#include "effect/limits.hpp"
#include "effect/medium.hpp"
#include "effect/modes.hpp"
#include "effect_shaders.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// Storage buffers may be bound at multiples of this on every device (the largest minimum allowed).
constexpr VkDeviceSize kBufferAlignment = 256;

// Stands in for the shadow maps of a frame that has none; never read.
constexpr gpu::ImageDesc kNoShadows = {"no_shadows", VK_FORMAT_D32_SFLOAT, {1, 1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1,
                                       true};

// Stands in for the colours of a frame that has none; never read.
constexpr gpu::ImageDesc kNoColors = {
    "no_colors", VK_FORMAT_R8G8B8A8_UNORM, {1, 1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1, true};

// A slot of the ring of constants: what one frame in flight reads.
constexpr VkDeviceSize align(VkDeviceSize size) {
  return (size + kBufferAlignment - 1) / kBufferAlignment * kBufferAlignment;
}
constexpr VkDeviceSize kFrameBytes = align(sizeof(shared::FrameConstants));
constexpr VkDeviceSize kCascadeBytes = align(sizeof(CascadeArray));
constexpr VkDeviceSize kMediumBytes = align(sizeof(shared::Medium));
constexpr VkDeviceSize kEpipolarBytes = align(sizeof(shared::EpipolarConstants));
constexpr VkDeviceSize kSlotBytes = kFrameBytes + kCascadeBytes + kMediumBytes + kEpipolarBytes;
static_assert(shared::kMaxCascades == kMaxCascades);
// Counters of a frame, as pairs of words.
constexpr VkDeviceSize kCounterBytes = align(shared::kCounters * sizeof(std::uint64_t));

// Read as storage by most passes, as uniforms by those that unwarp (docs/epipolar.md says why).
constexpr VkBufferUsageFlags kConstantsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
constexpr VkBufferUsageFlags kCounterUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

// Of no_air.comp.
struct NoAirPush {
  VkExtent2D extent;
  VkOffset2D color_offset, output_offset;
};

}  // namespace

Result<void> open_device(gpu::Device& device, const DeviceInfo& info) {
  device.instance = info.instance;
  device.physical_device = info.physical_device;
  device.device = info.device;
  device.allocator = info.allocator;
  device.pipeline_cache = info.pipeline_cache;
  device.replace_shader = info.replace_shader;
  device.replace_shader_user = info.replace_shader_user;
  TYNDALL_TRY(gpu::init_device(device, info.get_instance_proc_addr));
  return check_device(device);
}

MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  MemoryUsage usage;
  usage.persistent = gpu::image_bytes(device, kNoShadows) + gpu::image_bytes(device, kNoColors);
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    usage.persistent += gpu::image_bytes(device, table_desc(static_cast<TableId>(i), params));
  }
  usage.persistent += gpu::buffer_bytes(device, kCounterBytes * FrameRing::slots(desc), kCounterUsage);
  usage.persistent += epipolar_bytes(device, desc, params);
  usage.transient = table_scratch_bytes(device, params);
  usage.host = gpu::buffer_bytes(device, kSlotBytes * FrameRing::slots(desc), kConstantsUsage);
  if (desc.counters) {
    usage.host += gpu::buffer_bytes(device, kCounterBytes * FrameRing::slots(desc), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  return usage;
}

Effect::State::~State() {
  if (info.message == nullptr || !desc.check_inputs || !ring.unfinished()) return;
  info.message(
      info.message_user, Severity::warning,
      "an Effect is destroyed before the commands that it recorded have completed, or without submitting them; "
      "expected to wait for them first");
}

Result<void> Effect::State::create_objects() {
  const bool full = desc.output_format == OutputFormat::rgba32f;
  TYNDALL_ASSIGN(
      no_air, gpu::create_compute_pipeline(device, full ? shaders::no_air_comp_rgba32f : shaders::no_air_comp_rgba16f));
  no_air.name = "no_air";
  TYNDALL_TRY(epipolar.create(device, desc));
  TYNDALL_TRY(tables.create(device, FrameRing::slots(desc), desc.timings));
  TYNDALL_TRY(change(desc, params));
  TYNDALL_ASSIGN(no_shadows, gpu::create_image(device, kNoShadows));
  TYNDALL_ASSIGN(no_colors, gpu::create_image(device, kNoColors));
  TYNDALL_ASSIGN(constants, gpu::create_buffer(device, "constants", kSlotBytes * FrameRing::slots(desc),
                                               kConstantsUsage, gpu::MemoryKind::upload));
  const VkDeviceSize counter_bytes = kCounterBytes * FrameRing::slots(desc);
  TYNDALL_ASSIGN(counters,
                 gpu::create_buffer(device, "counters", counter_bytes, kCounterUsage, gpu::MemoryKind::device));
  if (desc.counters) {
    TYNDALL_ASSIGN(counters_readback, gpu::create_buffer(device, "counters_readback", counter_bytes,
                                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
  }
  TYNDALL_ASSIGN(ring, FrameRing::create(device, desc));
  TYNDALL_TRY(create_samplers());
  if (desc.timings) {
    TYNDALL_ASSIGN(timer, gpu::Timer::create(device, FrameRing::slots(desc), kMaxTimedPasses));
  }
  return {};
}

Result<void> Effect::State::create_samplers() {
  TYNDALL_ASSIGN(linear, gpu::create_sampler(device, {}));
  TYNDALL_ASSIGN(nearest, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));
  gpu::SamplerDesc plain;
  plain.filter = VK_FILTER_NEAREST;
  plain.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  if (desc.shadow_depth_reversed) plain.border = VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK;
  TYNDALL_ASSIGN(shadow_plain, gpu::create_sampler(device, plain));
  gpu::SamplerDesc tint;
  tint.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  TYNDALL_ASSIGN(shadow_tint, gpu::create_sampler(device, tint));
  gpu::SamplerDesc compare;
  compare.compare = true;
  compare.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  if (desc.shadow_depth_reversed) {
    compare.border = VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK;
    compare.compare_op = VK_COMPARE_OP_GREATER_OR_EQUAL;
  }
  TYNDALL_ASSIGN(shadow_compare, gpu::create_sampler(device, compare));
  return {};
}

Result<void> Effect::State::make_march_per_pixel(bool colors, std::uint32_t mode) {
  gpu::Pipeline& out = march_per_pixel[colors ? 1 : 0][mode];
  if (out.pipeline) return {};
  const bool full = desc.output_format == OutputFormat::rgba32f;
  const gpu::Shader& shader = full ? shaders::march_per_pixel_comp_rgba32f : shaders::march_per_pixel_comp_rgba16f;
  const std::array<gpu::Constant, 4> m = mode_constants(mode);
  const gpu::Constant of_march[] = {m[0], m[1], m[2], m[3], {4, colors ? 1U : 0U}, {8, desc.counters ? 1U : 0U}};
  TYNDALL_ASSIGN(out, gpu::create_compute_pipeline(device, shader, of_march));
  out.name = "march_per_pixel";
  return {};
}

Result<void> Effect::State::make_pipelines(const EffectDesc& d, const Params& p) {
  if (!p.scattering.enabled) return {};
  if (p.scattering.technique == Technique::epipolar) return epipolar.prepare(d, p);
  if (d.shadow_colors) TYNDALL_TRY(make_march_per_pixel(true, mode_index(p.scattering)));
  return make_march_per_pixel(false, mode_index(p.scattering));
}

Result<Effect::State::Pending> Effect::State::plan(const EffectDesc& d, const Params& p) {
  TYNDALL_TRY(check_limits(device, d, p));
  TYNDALL_TRY(make_pipelines(d, p));
  Pending pending = {d, p, {}, {}};
  TYNDALL_ASSIGN(pending.epipolar, epipolar.plan(d, p));
  TYNDALL_ASSIGN(pending.tables, tables.plan(p));
  return pending;
}

void Effect::State::commit(Pending&& pending) noexcept {
  epipolar.commit(std::move(pending.epipolar));
  tables.commit(std::move(pending.tables));
  desc = pending.desc;
  params = pending.params;
}

Result<void> Effect::State::change(const EffectDesc& d, const Params& p) {
  TYNDALL_ASSIGN(Pending pending, plan(d, p));
  commit(std::move(pending));
  return {};
}

Result<Progress> Effect::State::prepare_pipelines(std::uint32_t budget) {
  Progress progress;
  for (std::uint32_t mode = 0; mode < kModeCount; ++mode) {
    if (!mode_exists(mode)) continue;
    for (const bool colors : {false, true}) {
      if (colors && !desc.shadow_colors) continue;
      ++progress.total;
      const bool made = static_cast<bool>(march_per_pixel[colors ? 1 : 0][mode].pipeline);
      if (!made && budget > 0) {
        TYNDALL_TRY(make_march_per_pixel(colors, mode));
        --budget;
      } else if (!made) {
        continue;
      }
      ++progress.done;
    }
  }
  TYNDALL_TRY(epipolar.prepare_others(budget, progress));
  return progress;
}

// Labels, binds by name and dispatches one pass over `size` invocations.
Result<void> Effect::State::run(VkCommandBuffer cmd, const gpu::Pipeline& pipeline,
                                std::span<const gpu::NamedResource> resources, const void* push, VkExtent3D size) {
  const gpu::Label label(device, cmd, pipeline.name);
  const std::string_view missing = gpu::bind(device, cmd, pipeline, resources, push);
  if (!missing.empty()) {
    return Error{ErrorCode::invalid_argument,
                 std::string("nothing is bound to ") + std::string(missing) + " of " + pipeline.name};
  }
  gpu::dispatch(device, cmd, pipeline, size.width, size.height, size.depth);
  return {};
}

void Effect::State::prepare_images(VkCommandBuffer cmd) {
  tables.begin_frame(cmd);
  epipolar.begin_frame();
  if (images_ready) return;
  gpu::transition(device, cmd, no_shadows, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  gpu::transition(device, cmd, no_colors, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  images_ready = true;
}

Result<void> Effect::State::record(VkCommandBuffer cmd, const FrameInputs& inputs) {
  State& s = *this;
  TYNDALL_TRY(check_frame(inputs, s.desc, s.params));
  TYNDALL_ASSIGN(const std::optional<std::uint64_t> unfinished, s.ring.take(inputs.frame_index, inputs.view));
  const std::uint32_t slot = s.ring.slot(inputs.frame_index, inputs.view);
  const VkDeviceSize frame_offset = kSlotBytes * slot;
  const VkDeviceSize cascade_offset = frame_offset + kFrameBytes;
  const VkDeviceSize medium_offset = cascade_offset + kCascadeBytes;
  const shared::FrameConstants frame = frame_constants(inputs, s.desc, s.params);
  if (s.desc.check_inputs) s.remarks.on_frame(inputs, {s.desc, s.params, frame, s.tables.ready(), unfinished}, s.info);
  const CascadeArray cascades = cascade_constants(inputs);
  const shared::Medium medium = medium_from_params(s.params);
  std::memcpy(s.mapped(frame_offset), &frame, sizeof frame);
  std::memcpy(s.mapped(cascade_offset), &cascades, sizeof cascades);
  std::memcpy(s.mapped(medium_offset), &medium, sizeof medium);

  const VkDeviceSize epipolar_offset = medium_offset + kMediumBytes;
  const shared::EpipolarConstants slices = epipolar_constants(inputs, s.desc, s.params);
  std::memcpy(s.mapped(epipolar_offset), &slices, sizeof slices);

  if (s.desc.timings) s.timer.begin_frame(cmd, slot);
  s.prepare_images(cmd);
  const VkDeviceSize counter_offset = kCounterBytes * slot;
  if (s.desc.counters) s.clear_counters(cmd, counter_offset);
  const Texture none = {s.no_shadows.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  const Texture& shadows = inputs.cascades.empty() ? none : inputs.shadow_maps;
  const bool colored = has_colors(inputs, s.params);
  const Texture& colors = colored ? inputs.shadow_colors : Texture{s.no_colors.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  const auto table = [&s](const char* name, TableId id) {
    return gpu::named_image(name, s.tables.table(id).view.get(), VK_IMAGE_LAYOUT_GENERAL, s.linear.get());
  };
  const gpu::NamedResource resources[] = {
      gpu::named_buffer("medium_block", s.constants.buffer.get(), medium_offset, sizeof medium),
      gpu::named_buffer("frame_block", s.constants.buffer.get(), frame_offset, sizeof frame),
      gpu::named_buffer("cascade_block", s.constants.buffer.get(), cascade_offset, sizeof cascades),
      gpu::named_buffer("epipolar_block", s.constants.buffer.get(), epipolar_offset, sizeof slices),
      gpu::named_buffer("counter_block", s.counters.buffer.get(), counter_offset, kCounterBytes),
      gpu::named_image("scene_color", inputs.color.view, inputs.color.layout, s.nearest.get()),
      gpu::named_image("scene_depth", inputs.depth.view, inputs.depth.layout, s.nearest.get()),
      gpu::named_image("shadow_maps", shadows.view, shadows.layout, s.shadow_compare.get()),
      gpu::named_image("shadow_depths", shadows.view, shadows.layout, s.shadow_plain.get()),
      gpu::named_image("shadow_colors", colors.view, colors.layout, s.shadow_tint.get()),
      table("single_rayleigh", TableId::single_rayleigh),
      table("single_mie", TableId::single_mie),
      table("high_orders", TableId::high_orders),
      gpu::named_image("output_color", inputs.output.view, inputs.output.layout),
  };
  gpu::Timer* passes = s.desc.timings ? &s.timer : nullptr;
  if (s.params.scattering.enabled && s.params.scattering.technique == Technique::epipolar) {
    TYNDALL_TRY(s.epipolar.record(cmd, inputs, s.params, resources, passes));
  } else {
    const gpu::Pipeline& pipeline =
        s.params.scattering.enabled ? s.march_per_pixel[colored ? 1 : 0][mode_index(s.params.scattering)] : s.no_air;
    if (passes != nullptr) passes->begin(cmd, pipeline.name);
    const NoAirPush push = {inputs.extent, inputs.color.offset, inputs.output.offset};
    TYNDALL_TRY(s.run(cmd, pipeline, resources, &push, {inputs.extent.width, inputs.extent.height, 1}));
    if (passes != nullptr) passes->end(cmd);
  }
  if (s.desc.counters) s.copy_counters(cmd, counter_offset);
  s.ring.record_end(cmd, inputs.frame_index, inputs.view);
  return {};
}

void Effect::State::clear_counters(VkCommandBuffer cmd, VkDeviceSize offset) {
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_TRANSFER_WRITE_BIT);
  device.vk.CmdFillBuffer(cmd, counters.buffer.get(), offset, kCounterBytes, 0);
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

void Effect::State::copy_counters(VkCommandBuffer cmd, VkDeviceSize offset) {
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
  const VkBufferCopy region = {offset, offset, kCounterBytes};
  device.vk.CmdCopyBuffer(cmd, counters.buffer.get(), counters_readback.buffer.get(), 1, &region);
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
               VK_ACCESS_HOST_READ_BIT);
}

Counters Effect::State::read_counters(std::uint64_t frame_index, std::uint32_t view) const {
  if (!desc.counters || view >= desc.views) return {};
  std::uint64_t values[shared::kCounters];
  std::memcpy(values,
              static_cast<const std::byte*>(counters_readback.mapped) + kCounterBytes * ring.slot(frame_index, view),
              sizeof values);
  return {values[shared::kSamplesMarched], values[shared::kMarchSteps], values[shared::kNodesVisited],
          values[shared::kShadowFetches], values[shared::kPixelsCorrected]};
}

std::span<const ResourceMemory> Effect::State::list_resources() {
  std::size_t used = 0;
  const auto row = [&](const char* name, VkDeviceSize bytes) { resource_rows[used++] = {name, bytes}; };
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const gpu::Image& table = tables.table(static_cast<TableId>(i));
    row(table.desc.name, table.bytes);
  }
  row(no_shadows.desc.name, no_shadows.bytes);
  row(no_colors.desc.name, no_colors.bytes);
  row("counters", counters.bytes);
  for (std::uint32_t i = 0; i < kEpipolarBuffers; ++i) {
    const auto buffer = static_cast<EpipolarBuffer>(i);
    if (epipolar.bytes(buffer) > 0) row(epipolar_buffer_name(buffer), epipolar.bytes(buffer));
  }
  return {resource_rows.data(), used};
}

MemoryUsage Effect::State::memory() const {
  return {tables.persistent_bytes() + no_shadows.bytes + no_colors.bytes + counters.bytes + epipolar.bytes(),
          tables.transient_bytes() + epipolar.retired_bytes(), constants.bytes + counters_readback.bytes};
}

std::span<const PassTiming> Effect::State::read_timings(std::uint64_t frame_index, std::uint32_t view) {
  if (!desc.timings || view >= desc.views) return {};
  const std::span<const gpu::TimedScope> scopes = timer.read(ring.slot(frame_index, view));
  const std::size_t count = std::min(scopes.size(), timings.size());
  for (std::size_t i = 0; i < count; ++i) timings[i] = {scopes[i].name, scopes[i].milliseconds};
  return {timings.data(), count};
}

}  // namespace tyndall
