#include "effect/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "effect/medium.hpp"
#include "effect_shaders.hpp"
#include "gpu/try.hpp"
#include "tyndall/version.hpp"

namespace tyndall {
namespace {

constexpr VkImageUsageFlags kTableUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
    VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkExtent3D kSunLightExtent = {64, 256, 1};
constexpr VkExtent3D kSkyLightExtent = {64, 256, 1};
constexpr std::uint32_t kAltitudesPerSlice = 8;  // of the gathering grid
constexpr std::uint32_t kMostSlices = 4096 * 3 + 512;

// The order of the fields is that of the shaders' shape_block.
struct ShapeBlock {
  shared::TableShape shape;
  shared::ZenithQuadrature quadrature;
};
constexpr VkDeviceSize kShapeOffset = 256;  // a multiple of every device's alignment
constexpr VkDeviceSize kConstantBytes = kShapeOffset + sizeof(ShapeBlock);

constexpr std::uint32_t bit(TableId id) { return 1U << static_cast<std::uint32_t>(id); }
constexpr std::uint32_t kSingleTables = bit(TableId::single_rayleigh) | bit(TableId::single_mie);
// Built together, from the same sums.
constexpr std::uint32_t kHighTables = bit(TableId::high_orders) | bit(TableId::sky_irradiance);
constexpr std::uint32_t kAllTables = (1U << kTableCount) - 1U;

// Gauss-Legendre nodes and weights on [0; 1], by Newton's method on the Legendre polynomial.
shared::ZenithQuadrature zenith_quadrature() {
  constexpr int n = 12;
  static_assert(2 * n == shared::kGatherZeniths);
  shared::ZenithQuadrature out = {};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double before = 1.0;
      double now = x;
      for (int k = 2; k <= n; ++k) {
        const double after = ((2 * k - 1) * x * now - (k - 1) * before) / k;
        before = now;
        now = after;
      }
      slope = n * (x * now - before) / (x * x - 1.0);
      x -= now / slope;
    }
    out.node[i] = static_cast<float>(0.5 * (1.0 - x));
    out.weight[i] = static_cast<float>(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return out;
}

bool same(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }

struct BufferPlan {
  const char* name;
  gpu::Buffer TableScratch::*buffer;
  VkDeviceSize bytes;
};
constexpr std::size_t kScratchBuffers = 9;

std::array<BufferPlan, kScratchBuffers> plan_scratch(std::uint32_t views) {
  constexpr VkDeviceSize points = shared::kGatherAltitudes * shared::kGatherSuns;
  constexpr VkDeviceSize ray = (shared::kSingleNodes + shared::kHighNodes + 1) * sizeof(shared::RayNode);
  constexpr VkDeviceSize vec4 = 16;
  constexpr VkDeviceSize source = points * shared::kSourceZeniths * shared::kSourceAzimuths * vec4;
  constexpr VkDeviceSize phase = VkDeviceSize{8} * shared::kGatherAltitudes * shared::kSourceZeniths *
                                 shared::kGatherZeniths * shared::kModes;
  return {{{"table_constants", &TableScratch::constants, kConstantBytes},
           {"grid_nodes", &TableScratch::grid_nodes, ray * shared::kGatherAltitudes * shared::kGatherZeniths},
           {"ray_nodes", &TableScratch::ray_nodes, ray * views},
           {"phase", &TableScratch::phase, phase},
           {"incident", &TableScratch::incident, points * shared::kGatherZeniths * shared::kGatherAzimuths * vec4},
           {"source", &TableScratch::source, source},
           {"sum", &TableScratch::sum, source},
           {"irradiance", &TableScratch::irradiance, points * vec4},
           {"sky", &TableScratch::sky, points * vec4}}};
}
constexpr VkBufferUsageFlags kScratchUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

// To be raised when the bytes of the tables change although shaders, constants and version stay: another plan
// of the slices, another order of the tables in a buffer.
constexpr int kTableRevision = 1;
constexpr VkDeviceSize kTexelBytes = 8;

VkDeviceSize texel_bytes(const VkExtent3D& extent) {
  return kTexelBytes * extent.width * extent.height * extent.depth;
}

// FNV-1a (Fowler, Noll, Vo): for telling inputs apart, not against intent.
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3U;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

void append_hexadecimal(std::string& out, std::uint64_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += "0123456789abcdef"[(value >> shift) & 15U];
}

// The bits of a structure of 32-bit words: floats are told apart exactly.
void append_words(std::string& out, const void* data, std::size_t size) {
  for (std::size_t at = 0; at < size; at += sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, static_cast<const char*>(data) + at, sizeof word);
    out += ' ';
    append_hexadecimal(out, word, 8);
  }
}

Result<void> check_table_buffer(VkBuffer buffer, VkDeviceSize offset) {
  if (buffer == VK_NULL_HANDLE) return Error{ErrorCode::invalid_argument, "the buffer of the tables is null"};
  if (offset % kTexelBytes == 0) return {};
  return Error{ErrorCode::invalid_argument, "the tables' offset in their buffer is " + std::to_string(offset) +
                                                ", allowed are multiples of 8"};
}

VkBufferImageCopy whole_table(const gpu::Image& image, VkDeviceSize offset) {
  VkBufferImageCopy copy = {};
  copy.bufferOffset = offset;
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = image.desc.extent;
  return copy;
}

}  // namespace

