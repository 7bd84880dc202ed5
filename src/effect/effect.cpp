// The effect: creation, the building of tables and the recording of a frame. Reads from top to bottom
// like the frame itself; the numbers come from frame_constants.cpp, the checks from check.cpp.
#include "tyndall/effect.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "effect/frame_constants.hpp"
#include "effect/medium.hpp"
#include "effect/tables.hpp"
#include "effect_shaders.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"
#include "gpu/timer.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr const char* kExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
constexpr std::uint32_t kMaxTimedPasses = 16;
// Storage buffers may be bound at multiples of this on every device (the largest minimum allowed).
constexpr VkDeviceSize kBufferAlignment = 256;

// Stands in for the shadow maps of a frame that has none; never read.
constexpr gpu::ImageDesc kNoShadows = {"no_shadows", VK_FORMAT_D32_SFLOAT, {1, 1, 1},
                                       VK_IMAGE_USAGE_SAMPLED_BIT, 1, 1, true};

// A slot of the ring of constants: what one frame in flight reads.
constexpr VkDeviceSize align(VkDeviceSize size) {
  return (size + kBufferAlignment - 1) / kBufferAlignment * kBufferAlignment;
}
constexpr VkDeviceSize kFrameBytes = align(sizeof(shared::FrameConstants));
constexpr VkDeviceSize kMediumBytes = align(sizeof(shared::Medium));
constexpr VkDeviceSize kSlotBytes = kFrameBytes + kMediumBytes;

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
  if (desc.sky_depth != 0.0F && desc.sky_depth != 1.0F) return invalid("EffectDesc::sky_depth must be 0 or 1");
  return {};
}

Result<void> open_device(gpu::Device& device, const DeviceInfo& info) {
  device.instance = info.instance;
  device.physical_device = info.physical_device;
  device.device = info.device;
  device.allocator = info.allocator;
  device.pipeline_cache = info.pipeline_cache;
  return gpu::init_device(device, info.get_instance_proc_addr);
}

MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  MemoryUsage usage;
  usage.persistent = gpu::image_bytes(device, kNoShadows);
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    usage.persistent += gpu::image_bytes(device, table_desc(static_cast<TableId>(i), params));
  }
  usage.transient = table_scratch_bytes(device, params);
  usage.host = gpu::buffer_bytes(device, kSlotBytes * desc.frames_in_flight, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  return usage;
}

}  // namespace

Requirements requirements() { return {VK_API_VERSION_1_3, kExtensions}; }

struct Effect::State {
  DeviceInfo info;
  EffectDesc desc;
  Params params;
  gpu::Device device;

  gpu::Pipeline march_per_pixel;
  TableBuilder tables;
  gpu::Image no_shadows;
  gpu::Buffer constants;
  gpu::Handle<VkSampler> nearest;
  gpu::Handle<VkSampler> linear;
  gpu::Handle<VkSampler> shadow_compare;
  gpu::Timer timer;
  std::array<PassTiming, kMaxTimedPasses> timings = {};

  bool images_ready = false;  // the first recording moves them out of the undefined layout

  [[nodiscard]] std::uint32_t slot(std::uint64_t frame_index) const {
    return static_cast<std::uint32_t>(frame_index % desc.frames_in_flight);
  }
  [[nodiscard]] std::byte* mapped(VkDeviceSize offset) const {
    return static_cast<std::byte*>(constants.mapped) + offset;
  }

  Result<void> create_objects();
  void prepare_images(VkCommandBuffer cmd);
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
  const gpu::Shader& march = desc.output_format == OutputFormat::rgba32f ? shaders::march_per_pixel_comp_rgba32f
                                                                         : shaders::march_per_pixel_comp_rgba16f;
  TYNDALL_ASSIGN(march_per_pixel, gpu::create_compute_pipeline(device, march));
  march_per_pixel.name = "march_per_pixel";
  TYNDALL_TRY(tables.create(device, desc.frames_in_flight, desc.timings, params));
  TYNDALL_ASSIGN(no_shadows, gpu::create_image(device, kNoShadows));
  TYNDALL_ASSIGN(constants, gpu::create_buffer(device, "constants", kSlotBytes * desc.frames_in_flight,
                                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(linear, gpu::create_sampler(device, {}));
  TYNDALL_ASSIGN(nearest, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));
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
  TYNDALL_TRY(state_->tables.set_params(params));
  state_->params = params;
  return {};
}

const Params& Effect::params() const { return state_->params; }

Progress Effect::precompute_progress() const { return state_->tables.progress(); }

void Effect::State::prepare_images(VkCommandBuffer cmd) {
  tables.begin_frame(cmd);
  if (images_ready) return;
  gpu::transition(device, cmd, no_shadows, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
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
  const VkDeviceSize medium_offset = frame_offset + kFrameBytes;
  const shared::FrameConstants frame = frame_constants(inputs, s.desc, s.params);
  const shared::Medium medium = medium_from_params(s.params);
  std::memcpy(s.mapped(frame_offset), &frame, sizeof frame);
  std::memcpy(s.mapped(medium_offset), &medium, sizeof medium);

  if (s.desc.timings) s.timer.begin_frame(cmd, slot);
  s.prepare_images(cmd);
  const Texture none = {s.no_shadows.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  const Texture& shadows = inputs.cascades.empty() ? none : inputs.shadow_maps;
  const auto table = [&s](const char* name, TableId id) {
    return gpu::named_image(name, s.tables.table(id).view.get(), VK_IMAGE_LAYOUT_GENERAL, s.linear.get());
  };
  const gpu::NamedResource resources[] = {
      gpu::named_buffer("medium_block", s.constants.buffer.get(), medium_offset, sizeof medium),
      gpu::named_buffer("frame_block", s.constants.buffer.get(), frame_offset, sizeof frame),
      gpu::named_image("scene_color", inputs.color.view, inputs.color.layout, s.nearest.get()),
      gpu::named_image("scene_depth", inputs.depth.view, inputs.depth.layout, s.nearest.get()),
      gpu::named_image("shadow_maps", shadows.view, shadows.layout, s.shadow_compare.get()),
      table("single_rayleigh", TableId::single_rayleigh),
      table("single_mie", TableId::single_mie),
      table("high_orders", TableId::high_orders),
      gpu::named_image("output_color", inputs.output.view, inputs.output.layout),
  };
  if (s.desc.timings) s.timer.begin(cmd, s.march_per_pixel.name);
  TYNDALL_TRY(s.run(cmd, s.march_per_pixel, resources, nullptr, {inputs.extent.width, inputs.extent.height, 1}));
  if (s.desc.timings) s.timer.end(cmd);
  return {};
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
  return {s.tables.persistent_bytes() + s.no_shadows.bytes, s.tables.transient_bytes(), s.constants.bytes};
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
