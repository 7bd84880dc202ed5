#include "models/table_values.hpp"

#include <cmath>
#include <cstring>
#include <span>

#include "gpu/try.hpp"
#include "models/table_axes.hpp"

namespace tyndall::models {
namespace {

// Converts a half (IEEE 754 binary16) to a float. NaN and infinity, which the tables do not contain, are not handled.
float float_from_half(std::uint16_t half) {
  const int exponent = (half >> 10U) & 31U;
  const auto mantissa = static_cast<float>(half & 1023U);
  const float magnitude = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0F + mantissa, exponent - 25);
  return (half & 0x8000U) != 0 ? -magnitude : magnitude;
}

Result<std::vector<std::uint16_t>> download(gpu::Host& host, Effect& effect) {
  const gpu::Device& device = host.device();
  const VkDeviceSize size = effect.table_bytes();
  TYNDALL_ASSIGN(const gpu::Buffer to, gpu::create_buffer(device, "exported_tables", size,
                                                          VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    if (Result<void> saved = effect.record_save_tables(cmd, to.buffer.get()); !saved) return saved;
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                 VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::vector<std::uint16_t> out(size / sizeof(std::uint16_t));
  std::memcpy(out.data(), to.mapped, size);
  return out;
}

using Factor = std::array<double, 3> TableFactors::*;

// The factors of all tables of an effect.
struct Scales {
  std::vector<TableFactors> factors;
  std::vector<std::array<double, 3>> shapes;
};

TableValues scattering_table(TableId id, std::span<const std::uint16_t> texels, const UVec4& size,
                             const Scales& scales) {
  const bool high = id == TableId::high_orders;
  const Factor factor = high                        ? &TableFactors::high_orders
                        : id == TableId::single_mie ? &TableFactors::single_mie
                                                    : &TableFactors::single_rayleigh;
  TableValues out = {id, {size.x, size.y, size.w, size.z}, {}};
  const std::uint32_t depth = size.z * size.w;
  out.values.reserve(std::size_t{3} * size.x * size.y * depth);
  for (std::uint32_t altitude = 0; altitude < size.x; ++altitude) {
    for (std::uint32_t view = 0; view < size.y; ++view) {
      const std::array<double, 3>& scale = scales.factors[std::size_t{altitude} * size.y + view].*factor;
      for (std::uint32_t z = 0; z < depth; ++z) {
        const std::size_t at = ((std::size_t{z} * size.y + view) * size.x + altitude) * 4;
        for (std::size_t c = 0; c < 3; ++c) {
          const double t = float_from_half(texels[at + c]);
          const double shape = high ? scales.shapes[z / size.z][c] : 1.0;
          out.values.push_back(static_cast<float>(scale[c] * shape * t * t * t * t));
        }
      }
    }
  }
  return out;
}

TableValues light_table(TableId id, std::span<const std::uint16_t> texels, const VkExtent3D& extent) {
  TableValues out = {id, {1, 1, extent.height, extent.width}, {}};
  const std::size_t count = std::size_t{extent.width} * extent.height;
  out.values.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) out.values.push_back(float_from_half(texels[4 * i + c]));
  }
  return out;
}

}  // namespace

const char* table_name(TableId table) {
  constexpr const char* kNames[kTableCount] = {"single_rayleigh", "single_mie", "high_orders", "sun_transmittance",
                                               "sky_irradiance"};
  return kNames[static_cast<std::uint32_t>(table)];
}

Result<std::vector<TableValues>> table_values(gpu::Host& host, Effect& effect, const Params& params) {
  TYNDALL_ASSIGN(const std::vector<std::uint16_t> all, download(host, effect));
  const TableAxes axes = table_axes(params);
  const Scales scales = {table_factors(params, axes), angle_shapes(params, axes)};
  std::span<const std::uint16_t> texels = all;
  std::vector<TableValues> out;
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const auto id = static_cast<TableId>(i);
    const VkExtent3D extent = table_desc(id, params).extent;
    const std::size_t count = std::size_t{4} * extent.width * extent.height * extent.depth;
    const std::span<const std::uint16_t> own = texels.first(count);
    texels = texels.subspan(count);
    const bool light = id == TableId::sun_transmittance || id == TableId::sky_irradiance;
    out.push_back(light ? light_table(id, own, extent) : scattering_table(id, own, params.tables.size, scales));
  }
  return out;
}

}  // namespace tyndall::models