Result<void> check_table_size(const gpu::Device& device, const Params& params) {
  const UVec4& size = params.tables.size;
  const std::uint32_t limit = device.properties.limits.maxImageDimension3D;
  if (size.x <= limit && size.y <= limit && size.z <= limit / size.w) return {};
  return Error{ErrorCode::invalid_argument,
               "tables.size is " + std::to_string(size.x) + "," + std::to_string(size.y) + "," +
                   std::to_string(size.z) + "," + std::to_string(size.w) +
                   ", on this device the first two and the product of the last two may be at most " +
                   std::to_string(limit)};
}

gpu::ImageDesc table_desc(TableId table, const Params& params) {
  constexpr const char* kNames[kTableCount] = {"single_rayleigh", "single_mie", "high_orders", "sun_transmittance",
                                               "sky_irradiance_table"};
  const UVec4& size = params.tables.size;
  VkExtent3D extent = {size.x, size.y, size.z * size.w};
  if (table == TableId::sun_transmittance) extent = kSunLightExtent;
  if (table == TableId::sky_irradiance) extent = kSkyLightExtent;
  return {kNames[static_cast<std::uint32_t>(table)], VK_FORMAT_R16G16B16A16_SFLOAT, extent, kTableUsage};
}

std::uint32_t stale_tables(const Params& built, const Params& wanted) {
  shared::Medium a = medium_from_params(built);
  shared::Medium b = medium_from_params(wanted);
  const shared::TableShape shape_a = table_shape(built);
  const shared::TableShape shape_b = table_shape(wanted);
  std::uint32_t stale = 0;
  if (!same(&a, &b, sizeof a) || !same(&shape_a, &shape_b, sizeof shape_a)) stale |= kHighTables;
  // Light scattered once is stored without phase function, and no ground has a part in it.
  b.mie_g = a.mie_g;
  b.mie_phase = a.mie_phase;
  b.ground_albedo = a.ground_albedo;
  const bool air = !same(&a, &b, sizeof a);
  const bool shape = !(built.tables.size == wanted.tables.size) ||
                     built.tables.parameterization != wanted.tables.parameterization;
  if (air || shape) stale |= kSingleTables;
  if (air) stale |= bit(TableId::sun_transmittance);
  return stale;
}

VkDeviceSize table_bytes(const Params& params) {
  VkDeviceSize total = 0;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    total += texel_bytes(table_desc(static_cast<TableId>(i), params).extent);
  }
  return total;
}

std::string table_key(const gpu::Device& device, const Params& params) {
  const gpu::Shader* const used[] = {
      &shaders::sun_light_comp,    &shaders::ray_nodes_comp,       &shaders::phase_matrix_comp,
      &shaders::gather_single_comp, &shaders::gather_multiple_comp, &shaders::scatter_comp,
      &shaders::table_single_comp, &shaders::table_high_comp,      &shaders::sky_light_comp};
  Hash code;
  for (const gpu::Shader* shader : used) code.add(shader->spirv.data(), shader->spirv.size_bytes());
  const shared::ZenithQuadrature quadrature = zenith_quadrature();
  code.add(&quadrature, sizeof quadrature);

  std::string key = "tyndall " TYNDALL_VERSION_STRING " tables " + std::to_string(kTableRevision) + "\nshaders ";
  append_hexadecimal(key, code.value(), 16);
  key += "\ndevice ";
  const VkPhysicalDeviceProperties& p = device.properties;
  append_hexadecimal(key, p.vendorID, 8);
  append_hexadecimal(key, p.deviceID, 8);
  key += std::string(" ") + p.deviceName + "\ndriver ";
  // The version alone does not tell builds of a driver apart; what it gives its pipeline caches does.
  append_hexadecimal(key, p.driverVersion, 8);
  key += ' ';
  for (const std::uint8_t byte : p.pipelineCacheUUID) append_hexadecimal(key, byte, 2);
  const shared::Medium medium = medium_from_params(params);
  const shared::TableShape shape = table_shape(params);
  key += "\nmedium";
  append_words(key, &medium, sizeof medium);
  key += "\nshape";
  append_words(key, &shape, sizeof shape);
  return key;
}

VkDeviceSize TableScratch::bytes() const {
  VkDeviceSize total = 0;
  for (const BufferPlan& plan : plan_scratch(views)) total += (this->*plan.buffer).bytes;
  return total;
}

