#include "effect/resources.hpp"

#include <algorithm>

#include "effect/frame_steps.hpp"
#include "effect/modes.hpp"
#include "effect/shared.hpp"

namespace tyndall {
namespace {

// The state of a ray between passes, with three and with four channels; see march_state.glsl.
constexpr VkDeviceSize kStateBytes = 16 * sizeof(float);
constexpr VkDeviceSize kSpectralStateBytes = 20 * sizeof(float);
constexpr VkDeviceSize kCorrectedBytes = 8;  // pack_light() of records.glsl
// Buffers that a shader binds although it does not use them with these settings.
constexpr VkDeviceSize kUnusedBytes = 256;
// correction_list has room for an eighth of all pixels. In ordinary views, a thousandth of the pixels is listed. Even a
// limb that is 16 pixels wide and runs along the whole border of the picture is less than an eighth of it.
constexpr VkDeviceSize kCorrectedPart = 8;

// Returns the size of a frame buffer that a step uses [bytes].
VkDeviceSize bytes_of(Resource resource, const EffectDesc& desc, const Params& params) {
  const VkDeviceSize slices = downscaled_count(params.epipolar.slices, params);
  const VkDeviceSize samples = slices * downscaled_count(params.epipolar.samples, params);
  const VkDeviceSize lines = slices * desc.max_cascades;
  const VkDeviceSize blocks_of_line = tree_cells(desc) / shared::kTreeBlock;
  const VkDeviceSize corrected = correction_capacity(desc, params);
  const bool spectral = params.scattering.color == ColorMode::spectral;
  const CascadeProcessing processing = params.shadows.cascade_processing;
  switch (resource) {
    case Resource::slices: return slices * sizeof(shared::EpipolarSlice);
    case Resource::samples: return samples * 16 + (spectral ? (samples + 3) / 4 * 16 : 0);
    case Resource::coarse_inscattering:
    case Resource::interpolation_sources: return samples * 4;
    case Resource::march_list: return sizeof(shared::WorkList) + samples * 4;
    case Resource::slice_lines: return lines * sizeof(shared::SliceLine);
    case Resource::tree_blocks:
      // The first pass resets the list even if nothing is appended to it.
      if (!marches_shadows(params.scattering)) return sizeof(shared::WorkList);
      return sizeof(shared::WorkList) + lines * blocks_of_line * 4;
    case Resource::min_max_tree: {
      if (!params.epipolar.min_max_tree) return kUnusedBytes;
      const VkDeviceSize node = params.epipolar.min_max_format == MinMaxFormat::float32 ? 8 : 4;
      return lines * blocks_of_line * shared::kTreeNodes * node;
    }
    case Resource::march_states: {
      if (processing == CascadeProcessing::single_pass) return kUnusedBytes;
      const bool instanced = processing == CascadeProcessing::multi_pass_instanced;
      return samples * (spectral ? kSpectralStateBytes : kStateBytes) * (instanced ? desc.max_cascades : 1);
    }
    case Resource::discontinuity_blocks: {
      const VkExtent2D blocks = unwarp_blocks(desc.max_extent, Target::cpu);  // has the most
      const VkDeviceSize squares = VkDeviceSize{blocks.width} * (shared::kUnwarpWidthCpu / 2) * blocks.height;
      return sizeof(shared::WorkList) + squares * 4;
    }
    case Resource::correction_list: return sizeof(shared::WorkList) + corrected * 4;
    case Resource::corrected_inscattering: return corrected * kCorrectedBytes;
    case Resource::downscaled_inscattering: {
      if (!is_downscaled(params)) return kUnusedBytes;
      const VkExtent2D extent = downscaled_extent(desc.max_extent, params);
      return VkDeviceSize{extent.width} * extent.height *
             ((is_homogeneous(params.scattering) ? 16 : 32) + (spectral ? 16 : 0));
    }
    default: return 0;
  }
}

}  // namespace

FrameBufferSizes frame_buffer_sizes(const EffectDesc& desc, const Params& params) {
  FrameBufferSizes out;
  const ResourceSet used = resources_of_frames(desc, params);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    const Resource resource = frame_buffer(i);
    if (used[index_of(resource)]) out.bytes[i] = bytes_of(resource, desc, params);
  }
  return out;
}

std::uint32_t correction_capacity(const EffectDesc& desc, const Params& params) {
  const VkDeviceSize pixels = VkDeviceSize{desc.max_extent.width} * desc.max_extent.height;
  const bool all = is_downscaled(params) || params.epipolar.correct_depth_breaks.value != 0;
  const VkDeviceSize wanted = all ? pixels : pixels / kCorrectedPart;
  return static_cast<std::uint32_t>((wanted / shared::kMarchGroup + 1) * shared::kMarchGroup);
}

std::uint32_t tree_cells(const EffectDesc& desc) {
  return (desc.max_shadow_resolution + shared::kTreeBlock - 1) / shared::kTreeBlock * shared::kTreeBlock;
}

std::uint32_t downscaled_count(std::uint32_t count, const Params& params) {
  constexpr std::uint32_t kMin = 32;
  return std::max(count / params.scattering.downscale, kMin);
}

VkExtent2D downscaled_extent(VkExtent2D extent, const Params& params) {
  const std::uint32_t d = params.scattering.downscale;
  return {(extent.width + d - 1) / d, (extent.height + d - 1) / d};
}

VkExtent2D unwarp_blocks(VkExtent2D extent, Target target) {
  const std::uint32_t width = target == Target::cpu ? shared::kUnwarpWidthCpu : shared::kUnwarpWidthGpu;
  return {(extent.width + width - 1) / width, (extent.height + 1) / 2};
}

}  // namespace tyndall
