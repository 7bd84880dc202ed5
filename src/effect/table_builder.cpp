// Building the tables in slices, and copying them to and from buffers.
#include <algorithm>
#include <string>
#include <utility>

#include "effect/medium.hpp"
#include "effect/table_plan.hpp"
#include "effect/tables.hpp"
#include "effect_shaders.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kAltitudesPerSlice = 8;  // of the gathering grid
constexpr std::uint32_t kMostSlices = 4096 * 3 + 512;

Result<void> check_table_buffer(VkBuffer buffer, VkDeviceSize offset) {
  if (buffer == VK_NULL_HANDLE) return Error{ErrorCode::invalid_argument, "the buffer of the tables is null"};
  if (offset % kTexelBytes == 0) return {};
  return Error{ErrorCode::invalid_argument,
               "the tables' offset in their buffer is " + std::to_string(offset) + ", allowed are multiples of 8"};
}

VkBufferImageCopy whole_table(const gpu::Image& image, VkDeviceSize offset) {
  VkBufferImageCopy copy = {};
  copy.bufferOffset = offset;
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = image.desc.extent;
  return copy;
}

}  // namespace

Result<void> TableBuilder::create(const gpu::Device& device, std::uint32_t frames_in_flight, bool timings) {
  device_ = &device;
  frames_in_flight_ = frames_in_flight;
  timings_ = timings;
  constexpr gpu::Constant kOfGrid[] = {{0, 0}};
  constexpr gpu::Constant kOfTables[] = {{0, 1}};
  struct Row {
    Stage stage;
    const char* name;
    const gpu::Shader& shader;
    std::span<const gpu::Constant> constants = {};
  };
  const Row rows[] = {{sun_light, "sun_light", shaders::sun_light_comp},
                      {grid_nodes, "grid_nodes", shaders::ray_nodes_comp, kOfGrid},
                      {phase_matrix, "phase_matrix", shaders::phase_matrix_comp},
                      {gather_single, "gather_single", shaders::gather_single_comp},
                      {gather_multiple, "gather_multiple", shaders::gather_multiple_comp},
                      {scatter, "scatter", shaders::scatter_comp},
                      {ray_nodes, "ray_nodes", shaders::ray_nodes_comp, kOfTables},
                      {table_single, "table_single", shaders::table_single_comp},
                      {table_high, "table_high", shaders::table_high_comp},
                      {sky_light, "sky_light", shaders::sky_light_comp}};
  for (const Row& row : rows) {
    TYNDALL_ASSIGN(pipelines_[row.stage], gpu::create_compute_pipeline(device, row.shader, row.constants));
    pipelines_[row.stage].name = row.name;
  }
  if (timings) {
    TYNDALL_ASSIGN(timer_, gpu::Timer::create(device, 1, kMostSlices));
  }
  return {};
}

Result<TableScratch> TableBuilder::create_scratch(std::uint32_t views) const {
  TableScratch out = {};
  for (const BufferPlan& plan : plan_scratch(views)) {
    TYNDALL_ASSIGN(out.*plan.buffer,
                   gpu::create_buffer(*device_, plan.name, plan.bytes, kScratchUsage, gpu::MemoryKind::device));
  }
  out.views = views;
  return out;
}

