// The effect: creation, the building of tables and the recording of a frame. Reads from top to bottom
// like the frame itself; the numbers come from frame_constants.cpp, the checks from check.cpp.
#include "tyndall/effect.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "effect/epipolar.hpp"
#include "effect/frame_constants.hpp"
#include "effect/medium.hpp"
#include "effect/modes.hpp"
#include "effect/tables.hpp"
#include "effect_shaders.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"
#include "gpu/timer.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr const char* kExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
constexpr std::uint32_t kMaxTimedPasses = 40;
// Storage buffers may be bound at multiples of this on every device (the largest minimum allowed).
constexpr VkDeviceSize kBufferAlignment = 256;

// Stands in for the shadow maps of a frame that has none; never read.
constexpr gpu::ImageDesc kNoShadows = {"no_shadows", VK_FORMAT_D32_SFLOAT, {1, 1, 1},
                                       VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1, true};

// Stands in for the colours of a frame that has none; never read.
constexpr gpu::ImageDesc kNoColors = {"no_colors", VK_FORMAT_R8G8B8A8_UNORM, {1, 1, 1},
                                      VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1, true};

// A slot of the ring of constants: what one frame in flight reads.
constexpr VkDeviceSize align(VkDeviceSize size) {
  return (size + kBufferAlignment - 1) / kBufferAlignment * kBufferAlignment;
}
constexpr VkDeviceSize kFrameBytes = align(sizeof(shared::FrameConstants));
constexpr VkDeviceSize kCascadeBytes = align(sizeof(CascadeArray));
constexpr VkDeviceSize kMediumBytes = align(sizeof(shared::Medium));
constexpr VkDeviceSize kEpipolarBytes = align(sizeof(shared::EpipolarConstants));
constexpr VkDeviceSize kSlotBytes = kFrameBytes + kCascadeBytes + kMediumBytes + kEpipolarBytes;
static_assert(shared::kMostCascades == kMaxCascades);
// Counters of a frame, as pairs of words.
constexpr VkDeviceSize kCounterBytes = align(shared::kCounters * sizeof(std::uint64_t));

// Read as storage by most passes, as uniforms by those that unwarp (docs/epipolar.md says why).
constexpr VkBufferUsageFlags kConstantsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
constexpr VkBufferUsageFlags kCounterUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

Result<void> check_desc(const DeviceInfo& info, const EffectDesc& desc) {
  const auto invalid = [](const char* text) { return Error{ErrorCode::invalid_argument, text}; };
  if (info.device == VK_NULL_HANDLE || info.physical_device == VK_NULL_HANDLE || info.instance == VK_NULL_HANDLE ||
      info.get_instance_proc_addr == nullptr) {
    return invalid("DeviceInfo needs instance, physical_device, device and get_instance_proc_addr");
  }
  if (desc.max_extent.width == 0 || desc.max_extent.height == 0 || desc.max_extent.width > 16384 ||
      desc.max_extent.height > 16384) {
    return invalid("EffectDesc::max_extent must be 1x1 to 16384x16384");
  }
  if (desc.frames_in_flight == 0 || desc.frames_in_flight > 8) {
    return invalid("EffectDesc::frames_in_flight must be 1 to 8");
  }
  if (desc.max_cascades == 0 || desc.max_cascades > kMaxCascades) {
    return invalid("EffectDesc::max_cascades must be 1 to 8");
  }
  if (desc.max_shadow_resolution == 0 || desc.max_shadow_resolution > 16384) {
    return invalid("EffectDesc::max_shadow_resolution must be 1 to 16384");
  }
  if (desc.sky_depth != 0.0F && desc.sky_depth != 1.0F) return invalid("EffectDesc::sky_depth must be 0 or 1");
  return {};
}

Result<void> open_device(gpu::Device& device, const DeviceInfo& info) {
  device.instance = info.instance;
  device.physical_device = info.physical_device;
  device.device = info.device;
  device.allocator = info.allocator;
  device.pipeline_cache = info.pipeline_cache;
  device.replace_shader = info.replace_shader;
  device.replace_shader_user = info.replace_shader_user;
  return gpu::init_device(device, info.get_instance_proc_addr);
}

MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  MemoryUsage usage;
  usage.persistent = gpu::image_bytes(device, kNoShadows) + gpu::image_bytes(device, kNoColors);
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    usage.persistent += gpu::image_bytes(device, table_desc(static_cast<TableId>(i), params));
  }
  usage.persistent += gpu::buffer_bytes(device, kCounterBytes * desc.frames_in_flight, kCounterUsage);
  usage.persistent += epipolar_bytes(device, desc, params);
  usage.transient = table_scratch_bytes(device, params);
  usage.host = gpu::buffer_bytes(device, kSlotBytes * desc.frames_in_flight, kConstantsUsage);
  if (desc.counters) {
    usage.host += gpu::buffer_bytes(device, kCounterBytes * desc.frames_in_flight, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  return usage;
}

}  // namespace

