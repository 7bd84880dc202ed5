// Computes the sizes and the memory of the tables, the tables that become stale when parameters change, and the key of
// the cache.
#include "effect/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "air/phase.hpp"
#include "effect/medium.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"
#include "tyndall/version.hpp"

namespace tyndall {
namespace {

constexpr VkImageUsageFlags kTableUsage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

bool same(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }

// Increment this if the bytes of the tables change although the shaders, constants and version do not. An example is a
// change of the list of slices or of the order of the tables in a buffer.
constexpr int kTableRevision = 1;

// The hash FNV-1a (Fowler, Noll, Vo). It distinguishes inputs, but is not cryptographically secure.
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

// Appends the bits of a structure of 32-bit words, so that floats are compared exactly.
void append_words(std::string& out, const void* data, std::size_t size) {
  for (std::size_t at = 0; at < size; at += sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, static_cast<const char*>(data) + at, sizeof word);
    out += ' ';
    append_hexadecimal(out, word, 8);
  }
}

}  // namespace

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

std::array<BufferPlan, kScratchBuffers> plan_scratch(std::uint32_t views, ColorMode color, bool tabulated) {
  constexpr VkDeviceSize points = shared::kGatherAltitudes * shared::kGatherSuns;
  const VkDeviceSize ray =
      sizeof(shared::QuadratureRay) + (color == ColorMode::spectral ? shared::kSpectralRayBytes : 0);
  constexpr VkDeviceSize vec4 = 16;
  constexpr VkDeviceSize directions = points * shared::kSourceZeniths * vec4;
  constexpr VkDeviceSize phase =
      VkDeviceSize{8} * shared::kGatherAltitudes * shared::kSourceZeniths * shared::kGatherZeniths * shared::kModes;
  return {{{"table_constants", &TableScratch::constants, kConstantBytes},
           {"grid_rays", &TableScratch::grid_rays, ray * shared::kGatherAltitudes * shared::kGatherZeniths},
           {"table_rays", &TableScratch::table_rays, ray * views},
           {"phase", &TableScratch::phase, phase * (tabulated ? shared::kPhaseTerms : 1)},
           {"incident", &TableScratch::incident, points * shared::kGatherZeniths * shared::kGatherAzimuths * vec4},
           {"late_terms", &TableScratch::late_terms, directions * 2 * shared::kLateTerms},
           {"sum", &TableScratch::sum, directions * shared::kSourceAzimuths},
           {"irradiance", &TableScratch::irradiance, 3 * points * vec4},
           {"sky", &TableScratch::sky, points * vec4}}};
}

Result<void> check_table_size(const gpu::Device& device, const Params& params) {
  const UVec4& size = params.tables.size;
  const std::uint32_t limit = device.properties.limits.maxImageDimension3D;
  if (size.x <= limit && size.y <= limit && size.z <= limit / size.w) return {};
  return Error{
      ErrorCode::invalid_argument,
      "tables.size is " + std::to_string(size.x) + "," + std::to_string(size.y) + "," + std::to_string(size.z) + "," +
          std::to_string(size.w) +
          "; expected at most the limit of this device for the first two and for the product of the last two, " +
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
  if (built.scattering.color != wanted.scattering.color) return kAllTables;
  shared::SpectralMedium a = spectral_medium_from_params(built);
  shared::SpectralMedium b = spectral_medium_from_params(wanted);
  const shared::TableShape shape_a = table_shape(built);
  const shared::TableShape shape_b = table_shape(wanted);
  std::uint32_t stale = 0;
  if (!same_phase(built, wanted)) stale |= kHighTables;
  if (!same(&a, &b, sizeof a) || !same(&shape_a, &shape_b, sizeof shape_a)) stale |= kHighTables;
  // The tables of single scattering do not depend on the phase function or the ground.
  b.mie_g = a.mie_g;
  b.mie_phase = a.mie_phase;
  b.ground_albedo = a.ground_albedo;
  b.fourth_ground_albedo = a.fourth_ground_albedo;
  const bool air = !same(&a, &b, sizeof a);
  const bool shape =
      !(built.tables.size == wanted.tables.size) || built.tables.parameterization != wanted.tables.parameterization;
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
  // The shaders of a complete build, without duplicates.
  std::vector<const gpu::Shader*> used;
  Params any;
  any.scattering.color = params.scattering.color;
  any.atmosphere.mie_phase = params.atmosphere.mie_phase;
  for (const Step& step : table_steps(any, kAllTables)) {
    const gpu::Shader* shader = step.pipeline.shader;
    if (std::find(used.begin(), used.end(), shader) == used.end()) used.push_back(shader);
  }
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
  // The version alone does not distinguish builds of a driver; the UUID of its pipeline cache does.
  append_hexadecimal(key, p.driverVersion, 8);
  key += ' ';
  for (const std::uint8_t byte : p.pipelineCacheUUID) append_hexadecimal(key, byte, 2);
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  const shared::TableShape shape = table_shape(params);
  key += "\nmedium";
  append_words(key, &medium, sizeof medium);
  key += "\nshape";
  append_words(key, &shape, sizeof shape);
  if (const PhaseRows rows = phase_rows(params, params.scattering.color); !rows.empty()) {
    Hash phase;
    phase.add(rows.data(), kPhaseBytes);
    key += "\nphase ";
    append_hexadecimal(key, phase.value(), 16);
  }
  return key;
}

VkDeviceSize TableScratch::bytes() const {
  VkDeviceSize total = source_function.bytes;
  for (const BufferPlan& plan : plan_scratch(views, color, tabulated)) total += (this->*plan.buffer).bytes;
  return total;
}

VkDeviceSize table_scratch_bytes(const gpu::Device& device, const Params& params) {
  VkDeviceSize total = gpu::image_bytes(device, kSourceFunction);
  for (const BufferPlan& plan :
       plan_scratch(params.tables.size.y, params.scattering.color, air::tabulated(params.atmosphere))) {
    total += gpu::buffer_bytes(device, plan.bytes, kScratchUsage);
  }
  return total;
}

}  // namespace tyndall
