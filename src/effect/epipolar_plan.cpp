#include "effect/epipolar_plan.hpp"

#include <algorithm>
#include <cmath>

#include "effect/modes.hpp"

namespace tyndall {
namespace {

constexpr VkDeviceSize kStateBytes = 16 * sizeof(float);  // of march_state.glsl
constexpr VkDeviceSize kLightBytes = 8;                   // of pack_light() in records.glsl
constexpr VkDeviceSize kLeastBytes = 256;                 // of buffers that shaders bind but do not use
// Pixels with a smaller sum of weights are marched. By default that means that no sample is near in depth; with
// correct_depth_breaks, that those which are near have little weight, or are a twentieth off. In a reduced picture a
// sample a sixth nearer or farther will do, which halves what is marched.
constexpr float kLeastWeight = 1e-2F;
constexpr float kLeastWeightAll = 0.1F;
constexpr float kLeastWeightReduced = 1e-3F;
// The list of pixels that are marched has room for one in this many, unless correct_depth_breaks gives it room for all.
// Default views list one in a thousand; a limb of 16 pixels around the whole picture is less than an eighth.
constexpr VkDeviceSize kBreakPart = 8;

struct BufferName {
  const char* name;
  const char* block;  // in the shaders
  const char* cause;  // the settings that its size follows from, for messages
};
constexpr const char* kOfSamples = "epipolar.slices and epipolar.samples";
constexpr const char* kOfShadows = "epipolar.slices, EffectDesc::max_cascades and EffectDesc::max_shadow_resolution";
constexpr const char* kOfPixels = "the pixels of EffectDesc::max_extent";
constexpr BufferName kNames[kEpipolarBuffers] = {{"slices", "slice_block", kOfSamples},
                                                 {"shadow_rows", "row_block", kOfShadows},
                                                 {"samples", "sample_block", kOfSamples},
                                                 {"coarse_inscattering", "coarse_block", kOfSamples},
                                                 {"sources", "source_block", kOfSamples},
                                                 {"march_list", "march_list_block", kOfSamples},
                                                 {"broken_blocks", "broken_list_block", kOfPixels},
                                                 {"depth_breaks", "break_list_block", kOfPixels},
                                                 {"corrected_pixels", "corrected_block", kOfPixels},
                                                 {"tree_blocks", "tree_list_block", kOfShadows},
                                                 {"shadow_tree", "tree_block", kOfShadows},
                                                 {"march_states", "state_block", kOfSamples},
                                                 {"reduced_inscattering", "reduced_block", kOfPixels}};

std::size_t index(EpipolarBuffer buffer) { return static_cast<std::size_t>(buffer); }

// Initial samples stand this many times closer in twilight: refinement goes by unshadowed light, which does not contain
// the planet's shadow.
constexpr std::uint32_t kStepsWithSunDown = 4;

// Whether the sun is more than two degrees below the horizontal of the camera.
bool sun_is_down(const FrameInputs& inputs, const Params& params) {
  constexpr double kSine = -0.0349;
  if (is_homogeneous(params.scattering)) return false;
  const Vec3& s = inputs.sun.direction_to_sun;
  const float* at = inputs.camera.world_from_view.m + 12;
  const double up[3] = {static_cast<double>(at[0]),
                        static_cast<double>(at[1]) + static_cast<double>(params.planet.radius_m),
                        static_cast<double>(at[2])};
  const double along =
      up[0] * static_cast<double>(s.x) + up[1] * static_cast<double>(s.y) + up[2] * static_cast<double>(s.z);
  return along < kSine * std::hypot(up[0], up[1], up[2]) *
                     std::hypot(static_cast<double>(s.x), static_cast<double>(s.y), static_cast<double>(s.z));
}

std::uint32_t break_capacity(const EffectDesc& desc, const Params& params) {
  const VkDeviceSize pixels = VkDeviceSize{desc.max_extent.width} * desc.max_extent.height;
  const bool all = is_downscaled(params) || params.epipolar.correct_depth_breaks.value != 0;
  const VkDeviceSize wanted = all ? pixels : pixels / kBreakPart;
  return static_cast<std::uint32_t>((wanted / shared::kMarchGroup + 1) * shared::kMarchGroup);
}

}  // namespace

std::uint32_t reduced_count(std::uint32_t count, const Params& params) {
  constexpr std::uint32_t kLeast = 32;
  return std::max(count / params.scattering.downscale, kLeast);
}

VkExtent2D reduced_extent(VkExtent2D extent, const Params& params) {
  const std::uint32_t d = params.scattering.downscale;
  return {(extent.width + d - 1) / d, (extent.height + d - 1) / d};
}

VkExtent2D unwarp_blocks(VkExtent2D extent) {
  return {(extent.width + shared::kUnwarpWidth - 1) / shared::kUnwarpWidth, (extent.height + 1) / 2};
}

bool may_be_sparse(const Params& params) {
  constexpr std::uint32_t kMany = 512;
  return params.epipolar.slices < kMany && !is_downscaled(params) && !is_homogeneous(params.scattering);
}

Sparsity sparsity(VkExtent2D extent, const Params& params) {
  constexpr std::uint32_t kFew = 256;
  // Along the border. What is told by one of two slices reaches as far from the skyline, about.
  constexpr std::uint32_t kVisiblePixels = 4;
  const bool far_apart = params.epipolar.slices * kVisiblePixels <= 2 * (extent.width + extent.height);
  if (!may_be_sparse(params) || !far_apart) return Sparsity::none;
  return params.epipolar.slices < kFew ? Sparsity::all : Sparsity::skyline;
}

std::uint32_t tree_cells(const EffectDesc& desc) {
  return (desc.max_shadow_resolution + shared::kTreeBlock - 1) / shared::kTreeBlock * shared::kTreeBlock;
}

EpipolarSizes epipolar_sizes(const EffectDesc& desc, const Params& params) {
  EpipolarSizes out = {};
  if (params.scattering.technique != Technique::epipolar) return out;
  const VkDeviceSize slices = reduced_count(params.epipolar.slices, params);
  const VkDeviceSize samples = slices * reduced_count(params.epipolar.samples, params);
  const VkDeviceSize rows = slices * desc.max_cascades;
  const VkDeviceSize breaks = break_capacity(desc, params);
  out[index(EpipolarBuffer::slices)] = slices * sizeof(shared::EpipolarSlice);
  out[index(EpipolarBuffer::rows)] = rows * sizeof(shared::ShadowRow);
  out[index(EpipolarBuffer::samples)] = samples * 16;
  out[index(EpipolarBuffer::coarse)] = samples * 4;
  out[index(EpipolarBuffer::sources)] = samples * 4;
  out[index(EpipolarBuffer::march_list)] = sizeof(shared::WorkList) + samples * 4;
  const VkExtent2D blocks = unwarp_blocks(desc.max_extent);
  const VkDeviceSize squares = VkDeviceSize{blocks.width} * (shared::kUnwarpWidth / 2) * blocks.height;
  out[index(EpipolarBuffer::broken_list)] = sizeof(shared::WorkList) + squares * 4;
  const VkExtent2D reduced = reduced_extent(desc.max_extent, params);
  out[index(EpipolarBuffer::reduced)] = is_downscaled(params) ? VkDeviceSize{reduced.width} * reduced.height *
                                                                    (is_homogeneous(params.scattering) ? 16 : 32)
                                                              : kLeastBytes;
  out[index(EpipolarBuffer::break_list)] = sizeof(shared::WorkList) + breaks * 4;
  out[index(EpipolarBuffer::corrected)] = breaks * kLightBytes;
  const VkDeviceSize number = params.epipolar.min_max_format == MinMaxFormat::float32 ? 8 : 4;
  const VkDeviceSize row_bytes = tree_cells(desc) / shared::kTreeBlock * shared::kTreeNodes * number;
  out[index(EpipolarBuffer::tree_list)] = sizeof(shared::WorkList) + rows * (tree_cells(desc) / shared::kTreeBlock) * 4;
  out[index(EpipolarBuffer::tree)] = params.epipolar.min_max_tree ? rows * row_bytes : kLeastBytes;
  const CascadeProcessing processing = params.shadows.cascade_processing;
  const VkDeviceSize turns = processing == CascadeProcessing::multi_pass_instanced ? desc.max_cascades : 1;
  out[index(EpipolarBuffer::states)] =
      processing == CascadeProcessing::single_pass ? kLeastBytes : samples * turns * kStateBytes;
  return out;
}

const char* epipolar_buffer_name(EpipolarBuffer buffer) { return kNames[index(buffer)].name; }
const char* epipolar_buffer_cause(EpipolarBuffer buffer) { return kNames[index(buffer)].cause; }
const char* epipolar_block_name(EpipolarBuffer buffer) { return kNames[index(buffer)].block; }

VkDeviceSize epipolar_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  VkDeviceSize sum = 0;
  for (const VkDeviceSize size : epipolar_sizes(desc, params)) {
    if (size > 0) sum += gpu::buffer_bytes(device, size, kEpipolarUsage);
  }
  return sum;
}

shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  shared::EpipolarConstants out = {};
  const EpipolarParams& p = params.epipolar;
  out.slices = reduced_count(p.slices, params);
  out.samples = reduced_count(p.samples, params);
  out.downscale = params.scattering.downscale;
  const VkExtent2D reduced = reduced_extent(inputs.extent, params);
  out.reduced_width = reduced.width;
  out.reduced_height = reduced.height;
  out.initial_step = sun_is_down(inputs, params) ? std::max(p.initial_step / kStepsWithSunDown, 1U) : p.initial_step;
  out.epipole_density = p.epipole_density;
  out.threshold = p.refinement_threshold;
  out.optimize_locations = p.optimize_locations.value;
  out.least_weight = is_downscaled(params)                             ? kLeastWeightReduced
                     : params.epipolar.correct_depth_breaks.value != 0 ? kLeastWeightAll
                                                                       : kLeastWeight;
  out.break_capacity = break_capacity(desc, params);
  out.show_depth_breaks = p.show_depth_breaks.value;
  out.tree_cells = p.min_max_tree.value != 0 ? tree_cells(desc) : 0;
  out.tree_format = static_cast<std::uint32_t>(p.min_max_format);
  out.cascades = params.scattering.light_shafts ? static_cast<std::uint32_t>(inputs.cascades.size()) : 0;
  out.first_cascade = std::min(inputs.first_marched_cascade, out.cascades);

  // The epipole: the direction to the sun through the camera's matrices, in double.
  const auto row_of = [](const Mat4& m, int row, const double* v) {
    double sum = 0.0;
    for (int col = 0; col < 4; ++col) sum += static_cast<double>(m.m[4 * col + row]) * v[col];
    return sum;
  };
  const Vec3& s = inputs.sun.direction_to_sun;
  const double length =
      std::sqrt(static_cast<double>(s.x) * s.x + static_cast<double>(s.y) * s.y + static_cast<double>(s.z) * s.z);
  const double world[3] = {s.x / length, s.y / length, s.z / length};
  double view[4] = {};
  for (int i = 0; i < 3; ++i) {
    // world_from_view is rigid: its transpose takes directions back.
    for (int k = 0; k < 3; ++k) view[i] += static_cast<double>(inputs.camera.world_from_view.m[4 * i + k]) * world[k];
  }
  const double clip_x = row_of(inputs.camera.clip_from_view, 0, view);
  const double clip_y = row_of(inputs.camera.clip_from_view, 1, view);
  const double clip_w = row_of(inputs.camera.clip_from_view, 3, view);
  const double width = inputs.extent.width;
  const double height = inputs.extent.height;
  double x = 0.5 * (clip_x + clip_w) * width;
  double y = 0.5 * (clip_y + clip_w) * height;
  double w = clip_w;
  if (w < 0.0) {
    x = -x;
    y = -y;
    w = -w;
  }
  const double size = std::max({std::abs(x), std::abs(y), w * std::max(width, height), 1e-300});
  x /= size;
  y /= size;
  w /= size;
  if (w < 1e-12) w = 0.0;  // parallel slices
  out.sun_x = static_cast<float>(x);
  out.sun_y = static_cast<float>(y);
  out.sun_w = static_cast<float>(w);

  // Sides that lines from the epipole reach from within the picture; in the order of shared/epipolar.h.
  // Decided by the rounded numbers that the shaders have.
  const double px = static_cast<double>(out.sun_x);
  const double py = static_cast<double>(out.sun_y);
  const double pw = static_cast<double>(out.sun_w);
  const bool ends[4] = {px - 0.5 * pw > 0.0, (height - 0.5) * pw - py > 0.0, (width - 0.5) * pw - px > 0.0,
                        py - 0.5 * pw > 0.0};
  const double lengths[4] = {height - 1.0, width - 1.0, height - 1.0, width - 1.0};
  const bool closed = ends[0] && ends[1] && ends[2] && ends[3];
  out.closed = closed ? 1 : 0;
  out.sun_in_picture = closed ? 1 : 0;
  int first = 0;
  if (!closed) {
    while (first < 3 && !(ends[first] && !ends[(first + 3) % 4])) ++first;
  }
  double along = 0.0;
  float* const starts[4] = {&out.left_start, &out.bottom_start, &out.right_start, &out.top_start};
  for (int i = 0; i < 4; ++i) {
    const int side = (first + i) % 4;
    *starts[side] = ends[side] ? static_cast<float>(along) : -1.0F;
    if (ends[side]) along += lengths[side];
  }
  out.perimeter = static_cast<float>(std::max(along, 1e-3));
  // From an epipole on the border, into the picture.
  const double to_x = 0.5 * width * pw - px;
  const double to_y = 0.5 * height * pw - py;
  const double to = std::hypot(to_x, to_y);
  out.fallback_x = to > 1e-12 ? static_cast<float>(to_x / to) : 1.0F;
  out.fallback_y = to > 1e-12 ? static_cast<float>(to_y / to) : 0.0F;
  return out;
}

}  // namespace tyndall