Requirements requirements() { return {VK_API_VERSION_1_3, kExtensions}; }

struct Effect::State {
  DeviceInfo info;
  EffectDesc desc;
  Params params;
  gpu::Device device;

  std::array<std::array<gpu::Pipeline, kModeCount>, 2> march_per_pixel;  // without and with colours; made when asked for
  gpu::Pipeline no_air;
  Epipolar epipolar;
  TableBuilder tables;
  gpu::Image no_shadows, no_colors;
  gpu::Buffer constants;
  gpu::Buffer counters;           // written by shaders
  gpu::Buffer counters_readback;  // with EffectDesc::counters
  gpu::Handle<VkSampler> nearest;
  gpu::Handle<VkSampler> linear;
  gpu::Handle<VkSampler> shadow_compare;
  gpu::Handle<VkSampler> shadow_plain;  // the depths themselves, with the same border
  gpu::Handle<VkSampler> shadow_tint;
  gpu::Timer timer;
  std::array<PassTiming, kMaxTimedPasses> timings = {};
  std::array<ResourceMemory, kTableCount + kEpipolarBuffers + 3> resource_rows = {};

  bool images_ready = false;  // the first recording moves them out of the undefined layout

  [[nodiscard]] std::uint32_t slot(std::uint64_t frame_index) const {
    return static_cast<std::uint32_t>(frame_index % desc.frames_in_flight);
  }
  [[nodiscard]] std::byte* mapped(VkDeviceSize offset) const {
    return static_cast<std::byte*>(constants.mapped) + offset;
  }

  Result<void> create_objects();
  Result<void> make_march_per_pixel(bool colors, std::uint32_t mode);
  Result<void> prepare_pipelines(const Params& params);
  void prepare_images(VkCommandBuffer cmd);
  void clear_counters(VkCommandBuffer cmd, VkDeviceSize offset);
  void read_counters(VkCommandBuffer cmd, VkDeviceSize offset);
  Result<void> run(VkCommandBuffer cmd, const gpu::Pipeline& pipeline,
                   std::span<const gpu::NamedResource> resources, const void* push, VkExtent3D size);
};

Effect::Effect(std::unique_ptr<State> state) : state_(std::move(state)) {}
Effect::Effect(Effect&&) noexcept = default;
Effect& Effect::operator=(Effect&&) noexcept = default;
Effect::~Effect() = default;

Result<MemoryUsage> query_memory(const DeviceInfo& info, const EffectDesc& desc, const Params& params) {
  TYNDALL_TRY(check_desc(info, desc));
  TYNDALL_TRY(check_params(params));
  gpu::Device device;
  TYNDALL_TRY(open_device(device, info));
  TYNDALL_TRY(check_table_size(device, params));
  return plan_memory(device, desc, params);
}

Result<Effect> Effect::create(const DeviceInfo& info, const EffectDesc& desc, const Params& params) {
  TYNDALL_TRY(check_desc(info, desc));
  TYNDALL_TRY(check_params(params));
  auto state = std::make_unique<State>();
  state->info = info;
  state->desc = desc;
  state->params = params;
  TYNDALL_TRY(open_device(state->device, info));
  TYNDALL_TRY(state->create_objects());
  return Effect(std::move(state));
}