Result<TableBuilder::Pending> TableBuilder::plan(const Params& params) {
  Pending out;
  const bool building = done_ < slices_.size();
  // For what commit() retires, and for what the end of the build does, when nothing may be allocated.
  retired_.reserve(retired_.size() + 2);
  if (building && stale_tables(wanted_, params) == 0) return out;
  out.wanted = params;
  out.stale = complete_ ? stale_tables(built_, params) : kAllTables;
  if (out.stale == 0) {
    if (building) out.kind = Pending::Kind::cancel;
    return out;
  }
  out.kind = Pending::Kind::build;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    if ((out.stale & (1U << i)) == 0) continue;
    const gpu::ImageDesc desc = table_desc(static_cast<TableId>(i), params);
    const gpu::Image& image = target(static_cast<TableId>(i)).image;
    const VkExtent3D& has = image.desc.extent;
    const bool fits = image.view && has.width == desc.extent.width && has.height == desc.extent.height &&
                      has.depth == desc.extent.depth;
    if (fits) continue;
    TYNDALL_ASSIGN(out.images[i].image, gpu::create_image(*device_, desc));
  }
  if (scratch_.views != params.tables.size.y) {
    TYNDALL_ASSIGN(out.scratch, create_scratch(params.tables.size.y));
  }
  out.slices = plan_slices(params, out.stale);
  return out;
}

void TableBuilder::commit(Pending&& pending) noexcept {
  if (pending.kind == Pending::Kind::nothing) return;
  if (pending.kind == Pending::Kind::cancel) {
    retire(std::exchange(next_, {}), std::exchange(scratch_, {}));
    slices_.resize(done_);
    return;
  }
  TableSet old = {};
  TableScratch old_scratch = {};
  bool replaced = false;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    if (!pending.images[i].image.view) continue;
    TableImage& image = target(static_cast<TableId>(i));
    replaced = replaced || image.image.view;
    old[i] = std::exchange(image, std::move(pending.images[i]));
  }
  if (pending.scratch.views > 0) {
    replaced = replaced || scratch_.views > 0;
    old_scratch = std::exchange(scratch_, std::move(pending.scratch));
  }
  if (replaced) retire(std::move(old), std::move(old_scratch));
  wanted_ = pending.wanted;
  stale_ = pending.stale;
  slices_ = std::move(pending.slices);
  done_ = 0;
}

TableImage& TableBuilder::target(TableId id) { return (complete_ ? next_ : tables_)[static_cast<std::uint32_t>(id)]; }

std::vector<TableBuilder::Slice> TableBuilder::plan_slices(const Params& params, std::uint32_t stale) {
  std::vector<Slice> out;
  const auto cut = [&out](Stage stage, std::uint32_t count, std::uint32_t per_slice, std::uint32_t order) {
    for (std::uint32_t first = 0; first < count; first += per_slice) {
      out.push_back({stage, first, std::min(per_slice, count - first), order});
    }
  };
  if ((stale & bit(TableId::sun_transmittance)) != 0) cut(sun_light, 1, 1, 0);
  const bool high = (stale & kHighTables) != 0;
  const bool single = (stale & kSingleTables) != 0;
  if (high) {
    const std::uint32_t altitudes = shared::kGatherAltitudes;
    cut(grid_nodes, altitudes, altitudes, 0);
    cut(phase_matrix, altitudes, altitudes, 0);
    // The last turn scatters nothing any more: it adds the last order's irradiance.
    for (std::uint32_t order = 2; order <= params.tables.orders + 1; ++order) {
      cut(order == 2 ? gather_single : gather_multiple, altitudes, kAltitudesPerSlice, order);
      cut(scatter, altitudes, kAltitudesPerSlice, order);
    }
    cut(sky_light, 1, 1, 0);
  }
  for (std::uint32_t altitude = 0; altitude < params.tables.size.x; ++altitude) {
    out.push_back({ray_nodes, altitude, 1, 0});
    if (single) out.push_back({table_single, altitude, 1, 0});
    if (high) out.push_back({table_high, altitude, 1, 0});
  }
  return out;
}

