// Builds the tables step by step, and copies them to and from buffers. The steps themselves are in table_steps.cpp.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "air/phase.hpp"
#include "effect/spectral_medium.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"
#include "effect/tables.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kMaxSteps = 4096 * 3 + 512;

Result<void> check_table_buffer(VkBuffer buffer, VkDeviceSize offset) {
  if (buffer == VK_NULL_HANDLE)
    return Error{ErrorCode::invalid_argument,
                 "the buffer of the tables is null; expected a buffer of Effect::table_bytes()"};
  if (offset % kTexelBytes == 0) return {};
  return Error{ErrorCode::invalid_argument,
               "the tables' offset in their buffer is " + std::to_string(offset) + "; expected a multiple of 8"};
}

VkBufferImageCopy whole_table(const gpu::Image& image, VkDeviceSize offset) {
  VkBufferImageCopy copy = {};
  copy.bufferOffset = offset;
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = image.desc.extent;
  return copy;
}

}  // namespace

Result<void> TableBuilder::create(const gpu::Device& device, PipelineCache& pipelines, const Options& options) {
  device_ = &device;
  pipelines_ = &pipelines;
  TYNDALL_ASSIGN(linear_, gpu::create_sampler(device, {}));
  options_ = options;
  if (options_.timings) {
    TYNDALL_ASSIGN(timer_, gpu::Timer::create(device, 1, kMaxSteps));
    times_.reserve(table_step_names().size());
  }
  return {};
}

Result<TableScratch> TableBuilder::create_scratch(std::uint32_t views, ColorMode color, bool tabulated) const {
  TableScratch out = {};
  for (const BufferPlan& plan : plan_scratch(views, color, tabulated)) {
    TYNDALL_ASSIGN(out.*plan.buffer,
                   gpu::create_buffer(*device_, plan.name, plan.bytes, kScratchUsage, gpu::MemoryKind::device));
  }
  TYNDALL_ASSIGN(out.source_function, gpu::create_image(*device_, kSourceFunction));
  out.views = views;
  out.color = color;
  out.tabulated = tabulated;
  return out;
}

Result<SetCache> TableBuilder::make_sets(std::span<const Step> steps) {
  std::vector<PipelineKey> pipelines;
  std::vector<SetKey> sets;
  for (const Step& step : steps) {
    if (std::find(pipelines.begin(), pipelines.end(), step.pipeline) == pipelines.end()) {
      pipelines.push_back(step.pipeline);
    }
    const SetKey key = set_key(step);
    if (std::find(sets.begin(), sets.end(), key) == sets.end()) sets.push_back(key);
  }
  TYNDALL_TRY(pipelines_->make(pipelines));
  SetCache out;
  out.create(*device_, 1);
  TYNDALL_TRY(out.make(sets, *pipelines_));
  return out;
}

Result<TableBuilder::Pending> TableBuilder::plan(const Params& params) {
  Pending out;
  const bool building = done_ < steps_.size();
  // Reserved for commit() and for the end of the build, which must not allocate.
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
  const ColorMode color = params.scattering.color;
  const bool tabulated = air::tabulated(params.atmosphere);
  if (scratch_.views != params.tables.size.y || scratch_.color != color || scratch_.tabulated != tabulated) {
    TYNDALL_ASSIGN(out.scratch, create_scratch(params.tables.size.y, color, tabulated));
  }
  out.phase_rows = resolved_phase_rows(params);
  out.steps = table_steps(params, out.stale);
  if (!options_.pipelines_later) {
    TYNDALL_ASSIGN(out.sets, make_sets(out.steps));
  }
  return out;
}

