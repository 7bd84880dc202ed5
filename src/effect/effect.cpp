// Creates the effect and records a frame. effect_changes.cpp changes its settings. The steps of a frame are in
// frame_steps.cpp, its constants in frame_constants.cpp and epipolar_constants.cpp, and the checks in check.cpp and
// limits.cpp.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "air/phase.hpp"
#include "effect/effect_state.hpp"
#include "effect/epipolar_constants.hpp"
#include "effect/frame_constants.hpp"
#include "effect/frame_steps.hpp"
#include "effect/limits.hpp"
#include "effect/modes.hpp"
#include "effect/spectral_medium.hpp"
#include "gpu/open_device.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// The largest value of minStorageBufferOffsetAlignment that Vulkan allows, so it suits every device.
constexpr VkDeviceSize kBufferAlignment = 256;

// Bound instead of the shadow maps if a frame has none. It is never read.
constexpr gpu::ImageDesc kNoShadows = {"no_shadows", VK_FORMAT_D32_SFLOAT, {1, 1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1,
                                       true};

// Bound instead of the shadow colours if a frame has none. It is never read.
constexpr gpu::ImageDesc kNoColors = {
    "no_colors", VK_FORMAT_R8G8B8A8_UNORM, {1, 1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1, true};

// Bound instead of the map of clouds if a frame has none. It is never read.
constexpr gpu::ImageDesc kNoClouds = {"no_clouds", VK_FORMAT_R8G8B8A8_UNORM, {1, 1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT};

constexpr VkDeviceSize align(VkDeviceSize size) {
  return (size + kBufferAlignment - 1) / kBufferAlignment * kBufferAlignment;
}
// Sizes and offsets in a slot of the ring of constants. Each view of a frame in flight has a slot.
constexpr VkDeviceSize kFrameBytes = align(sizeof(shared::FrameConstants));
constexpr VkDeviceSize kCascadeBytes = align(sizeof(CascadeArray));
constexpr VkDeviceSize kMediumBytes = align(kMediumBlockBytes);
constexpr VkDeviceSize kEpipolarBytes = align(sizeof(shared::EpipolarConstants));
constexpr VkDeviceSize kCascadeOffset = kFrameBytes;
constexpr VkDeviceSize kMediumOffset = kCascadeOffset + kCascadeBytes;
constexpr VkDeviceSize kEpipolarOffset = kMediumOffset + kMediumBytes;
constexpr VkDeviceSize kSlotBytes = kEpipolarOffset + kEpipolarBytes;
static_assert(shared::kMaxCascades == kMaxCascades);
// The counters of a frame are 64-bit integers, which shaders see as pairs of words.
constexpr VkDeviceSize kCounterBytes = align(shared::kCounters * sizeof(std::uint64_t));

// Most passes read the constants as storage buffers, a few as uniform buffers (docs/epipolar.md explains why).
constexpr VkBufferUsageFlags kConstantsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
constexpr VkBufferUsageFlags kCounterUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

}  // namespace

Result<void> open_checked_device(gpu::Device& device, const DeviceInfo& info) {
  TYNDALL_TRY(gpu::open_device(device, info));
  return check_device(device);
}

MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  MemoryUsage usage;
  for (const gpu::ImageDesc& image : {kNoShadows, kNoColors, kNoClouds}) {
    usage.persistent += gpu::image_bytes(device, image);
  }
  if (desc.tables_of == nullptr) {
    for (std::uint32_t i = 0; i < kTableCount; ++i)
      usage.persistent += gpu::image_bytes(device, table_desc(static_cast<TableId>(i), params));
    usage.transient = table_scratch_bytes(device, params);
  }
  usage.persistent += gpu::buffer_bytes(device, kCounterBytes * FrameRing::slots(desc), kCounterUsage);
  usage.persistent += frame_buffer_bytes(device, desc, params) + froxel_bytes(device, desc, params);
  usage.host = gpu::buffer_bytes(device, kSlotBytes * FrameRing::slots(desc), kConstantsUsage);
  if (desc.counters) {
    usage.host += gpu::buffer_bytes(device, kCounterBytes * FrameRing::slots(desc), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  return usage;
}

Effect::State::~State() {
  tables.users().remove(&ring);
  if (info.message == nullptr || !desc.check_inputs || !ring.unfinished()) return;
  const char* const text =
      parts.open() ? "an Effect is destroyed between the two parts of a frame; expected to record and submit "
                     "FramePart::second or drop first, and to wait for it"
                   : "an Effect is destroyed before the commands that it recorded have completed, or without "
                     "submitting them; expected to wait for them first";
  info.message(info.message_user, Severity::warning, text);
}

Result<void> Effect::State::create_objects() {
  target = target_of(device);
  pipelines.create(device, desc.pipeline_threads);
  sets.create(device, FrameRing::slots(desc));
  buffers.create(device);
  froxels.create(device);
  TYNDALL_ASSIGN(ring, FrameRing::create(device, desc));
  TYNDALL_TRY(create_tables());
  TYNDALL_ASSIGN(Pending everything, plan(desc, params, kEverything));
  commit(std::move(everything));
  TYNDALL_ASSIGN(no_shadows, gpu::create_image(device, kNoShadows));
  TYNDALL_ASSIGN(no_colors, gpu::create_image(device, kNoColors));
  TYNDALL_ASSIGN(no_clouds, gpu::create_image(device, kNoClouds));
  TYNDALL_ASSIGN(constants, gpu::create_buffer(device, "constants", kSlotBytes * FrameRing::slots(desc),
                                               kConstantsUsage, gpu::MemoryKind::constants));
  const VkDeviceSize counter_bytes = kCounterBytes * FrameRing::slots(desc);
  TYNDALL_ASSIGN(counters,
                 gpu::create_buffer(device, "counters", counter_bytes, kCounterUsage, gpu::MemoryKind::device));
  if (desc.counters) {
    TYNDALL_ASSIGN(counters_readback, gpu::create_buffer(device, "counters_readback", counter_bytes,
                                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
  }
  TYNDALL_TRY(create_samplers());
  if (desc.timings) {
    TYNDALL_ASSIGN(timer, gpu::Timer::create(device, FrameRing::slots(desc), kMaxTimedPasses));
  }
  return {};
}

Result<void> Effect::State::create_tables() {
  if (!tables.users().empty()) {
    if (shared_tables->device.device != device.device) {
      return Error{ErrorCode::invalid_argument,
                   "EffectDesc::tables_of belongs to another VkDevice; expected an effect of this one"};
    }
    if (stale_tables(tables.wanted(), params) != 0) {
      return Error{ErrorCode::invalid_argument,
                   "the parameters need other tables than those of EffectDesc::tables_of; expected the same planet.*, "
                   "atmosphere.*, tables.* and scattering.color"};
    }
  } else {
    shared_tables->device = device;
    shared_tables->pipelines.create(shared_tables->device, desc.pipeline_threads);
    TYNDALL_TRY(tables.create(shared_tables->device, shared_tables->pipelines,
                              {FrameRing::slots(desc), desc.timings, desc.table_pipelines_later}));
  }
  tables.users().add({&ring, &parts, FrameRing::slots(desc)});
  return {};
}

namespace {

Error other_tables(const char* where) {
  return Error{ErrorCode::invalid_argument,
               std::string(where) +
                   ": an effect that shares the tables has built them for other planet.*, atmosphere.*, tables.* or "
                   "scattering.color; expected set_params() with the same of each effect"};
}

}  // namespace

Result<void> Effect::State::check_tables() {
  if (served_revision == tables.revision()) return {};
  if (!tables.serves(params)) return other_tables("Effect::record");
  served_revision = tables.revision();
  return {};
}

Result<void> Effect::State::check_tables_wanted(const char* where) const {
  return stale_tables(tables.wanted(), params) == 0 ? Result<void>() : other_tables(where);
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

void Effect::State::prepare_images(VkCommandBuffer cmd) {
  tables.begin_frame(cmd, &ring);
  buffers.begin_frame();
  froxels.begin_frame(cmd);
  if (images_ready) return;
  for (const gpu::Image* image : {&no_shadows, &no_colors, &no_clouds}) {
    gpu::transition(device, cmd, *image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  }
  images_ready = true;
}

void Effect::State::write_phase(std::byte* block, ColorMode color) const {
  const PhaseRows& rows = phase[color == ColorMode::spectral ? 1 : 0];
  if (!rows.empty()) std::memcpy(block + sizeof(shared::SpectralMedium), rows.data(), kPhaseBytes);
}

void Effect::State::write_constants(const FrameInputs& inputs, const Params& drawn, const shared::FrameConstants& frame,
                                    std::uint32_t slot) {
  const CascadeArray cascades = cascade_constants(inputs);
  const shared::SpectralMedium medium = spectral_medium_from_params(drawn);
  const shared::EpipolarConstants slices = epipolar_constants(inputs, desc, drawn);
  const VkDeviceSize offset = kSlotBytes * slot;
  std::memcpy(mapped(offset), &frame, sizeof frame);
  std::memcpy(mapped(offset + kCascadeOffset), &cascades, sizeof cascades);
  std::memcpy(mapped(offset + kMediumOffset), &medium, sizeof medium);
  write_phase(mapped(offset + kMediumOffset), drawn.scattering.color);
  std::memcpy(mapped(offset + kEpipolarOffset), &slices, sizeof slices);
}

BoundResources Effect::State::bind_resources(const FrameInputs& inputs, std::uint32_t slot) const {
  BoundResources out;
  const VkDeviceSize offset = kSlotBytes * slot;
  const VkBuffer ring_buffer = constants.buffer.get();
  out.set(Resource::frame, ring_buffer, offset, sizeof(shared::FrameConstants));
  out.set(Resource::cascades, ring_buffer, offset + kCascadeOffset, sizeof(CascadeArray));
  out.set(Resource::medium, ring_buffer, offset + kMediumOffset, kMediumBlockBytes);
  out.set(Resource::epipolar, ring_buffer, offset + kEpipolarOffset, sizeof(shared::EpipolarConstants));

  const auto image = [&out](Resource resource, const Texture& texture, VkSampler sampler) {
    out.set(resource, texture.view, texture.layout, sampler);
  };
  const Texture& shadows =
      inputs.cascades.empty() ? Texture{no_shadows.view.get(), VK_IMAGE_LAYOUT_GENERAL} : inputs.shadow_maps;
  const Texture& colors =
      has_colors(inputs, params) ? inputs.shadow_colors : Texture{no_colors.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  const Texture& clouds =
      has_clouds(inputs) ? inputs.clouds.map : Texture{no_clouds.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  image(Resource::scene_color, inputs.color, nearest.get());
  image(Resource::scene_depth, inputs.depth, nearest.get());
  image(Resource::shadow_maps, shadows, shadow_compare.get());
  image(Resource::shadow_depths, shadows, shadow_plain.get());
  image(Resource::shadow_colors, colors, shadow_tint.get());
  image(Resource::clouds, clouds, shadow_tint.get());
  image(Resource::output_color, inputs.output, VK_NULL_HANDLE);

  constexpr Resource kFroxels[FroxelVolume::kImages] = {Resource::froxel_inscattering, Resource::froxel_transmittance};
  for (std::uint32_t i = 0; i < FroxelVolume::kImages; ++i) {
    out.set(kFroxels[i], froxels.view_of(inputs.view, i), VK_IMAGE_LAYOUT_GENERAL, linear.get());
  }

  const auto table = [&](Resource resource, TableId id) {
    out.set(resource, tables.table(id).view.get(), VK_IMAGE_LAYOUT_GENERAL, linear.get());
  };
  table(Resource::single_rayleigh, TableId::single_rayleigh);
  table(Resource::single_mie, TableId::single_mie);
  table(Resource::high_orders, TableId::high_orders);

  out.set(Resource::counters, counters.buffer.get(), kCounterBytes * slot, kCounterBytes);
  out.set(Resource::counters_readback, counters_readback.buffer.get(), kCounterBytes * slot, kCounterBytes);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    out.set(frame_buffer(i), buffers[frame_buffer(i)].buffer.get());
  }
  return out;
}

Result<void> Effect::State::begin_frame(VkCommandBuffer cmd, const FrameInputs& inputs, const Params& drawn) {
  TYNDALL_TRY(check_frame(inputs, desc, params));
  TYNDALL_TRY(check_tables());
  TYNDALL_TRY(ring.take(inputs.frame_index, inputs.view));
  const std::uint32_t slot = ring.slot(inputs.frame_index, inputs.view);
  const shared::FrameConstants frame = frame_constants(inputs, desc, drawn);
  if (desc.check_inputs) remarks.on_frame(inputs, {desc, params, frame, tables.ready()}, info);
  write_constants(inputs, drawn, frame, slot);

  if (desc.timings) timer.begin_frame(cmd, slot);
  prepare_images(cmd);
  sets.begin(slot);
  return {};
}

// Ends a frame of which only the first part has been recorded. Its slot is free when these commands have completed,
// because the event is set only after the commands of the first part.
void Effect::State::drop(VkCommandBuffer cmd, const FrameInputs& inputs) {
  if (desc.counters) {
    const VkDeviceSize offset = kCounterBytes * ring.slot(inputs.frame_index, inputs.view);
    std::memset(static_cast<std::byte*>(counters_readback.mapped) + offset, 0, kCounterBytes);
  }
  ring.record_end(cmd, inputs.frame_index, inputs.view);
  parts.recorded(inputs, FramePart::drop);
}

Result<void> Effect::State::record(VkCommandBuffer cmd, const FrameInputs& inputs, FramePart part) {
  TYNDALL_TRY(parts.check(inputs, part));
  if (part == FramePart::drop) {
    drop(cmd, inputs);
    return {};
  }
  const Params drawn = drawn_with(params);
  if (part != FramePart::second) TYNDALL_TRY(begin_frame(cmd, inputs, drawn));
  const std::uint32_t slot = ring.slot(inputs.frame_index, inputs.view);
  const BoundResources resources = bind_resources(inputs, slot);
  StepRecorder recorder(device, cmd, pipelines, sets, slot, resources, desc.timings ? &timer : nullptr);
  // The previous frame and the first part of this one use the same buffers, and their commands may still be running.
  constexpr VkAccessFlags kFrameBefore = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                                         VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
  recorder.assume(Resource::counters, kFrameBefore);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) recorder.assume(frame_buffer(i), kFrameBefore);
  if (uses_froxels(params) && part != FramePart::first) {
    recorder.assume(Resource::froxel_inscattering, kFrameBefore);
    recorder.assume(Resource::froxel_transmittance, kFrameBefore);
    // Any stage of the caller's earlier commands may read the volume.
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0);
  }
  if (desc.timings) timer.begin_whole(cmd, "effect");
  const FrameSteps steps = frame_steps(desc, drawn, frame_shape(inputs, drawn, target));
  for (const Step& step : steps.of(part)) TYNDALL_TRY(recorder.record(step));
  if (desc.timings) timer.end_whole(cmd);
  if (part == FramePart::first) {
    ring.hold(inputs.frame_index, inputs.view);
  } else {
    ring.record_end(cmd, inputs.frame_index, inputs.view);
  }
  parts.recorded(inputs, part);
  return {};
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
  for (std::uint32_t i = 0; i < (tables.users().counted_by(&ring) ? kTableCount : 0); ++i) {
    const gpu::Image& table = tables.table(static_cast<TableId>(i));
    row(table.desc.name, table.bytes);
  }
  row(no_shadows.desc.name, no_shadows.bytes);
  row(no_colors.desc.name, no_colors.bytes);
  row(no_clouds.desc.name, no_clouds.bytes);
  row("counters", counters.bytes);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    const gpu::Buffer& buffer = buffers[frame_buffer(i)];
    if (buffer.bytes > 0) row(name_of(frame_buffer(i)), buffer.bytes);
  }
  for (std::uint32_t i = 0; i < FroxelVolume::kImages; ++i) {
    const VkDeviceSize bytes = froxels.images().bytes(i);
    if (bytes > 0) row(FroxelVolume::kNames[i], bytes);
  }
  return {resource_rows.data(), used};
}

MemoryUsage Effect::State::memory() const {
  const VkDeviceSize placeholders = no_shadows.bytes + no_colors.bytes + no_clouds.bytes;
  const bool counted = tables.users().counted_by(&ring);
  return {(counted ? tables.persistent_bytes() : 0) + placeholders + counters.bytes + buffers.bytes() +
              froxels.images().bytes(),
          (counted ? tables.transient_bytes() : 0) + buffers.retired_bytes() + froxels.retired_bytes(),
          constants.bytes + counters_readback.bytes};
}

std::span<const PassTiming> Effect::State::read_timings(std::uint64_t frame_index, std::uint32_t view) {
  if (!desc.timings || view >= desc.views) return {};
  const std::span<const gpu::TimedScope> scopes = timer.read(ring.slot(frame_index, view));
  const std::size_t count = std::min(scopes.size(), timings.size());
  for (std::size_t i = 0; i < count; ++i) timings[i] = {scopes[i].name, scopes[i].milliseconds};
  return {timings.data(), count};
}

}  // namespace tyndall