void TableBuilder::upload_constants(VkCommandBuffer cmd) {
  const shared::Medium medium = medium_from_params(wanted_);
  const ShapeBlock shape = {table_shape(wanted_), zenith_quadrature()};
  const VkBuffer buffer = scratch_.constants.buffer.get();
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  device_->vk.CmdUpdateBuffer(cmd, buffer, 0, sizeof medium, &medium);
  device_->vk.CmdUpdateBuffer(cmd, buffer, kShapeOffset, sizeof shape, &shape);
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

void TableBuilder::make_images_ready(VkCommandBuffer cmd) {
  for (TableSet* set : {&tables_, &next_}) {
    for (TableImage& table : *set) {
      if (table.ready || !table.image.view) continue;
      gpu::transition(*device_, cmd, table.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
      table.ready = true;
    }
  }
}

Result<void> TableBuilder::record_save(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  TYNDALL_TRY(check_table_buffer(buffer, offset));
  if (!progress().complete()) {
    return Error{ErrorCode::invalid_argument, "the tables are not complete, nothing can be saved before they are"};
  }
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_TRANSFER_READ_BIT);
  for (const TableImage& table : tables_) {
    const VkBufferImageCopy copy = whole_table(table.image, offset);
    device_->vk.CmdCopyImageToBuffer(cmd, table.image.image.get(), VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &copy);
    offset += texel_bytes(table.image.desc.extent);
  }
  // A later build writes them only when they have been read.
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0);
  return {};
}

Result<void> TableBuilder::record_load(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  TYNDALL_TRY(check_table_buffer(buffer, offset));
  if (progress().complete()) return {};
  make_images_ready(cmd);
  // Frames before may still read what is not yet built, a build that has begun may still write it.
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const auto id = static_cast<TableId>(i);
    if ((stale_ & bit(id)) != 0) {
      const gpu::Image& image = target(id).image;
      const VkBufferImageCopy copy = whole_table(image, offset);
      device_->vk.CmdCopyBufferToImage(cmd, buffer, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }
    offset += texel_bytes(table_desc(id, wanted_).extent);
  }
  // From here on as if compute shaders had written them: what waits for a build waits for this as well.
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  done_ = static_cast<std::uint32_t>(slices_.size());
  finish();
  return {};
}

Result<void> TableBuilder::record(VkCommandBuffer cmd, std::uint32_t budget) {
  if (done_ >= slices_.size() || budget == 0) return {};
  if (done_ == 0) {
    if (timings_) timer_.begin_frame(cmd, 0);
    upload_constants(cmd);
    make_images_ready(cmd);
  }
  for (; budget > 0 && done_ < slices_.size(); --budget, ++done_) {
    gpu::compute_barrier(*device_, cmd);
    const Slice& slice = slices_[done_];
    if (timings_) timer_.begin(cmd, pipelines_[slice.stage].name);
    TYNDALL_TRY(record_slice(cmd, slice));
    if (timings_) timer_.end(cmd);
  }
  gpu::compute_barrier(*device_, cmd);
  if (done_ == slices_.size()) finish();
  return {};
}