void TableBuilder::commit(Pending&& pending) noexcept {
  if (pending.kind == Pending::Kind::nothing) return;
  ++revision_;
  if (pending.kind == Pending::Kind::cancel) {
    retire(std::exchange(next_, {}), std::exchange(scratch_, {}), std::exchange(sets_, {}));
    steps_.resize(done_);
    return;
  }
  TableSet old = {};
  TableScratch old_scratch = {};
  bool replaced = done_ > 0;  // the sets have been used
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
  SetCache old_sets = std::exchange(sets_, std::move(pending.sets));
  if (replaced) retire(std::move(old), std::move(old_scratch), std::move(old_sets));
  wanted_ = pending.wanted;
  stale_ = pending.stale;
  phase_rows_ = std::move(pending.phase_rows);
  steps_ = std::move(pending.steps);
  done_ = 0;
}

TableImage& TableBuilder::target(TableId id) { return (complete_ ? next_ : tables_)[static_cast<std::uint32_t>(id)]; }

void TableBuilder::upload_constants(VkCommandBuffer cmd) {
  const shared::SpectralMedium medium = spectral_medium_from_params(wanted_);
  const ShapeBlock shape = {table_shape(wanted_), zenith_quadrature()};
  const VkBuffer buffer = scratch_.constants.buffer.get();
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  device_->vk.CmdUpdateBuffer(cmd, buffer, 0, sizeof medium, &medium);
  device_->vk.CmdUpdateBuffer(cmd, buffer, kShapeOffset, sizeof shape, &shape);
  if (!phase_rows_.empty()) {
    device_->vk.CmdUpdateBuffer(cmd, buffer, sizeof medium, kPhaseBytes, phase_rows_.data());
  }
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

void TableBuilder::make_ready(VkCommandBuffer cmd, TableImage& table, bool black) {
  if (table.ready || !table.image.view) return;
  gpu::transition(*device_, cmd, table.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  if (black) {
    constexpr VkClearColorValue kBlack = {};
    constexpr VkImageSubresourceRange kWhole = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    device_->vk.CmdClearColorImage(cmd, table.image.image.get(), VK_IMAGE_LAYOUT_GENERAL, &kBlack, 1, &kWhole);
    gpu::transition(*device_, cmd, table.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
  }
  table.ready = true;
}

void TableBuilder::make_images_ready(VkCommandBuffer cmd) {
  // Frames read the first tables before they are complete, and expect black where nothing has been written.
  for (TableImage& table : tables_) make_ready(cmd, table, true);
  for (TableImage& table : next_) make_ready(cmd, table, false);
}

Result<void> TableBuilder::record_save(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  TYNDALL_TRY(check_table_buffer(buffer, offset));
  if (!progress().complete()) {
    return Error{ErrorCode::invalid_argument,
                 "the tables are not complete; expected record_precompute() until its progress is complete"};
  }
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_TRANSFER_READ_BIT);
  for (const TableImage& table : tables_) {
    const VkBufferImageCopy copy = whole_table(table.image, offset);
    device_->vk.CmdCopyImageToBuffer(cmd, table.image.image.get(), VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &copy);
    offset += texel_bytes(table.image.desc.extent);
  }
  // A later build must not write the tables before they have been read.
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0);
  return {};
}

Result<void> TableBuilder::record_load(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  TYNDALL_TRY(check_table_buffer(buffer, offset));
  if (progress().complete()) return {};
  make_images_ready(cmd);
  // Earlier frames may still read the tables, and a build in progress may still write them.
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
  // Makes the copies visible in the same way as the writes of a build, so that later commands need no other barrier.
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  done_ = static_cast<std::uint32_t>(steps_.size());
  finish();
  return {};
}

Result<void> TableBuilder::record(VkCommandBuffer cmd, std::uint32_t budget) {
  if (done_ >= steps_.size() || budget == 0) return {};
  if (done_ == 0) {
    if (options_.pipelines_later) {
      TYNDALL_ASSIGN(sets_, make_sets(steps_));
    }
    if (options_.timings) timer_.begin_frame(cmd, 0);
    upload_constants(cmd);
    make_images_ready(cmd);
    // Each build overwrites the whole image before it reads it.
    gpu::transition(*device_, cmd, scratch_.source_function, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  }
  const BoundResources resources = bind_resources();
  StepRecorder recorder(*device_, cmd, *pipelines_, sets_, 0, resources, options_.timings ? &timer_ : nullptr);
  // Steps of earlier calls may still be running.
  for (std::size_t i = 0; i < kResources; ++i) {
    const auto resource = static_cast<Resource>(i);
    const Lifetime lifetime = info_of(resource).lifetime;
    if (lifetime == Lifetime::build || lifetime == Lifetime::tables) {
      recorder.assume(resource, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    }
  }
  for (; budget > 0 && done_ < steps_.size(); --budget, ++done_) TYNDALL_TRY(recorder.record(steps_[done_]));
  gpu::compute_barrier(*device_, cmd);
  if (done_ == steps_.size()) finish();
  return {};
}

// Returns the resources of the build. Tables that it does not write have no view, because no step binds them.
BoundResources TableBuilder::bind_resources() {
  const TableScratch& s = scratch_;
  BoundResources out;
  out.set(Resource::medium, s.constants.buffer.get(), 0, kMediumBlockBytes);
  out.set(Resource::shape, s.constants.buffer.get(), kShapeOffset, sizeof(ShapeBlock));
  out.set(Resource::grid_rays, s.grid_rays.buffer.get());
  out.set(Resource::table_rays, s.table_rays.buffer.get());
  out.set(Resource::phase, s.phase.buffer.get());
  out.set(Resource::incident, s.incident.buffer.get());
  out.set(Resource::source_function, s.source_function.view.get(), VK_IMAGE_LAYOUT_GENERAL, linear_.get());
  out.set(Resource::late_terms, s.late_terms.buffer.get());
  out.set(Resource::sum, s.sum.buffer.get());
  out.set(Resource::irradiance, s.irradiance.buffer.get());
  out.set(Resource::sky, s.sky.buffer.get());
  const auto table = [&](Resource resource, TableId id) { out.set(resource, target(id).image.view.get()); };
  table(Resource::single_rayleigh, TableId::single_rayleigh);
  table(Resource::single_mie, TableId::single_mie);
  table(Resource::high_orders, TableId::high_orders);
  table(Resource::sun_transmittance, TableId::sun_transmittance);
  table(Resource::sky_irradiance_table, TableId::sky_irradiance);
  return out;
}

void TableBuilder::finish() noexcept {
  if (complete_) {
    for (std::uint32_t i = 0; i < kTableCount; ++i) {
      if ((stale_ & (1U << i)) != 0) std::swap(tables_[i], next_[i]);
    }
  }
  complete_ = true;
  ++version_;
  ++revision_;
  built_ = wanted_;
  retire(std::exchange(next_, {}), std::exchange(scratch_, {}), std::exchange(sets_, {}));
}

void TableBuilder::retire(TableSet tables, TableScratch scratch, SetCache sets) noexcept {
  const std::uint32_t frames = users_.rounds(options_.frames_in_flight + 1);
  retired_.push_back({std::move(tables), std::move(scratch), std::move(sets), frames});
}

void TableBuilder::begin_frame(VkCommandBuffer cmd, const FrameRing* ring) {
  for (TableImage& table : tables_) make_ready(cmd, table, true);
  users_.begin_frame(ring);
  if (retired_.empty() || !users_.end_round()) return;
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
  if (!options_.timings) return {};
  const std::span<const gpu::TimedScope> scopes = timer_.read(0);
  times_.clear();
  for (const char* const name : table_step_names()) {
    PassTiming time = {name, 0.0};
    bool found = false;
    for (const gpu::TimedScope& scope : scopes) {
      if (std::string_view(time.name) != scope.name) continue;
      time.gpu_ms += scope.milliseconds;
      found = true;
    }
    if (found) times_.push_back(time);
  }
  return times_;
}

}  // namespace tyndall
