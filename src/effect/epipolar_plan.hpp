// What epipolar sampling needs before anything is recorded: its buffers and their sizes, and the geometry of
// slices that the shaders are given. Pure functions.
#pragma once

#include <array>
#include <cstdint>

#include "effect/frame_constants.hpp"
#include "effect/shared.hpp"
#include "gpu/resource.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// In the order of the names in epipolar_plan.cpp.
enum class EpipolarBuffer : std::uint32_t {
  slices,
  rows,
  samples,
  coarse,
  sources,
  march_list,
  broken_list,
  break_list,
  corrected,
  tree_list,
  tree,
  states,
  reduced
};
constexpr std::uint32_t kEpipolarBuffers = 13;
using EpipolarSizes = std::array<VkDeviceSize, kEpipolarBuffers>;

// Bytes of each; all zero with technique = brute-force.
[[nodiscard]] EpipolarSizes epipolar_sizes(const EffectDesc& desc, const Params& params);
[[nodiscard]] const char* epipolar_buffer_name(EpipolarBuffer buffer);
// The settings that its size follows from, as messages name them.
[[nodiscard]] const char* epipolar_buffer_cause(EpipolarBuffer buffer);
// Its name in the shaders.
[[nodiscard]] const char* epipolar_block_name(EpipolarBuffer buffer);
constexpr VkBufferUsageFlags kEpipolarUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
// Device memory that they take.
[[nodiscard]] VkDeviceSize epipolar_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params);

// Cells of the rows of the trees; texels of a map beyond them are read directly.
[[nodiscard]] std::uint32_t tree_cells(const EffectDesc& desc);
// The geometry of the picture as the passes need it.
[[nodiscard]] shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc,
                                                           const Params& params);

// Slices or samples of the picture that the light is computed for.
[[nodiscard]] std::uint32_t reduced_count(std::uint32_t count, const Params& params);
[[nodiscard]] VkExtent2D reduced_extent(VkExtent2D extent, const Params& params);
// Blocks of unwarp.comp over a picture.
[[nodiscard]] VkExtent2D unwarp_blocks(VkExtent2D extent);

[[nodiscard]] inline bool is_downscaled(const Params& params) { return params.scattering.downscale > 1; }
// How much pixels find out by themselves because slices are few.
enum class Sparsity : std::uint32_t {
  none,
  skyline,  // of the sky, where not all slices around a pixel are in the sky: optical depth, and light from farther
            // along the slices
  all,      // optical depth in all of the sky and among samples of other depths too
};
constexpr std::size_t kSparsities = 3;
[[nodiscard]] Sparsity sparsity(VkExtent2D extent, const Params& params);
// Whether there are pictures for which sparsity() is not none.
[[nodiscard]] bool may_be_sparse(const Params& params);

}  // namespace tyndall
