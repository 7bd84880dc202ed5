// Declarations shared by tables.cpp and table_builder.cpp: sizes, sets of tables, and the layout of scratch memory.
#pragma once

#include <array>
#include <cstdint>

#include "effect/phase_rows.hpp"
#include "effect/tables.hpp"

namespace tyndall {

constexpr VkExtent3D kSunLightExtent = {64, 256, 1};
constexpr VkExtent3D kSkyLightExtent = {64, 256, 1};
constexpr VkDeviceSize kTexelBytes = 8;

// The order of the fields is that of the shaders' shape_block.
struct ShapeBlock {
  shared::TableShape shape;
  shared::ZenithQuadrature quadrature;
};
// Offset of the ShapeBlock, behind the medium with its phase function: a multiple of every device's alignment.
constexpr VkDeviceSize kShapeOffset = (kMediumBlockBytes + 255) / 256 * 256;
constexpr VkDeviceSize kConstantBytes = kShapeOffset + sizeof(ShapeBlock);

constexpr std::uint32_t bit(TableId id) { return 1U << static_cast<std::uint32_t>(id); }
constexpr std::uint32_t kSingleTables = bit(TableId::single_rayleigh) | bit(TableId::single_mie);
// These tables are built together from the same sums.
constexpr std::uint32_t kHighTables = bit(TableId::high_orders) | bit(TableId::sky_irradiance);
constexpr std::uint32_t kAllTables = (1U << kTableCount) - 1U;

struct BufferPlan {
  const char* name;
  gpu::Buffer TableScratch::*buffer;
  VkDeviceSize bytes;
};
constexpr std::size_t kScratchBuffers = 9;
constexpr gpu::ImageDesc kSourceFunction = {
    "source_function",
    VK_FORMAT_R16G16B16A16_SFLOAT,
    {shared::kGatherSuns, shared::kGatherAltitudes* shared::kSourceAzimuths, shared::kSourceZeniths},
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};

[[nodiscard]] std::array<BufferPlan, kScratchBuffers> plan_scratch(std::uint32_t views, ColorMode color,
                                                                   bool tabulated);
constexpr VkBufferUsageFlags kScratchUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

// Computes Gauss-Legendre nodes and weights on [0; 1] by Newton's method on the Legendre polynomial.
[[nodiscard]] shared::ZenithQuadrature zenith_quadrature();

[[nodiscard]] inline VkDeviceSize texel_bytes(const VkExtent3D& extent) {
  return kTexelBytes * extent.width * extent.height * extent.depth;
}

}  // namespace tyndall