Result<void> TableBuilder::record_slice(VkCommandBuffer cmd, const Slice& slice) {
  const gpu::Pipeline& pipeline = pipelines_[slice.stage];
  const gpu::Label label(*device_, cmd, pipeline.name);
  const TableScratch& s = scratch_;
  const VkBuffer nodes =
      (slice.stage == grid_nodes || slice.stage == gather_single || slice.stage == gather_multiple ? s.grid_nodes
                                                                                                   : s.ray_nodes)
          .buffer.get();
  // Views of tables that this build does not make are missing, and not bound by the stages it runs.
  const auto view = [this](TableId id) { return target(id).image.view.get(); };
  const gpu::NamedResource resources[] = {
      gpu::named_buffer("medium_block", s.constants.buffer.get(), 0, sizeof(shared::Medium)),
      gpu::named_buffer("shape_block", s.constants.buffer.get(), kShapeOffset, sizeof(ShapeBlock)),
      gpu::named_buffer("node_block", nodes),
      gpu::named_buffer("phase_block", s.phase.buffer.get()),
      gpu::named_buffer("incident_block", s.incident.buffer.get()),
      gpu::named_buffer("source_block", s.source.buffer.get()),
      gpu::named_buffer("sum_block", s.sum.buffer.get()),
      gpu::named_buffer("irradiance_block", s.irradiance.buffer.get()),
      gpu::named_buffer("sky_block", s.sky.buffer.get()),
      gpu::named_image("single_rayleigh", view(TableId::single_rayleigh)),
      gpu::named_image("single_mie", view(TableId::single_mie)),
      gpu::named_image("high_orders", view(TableId::high_orders)),
      gpu::named_image("sun_transmittance", view(TableId::sun_transmittance)),
      gpu::named_image("sky_irradiance_table", view(TableId::sky_irradiance)),
  };
  const std::uint32_t push[] = {slice.first, slice.order};
  const std::string_view missing = gpu::bind(*device_, cmd, pipeline, resources, push);
  if (!missing.empty()) {
    return Error{ErrorCode::invalid_argument,
                 std::string("nothing is bound to ") + std::string(missing) + " of " + pipeline.name};
  }
  const UVec4& size = wanted_.tables.size;
  VkExtent3D extent = {size.z, size.w, size.y};  // of the tables: sun, angle, view
  switch (slice.stage) {
    case sun_light: extent = kSunLightExtent; break;
    case sky_light: extent = kSkyLightExtent; break;
    case grid_nodes: extent = {shared::kGatherZeniths, slice.count, 1}; break;
    case ray_nodes: extent = {size.y, 1, 1}; break;
    case phase_matrix: extent = {shared::kSourceZeniths, slice.count, 1}; break;
    case gather_single:
    case gather_multiple:
      extent = {shared::kGatherSuns, shared::kGatherAzimuths, slice.count * shared::kGatherZeniths};
      break;
    case scatter: extent = {shared::kGatherSuns * pipeline.local_size[0], slice.count, 1}; break;
    default: break;
  }
  gpu::dispatch(*device_, cmd, pipeline, extent.width, extent.height, extent.depth);
  return {};
}

void TableBuilder::finish() noexcept {
  if (complete_) {
    for (std::uint32_t i = 0; i < kTableCount; ++i) {
      if ((stale_ & (1U << i)) != 0) std::swap(tables_[i], next_[i]);
    }
  }
  complete_ = true;
  built_ = wanted_;
  retire(std::exchange(next_, {}), std::exchange(scratch_, {}));
}

void TableBuilder::retire(TableSet tables, TableScratch scratch) noexcept {
  retired_.push_back({std::move(tables), std::move(scratch), frames_in_flight_ + 1});
}

void TableBuilder::begin_frame(VkCommandBuffer cmd) {
  for (TableImage& table : tables_) {
    if (table.ready) continue;
    gpu::transition(*device_, cmd, table.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    table.ready = true;
  }
  for (Retired& r : retired_) --r.frames_left;
  std::erase_if(retired_, [](const Retired& r) { return r.frames_left == 0; });
}

VkDeviceSize TableBuilder::persistent_bytes() const {
  VkDeviceSize sum = 0;
  for (const TableImage& table : tables_) sum += table.image.bytes;
  return sum;
}

VkDeviceSize TableBuilder::transient_bytes() const {
  VkDeviceSize sum = scratch_.bytes();
  for (const TableImage& table : next_) sum += table.image.bytes;
  for (const Retired& r : retired_) {
    sum += r.scratch.bytes();
    for (const TableImage& table : r.tables) sum += table.image.bytes;
  }
  return sum;
}

std::span<const PassTiming> TableBuilder::stage_times() {
  if (!timings_) return {};
  for (std::uint32_t i = 0; i < kStages; ++i) times_[i] = {pipelines_[i].name, 0.0};
  for (const gpu::TimedScope& scope : timer_.read(0)) {
    for (PassTiming& time : times_) {
      if (time.name == scope.name) time.gpu_ms += scope.milliseconds;
    }
  }
  return times_;
}

}  // namespace tyndall