VkDeviceSize table_scratch_bytes(const gpu::Device& device, const Params& params) {
  VkDeviceSize total = 0;
  for (const BufferPlan& plan : plan_scratch(params.tables.size.y)) {
    total += gpu::buffer_bytes(device, plan.bytes, kScratchUsage);
  }
  return total;
}

Result<void> TableBuilder::create(const gpu::Device& device, std::uint32_t frames_in_flight, bool timings,
                                  const Params& params) {
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
  return begin(params, kAllTables);
}

Result<void> TableBuilder::set_params(const Params& params) {
  TYNDALL_TRY(check_table_size(*device_, params));
  const std::uint32_t stale = complete_ ? stale_tables(built_, params) : kAllTables;
  const bool building = done_ < slices_.size();
  if (building && stale_tables(wanted_, params) == 0) return {};
  if (stale == 0) {
    // Back to what the finished tables are, from a build that is no longer wanted.
    if (building) {
      retire(std::exchange(next_, {}), std::exchange(scratch_, {}));
      slices_.resize(done_);
    }
    return {};
  }
  return begin(params, stale);
}

Result<void> TableBuilder::create_scratch(const Params& params) {
  const std::uint32_t views = params.tables.size.y;
  if (scratch_.views == views) return {};
  if (scratch_.views > 0) retire({}, std::exchange(scratch_, {}));
  for (const BufferPlan& plan : plan_scratch(views)) {
    TYNDALL_ASSIGN(scratch_.*plan.buffer,
                   gpu::create_buffer(*device_, plan.name, plan.bytes, kScratchUsage, gpu::MemoryKind::device));
  }
  scratch_.views = views;
  return {};
}

Result<void> TableBuilder::begin(const Params& params, std::uint32_t stale) {
  TYNDALL_TRY(check_table_size(*device_, params));
  wanted_ = params;
  stale_ = stale;
  done_ = 0;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    if ((stale & (1U << i)) == 0) continue;
    const gpu::ImageDesc desc = table_desc(static_cast<TableId>(i), params);
    TableImage& image = target(static_cast<TableId>(i));
    const VkExtent3D& has = image.image.desc.extent;
    const bool fits = image.image.view && has.width == desc.extent.width && has.height == desc.extent.height &&
                      has.depth == desc.extent.depth;
    if (fits) continue;
    if (image.image.view) {
      TableSet old = {};
      old[i] = std::exchange(image, {});
      retire(std::move(old), {});
    }
    TYNDALL_ASSIGN(image.image, gpu::create_image(*device_, desc));
  }
  TYNDALL_TRY(create_scratch(params));
  retired_.reserve(retired_.size() + 1);  // for the end of the build, when nothing may be allocated
  plan_slices();
  return {};
}

TableImage& TableBuilder::target(TableId id) {
  return (complete_ ? next_ : tables_)[static_cast<std::uint32_t>(id)];
}

void TableBuilder::plan_slices() {
  slices_.clear();
  const auto cut = [this](Stage stage, std::uint32_t count, std::uint32_t per_slice, std::uint32_t order) {
    for (std::uint32_t first = 0; first < count; first += per_slice) {
      slices_.push_back({stage, first, std::min(per_slice, count - first), order});
    }
  };
  if ((stale_ & bit(TableId::sun_transmittance)) != 0) cut(sun_light, 1, 1, 0);
  const bool high = (stale_ & kHighTables) != 0;
  const bool single = (stale_ & kSingleTables) != 0;
  if (high) {
    const std::uint32_t altitudes = shared::kGatherAltitudes;
    cut(grid_nodes, altitudes, altitudes, 0);
    cut(phase_matrix, altitudes, altitudes, 0);
    // The last turn scatters nothing any more: it adds the last order's irradiance.
    for (std::uint32_t order = 2; order <= wanted_.tables.orders + 1; ++order) {
      cut(order == 2 ? gather_single : gather_multiple, altitudes, kAltitudesPerSlice, order);
      cut(scatter, altitudes, kAltitudesPerSlice, order);
    }
    cut(sky_light, 1, 1, 0);
  }
  for (std::uint32_t altitude = 0; altitude < wanted_.tables.size.x; ++altitude) {
    slices_.push_back({ray_nodes, altitude, 1, 0});
    if (single) slices_.push_back({table_single, altitude, 1, 0});
    if (high) slices_.push_back({table_high, altitude, 1, 0});
  }
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
  const VkBuffer nodes = (slice.stage == grid_nodes || slice.stage == gather_single || slice.stage == gather_multiple
                              ? s.grid_nodes
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

void TableBuilder::finish() {
  if (complete_) {
    for (std::uint32_t i = 0; i < kTableCount; ++i) {
      if ((stale_ & (1U << i)) != 0) std::swap(tables_[i], next_[i]);
    }
  }
  complete_ = true;
  built_ = wanted_;
  retire(std::exchange(next_, {}), std::exchange(scratch_, {}));
}

void TableBuilder::retire(TableSet tables, TableScratch scratch) {
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