Result<void> Effect::State::create_objects() {
  const bool full = desc.output_format == OutputFormat::rgba32f;
  TYNDALL_ASSIGN(no_air, gpu::create_compute_pipeline(
                             device, full ? shaders::no_air_comp_rgba32f : shaders::no_air_comp_rgba16f));
  no_air.name = "no_air";
  TYNDALL_TRY(epipolar.create(device, desc, params));
  TYNDALL_TRY(prepare_pipelines(params));
  TYNDALL_TRY(tables.create(device, desc.frames_in_flight, desc.timings, params));
  TYNDALL_ASSIGN(no_shadows, gpu::create_image(device, kNoShadows));
  TYNDALL_ASSIGN(no_colors, gpu::create_image(device, kNoColors));
  TYNDALL_ASSIGN(constants, gpu::create_buffer(device, "constants", kSlotBytes * desc.frames_in_flight,
                                               kConstantsUsage, gpu::MemoryKind::upload));
  const VkDeviceSize counter_bytes = kCounterBytes * desc.frames_in_flight;
  TYNDALL_ASSIGN(counters,
                 gpu::create_buffer(device, "counters", counter_bytes, kCounterUsage, gpu::MemoryKind::device));
  if (desc.counters) {
    TYNDALL_ASSIGN(counters_readback, gpu::create_buffer(device, "counters_readback", counter_bytes,
                                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
  }
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
  if (desc.timings) {
    TYNDALL_ASSIGN(timer, gpu::Timer::create(device, desc.frames_in_flight, kMaxTimedPasses));
  }
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

// The dear pipelines that record() will ask for.
Result<void> Effect::State::prepare_pipelines(const Params& p) {
  if (!p.scattering.enabled) return {};
  if (p.scattering.technique == Technique::epipolar) return epipolar.prepare(p);
  if (desc.shadow_colors) TYNDALL_TRY(make_march_per_pixel(true, mode_index(p.scattering)));
  return make_march_per_pixel(false, mode_index(p.scattering));
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

Result<void> Effect::set_params(const Params& params) {
  TYNDALL_TRY(check_params(params));
  TYNDALL_TRY(state_->prepare_pipelines(params));
  TYNDALL_TRY(state_->epipolar.set_params(params));
  TYNDALL_TRY(state_->tables.set_params(params));
  state_->params = params;
  return {};
}

Result<Progress> Effect::prepare_pipelines(std::uint32_t budget) {
  Progress progress;
  for (std::uint32_t mode = 0; mode < kModeCount; ++mode) {
    if (!mode_exists(mode)) continue;
    for (const bool colors : {false, true}) {
      if (colors && !state_->desc.shadow_colors) continue;
      ++progress.total;
      const bool made = static_cast<bool>(state_->march_per_pixel[colors ? 1 : 0][mode].pipeline);
      if (!made && budget > 0) {
        TYNDALL_TRY(state_->make_march_per_pixel(colors, mode));
        --budget;
      } else if (!made) {
        continue;
      }
      ++progress.done;
    }
  }
  TYNDALL_TRY(state_->epipolar.prepare_others(budget, progress));
  return progress;
}

Result<void> Effect::set_shadow_colors(bool shadow_colors) {
  const EffectDesc before = state_->desc;
  state_->desc.shadow_colors = shadow_colors;
  Result<void> done = state_->epipolar.set_limits(state_->desc, state_->params);
  if (done) done = state_->prepare_pipelines(state_->params);
  if (done) return done;
  state_->desc = before;
  static_cast<void>(state_->epipolar.set_limits(before, state_->params));  // what it takes is there
  return done;
}

Result<void> Effect::set_limits(VkExtent2D max_extent, std::uint32_t max_cascades,
                                std::uint32_t max_shadow_resolution) {
  EffectDesc desc = state_->desc;
  desc.max_extent = max_extent;
  desc.max_cascades = max_cascades;
  desc.max_shadow_resolution = max_shadow_resolution;
  TYNDALL_TRY(check_desc(state_->info, desc));
  TYNDALL_TRY(state_->epipolar.set_limits(desc, state_->params));
  state_->desc = desc;
  return {};
}

const Params& Effect::params() const { return state_->params; }

Progress Effect::precompute_progress() const { return state_->tables.progress(); }

void Effect::State::prepare_images(VkCommandBuffer cmd) {
  tables.begin_frame(cmd);
  epipolar.begin_frame();
  if (images_ready) return;
  gpu::transition(device, cmd, no_shadows, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  gpu::transition(device, cmd, no_colors, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  images_ready = true;
}

Result<Progress> Effect::record_precompute(VkCommandBuffer cmd, std::uint32_t budget) {
  TYNDALL_TRY(state_->tables.record(cmd, budget));
  return precompute_progress();
}

Result<void> Effect::record(VkCommandBuffer cmd, const FrameInputs& inputs) {
  State& s = *state_;
  TYNDALL_TRY(check_frame(inputs, s.desc, s.params));
  if (s.desc.check_inputs) remark_on_frame(inputs, s.params, s.info);

  const std::uint32_t slot = s.slot(inputs.frame_index);
  const VkDeviceSize frame_offset = kSlotBytes * slot;
  const VkDeviceSize cascade_offset = frame_offset + kFrameBytes;
  const VkDeviceSize medium_offset = cascade_offset + kCascadeBytes;
  const shared::FrameConstants frame = frame_constants(inputs, s.desc, s.params);
  const CascadeArray cascades = cascade_constants(inputs);
  const shared::Medium medium = medium_from_params(s.params);
  std::memcpy(s.mapped(frame_offset), &frame, sizeof frame);
  std::memcpy(s.mapped(cascade_offset), &cascades, sizeof cascades);
  std::memcpy(s.mapped(medium_offset), &medium, sizeof medium);

  const VkDeviceSize epipolar_offset = medium_offset + kMediumBytes;
  const shared::EpipolarConstants epipolar = epipolar_constants(inputs, s.desc, s.params);
  std::memcpy(s.mapped(epipolar_offset), &epipolar, sizeof epipolar);

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
      gpu::named_buffer("epipolar_block", s.constants.buffer.get(), epipolar_offset, sizeof epipolar),
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
  gpu::Timer* timer = s.desc.timings ? &s.timer : nullptr;
  if (s.params.scattering.enabled && s.params.scattering.technique == Technique::epipolar) {
    TYNDALL_TRY(s.epipolar.record(cmd, inputs, s.params, resources, timer));
  } else {
    const gpu::Pipeline& pipeline =
        s.params.scattering.enabled ? s.march_per_pixel[colored ? 1 : 0][mode_index(s.params.scattering)] : s.no_air;
    if (timer != nullptr) timer->begin(cmd, pipeline.name);
    TYNDALL_TRY(s.run(cmd, pipeline, resources, &inputs.extent, {inputs.extent.width, inputs.extent.height, 1}));
    if (timer != nullptr) timer->end(cmd);
  }
  if (s.desc.counters) s.read_counters(cmd, counter_offset);
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

void Effect::State::read_counters(VkCommandBuffer cmd, VkDeviceSize offset) {
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
  const VkBufferCopy region = {offset, offset, kCounterBytes};
  device.vk.CmdCopyBuffer(cmd, counters.buffer.get(), counters_readback.buffer.get(), 1, &region);
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
               VK_ACCESS_HOST_READ_BIT);
}

Counters Effect::counters(std::uint64_t frame_index) const {
  const State& s = *state_;
  if (!s.desc.counters) return {};
  std::uint64_t values[shared::kCounters];
  std::memcpy(values, static_cast<const std::byte*>(s.counters_readback.mapped) + kCounterBytes * s.slot(frame_index),
              sizeof values);
  return {values[shared::kSamplesMarched], values[shared::kMarchSteps], values[shared::kNodesVisited],
          values[shared::kShadowFetches], values[shared::kPixelsCorrected]};
}

std::span<const ResourceMemory> Effect::resources() {
  State& s = *state_;
  std::size_t used = 0;
  const auto row = [&](const char* name, VkDeviceSize bytes) { s.resource_rows[used++] = {name, bytes}; };
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const gpu::Image& table = s.tables.table(static_cast<TableId>(i));
    row(table.desc.name, table.bytes);
  }
  row(s.no_shadows.desc.name, s.no_shadows.bytes);
  row(s.no_colors.desc.name, s.no_colors.bytes);
  row("counters", s.counters.bytes);
  for (std::uint32_t i = 0; i < kEpipolarBuffers; ++i) {
    const auto buffer = static_cast<EpipolarBuffer>(i);
    if (s.epipolar.bytes(buffer) > 0) row(epipolar_buffer_name(buffer), s.epipolar.bytes(buffer));
  }
  return {s.resource_rows.data(), used};
}

std::string Effect::table_key() const { return tyndall::table_key(state_->device, state_->params); }

VkDeviceSize Effect::table_bytes() const { return tyndall::table_bytes(state_->params); }

Result<void> Effect::record_save_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  return state_->tables.record_save(cmd, buffer, offset);
}

Result<void> Effect::record_load_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  return state_->tables.record_load(cmd, buffer, offset);
}

LightTables Effect::light_tables() const {
  const TableBuilder& tables = state_->tables;
  return {tables.table(TableId::sun_transmittance).view.get(), tables.table(TableId::sky_irradiance).view.get()};
}

ScatteringTables Effect::scattering_tables() const {
  const TableBuilder& tables = state_->tables;
  const auto table = [&](TableId id) -> Table {
    const gpu::Image& image = tables.table(id);
    return {image.image.get(), image.view.get(), image.desc.extent};
  };
  return {table(TableId::single_rayleigh), table(TableId::single_mie), table(TableId::high_orders)};
}

std::span<const PassTiming> Effect::precompute_timings() { return state_->tables.stage_times(); }

MemoryUsage Effect::memory() const {
  const State& s = *state_;
  return {s.tables.persistent_bytes() + s.no_shadows.bytes + s.no_colors.bytes + s.counters.bytes + s.epipolar.bytes(),
          s.tables.transient_bytes() + s.epipolar.retired_bytes(), s.constants.bytes + s.counters_readback.bytes};
}

std::span<const PassTiming> Effect::timings(std::uint64_t frame_index) {
  State& s = *state_;
  if (!s.desc.timings) return {};
  const std::span<const gpu::TimedScope> scopes = s.timer.read(s.slot(frame_index));
  const std::size_t count = std::min(scopes.size(), s.timings.size());
  for (std::size_t i = 0; i < count; ++i) s.timings[i] = {scopes[i].name, scopes[i].milliseconds};
  return {s.timings.data(), count};
}

}  // namespace tyndall
