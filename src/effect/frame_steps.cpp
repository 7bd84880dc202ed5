// One frame from top to bottom. Read frame_steps() and epipolar_steps() first: they are the table of contents of
// E. Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013), whose sections are named.
// To add a pass, add its shader to CMakeLists.txt, its buffers to resources.def, and a line here.
#include "effect/frame_steps.hpp"

#include <algorithm>
#include <span>

#include "air/phase.hpp"
#include "effect/frame_constants.hpp"
#include "effect/froxel_volume.hpp"
#include "effect/modes.hpp"
#include "effect_shaders.hpp"

namespace tyndall {
namespace {

// Collects the steps of one frame.
struct Frame {
  const EffectDesc& desc;
  const Params& params;
  const FrameShape& shape;
  Specialisation constants = {};
  FrameSteps steps = {};

  void dispatch(const char* name, const gpu::Shader& shader, VkExtent3D invocations,
                std::array<std::uint32_t, 2> push = {}) {
    Step step;
    step.name = name;
    step.pipeline = pipeline_key(variant_for(shader, shape.target, params.scattering.color), constants);
    step.invocations = invocations;
    step.push = push;
    steps.add(step);
  }
  void dispatch_over(Resource list, const char* name, const gpu::Shader& shader,
                     std::array<std::uint32_t, 2> push = {}) {
    Step step;
    step.name = name;
    step.kind = Step::Kind::dispatch_indirect;
    step.chosen = list;
    step.pipeline = pipeline_key(variant_for(shader, shape.target, params.scattering.color), constants);
    step.push = push;
    steps.add(step);
  }
  void reset(Resource list) { other(Step::Kind::reset_list, "reset_list", list); }
  void other(Step::Kind kind, const char* name, Resource chosen, Resource target = Resource::none) {
    Step step;
    step.name = name;
    step.kind = kind;
    step.chosen = chosen;
    step.target = target;
    steps.add(step);
  }

  // Returns the number of marched cascades.
  [[nodiscard]] std::uint32_t marched_cascades() const {
    const bool any = shape.cascades > shape.first_marched_cascade && marches_shadows(params.scattering);
    return any ? shape.cascades - shape.first_marched_cascade : 0;
  }
  [[nodiscard]] bool uses_tree() const { return params.epipolar.min_max_tree && marches_shadows(params.scattering); }
};

// Sets the amounts of work per invocation. On CPU devices, an invocation does much, because it shares loads and because
// starting a workgroup is expensive. GPUs need more invocations: with 512 slices, 16384 threads would refine samples,
// and about 8000 would build trees. These values have not been measured on a GPU.
void set_sizes(Specialisation& out, Target target) {
  const bool cpu = target == Target::cpu;
  out[shared::kRefineRunId] = cpu ? 8 : 2;
  out[shared::kTreePartId] = cpu ? 6 : 4;
}

// Returns the values of all specialisation constants. A constant that has no effect in a mode is 0 there, so that the
// mode does not need several equal pipelines.
Specialisation specialisation(const Frame& frame) {
  const ScatteringParams& s = frame.params.scattering;
  const bool homogeneous = is_homogeneous(s);
  const bool occluded = !homogeneous && s.multiple == MultipleScattering::occluded;
  SingleScattering single = s.single;
  // The tables contain neither the homogeneous medium nor clouds, and lack single scattering if tables_lack_single().
  const bool integrates = homogeneous || frame.shape.integrate_single || frame.shape.clouds;
  if (single == SingleScattering::table && integrates) single = SingleScattering::integration;
  const bool shadowed_tables = !homogeneous && (single == SingleScattering::table || occluded);
  Specialisation out;
  const auto set = [&out](std::uint32_t id, auto value) { out[id] = static_cast<std::uint8_t>(value); };
  set(shared::kSingleId, single);
  set(shared::kOccludedId, occluded);
  set(shared::kSectionsId, shadowed_tables ? s.sections : LitSections{});
  set(shared::kTreeId, frame.uses_tree());
  set(shared::kColorsId, frame.shape.shadow_colors && frame.marched_cascades() > 0);
  set(shared::kHomogeneousId, homogeneous);
  set(shared::kDownscaleId, s.downscale);
  set(shared::kExtinctionId, homogeneous ? Extinction{} : s.extinction);
  set(shared::kCountId, frame.desc.counters);
  set(shared::kSparsityId, sparsity(frame.shape.extent, frame.params));
  set(shared::kRefinementId, frame.params.epipolar.refinement);
  set(shared::kFormatId, frame.params.epipolar.min_max_format);
  set(shared::kCloudsId, frame.shape.clouds && (single != SingleScattering::none || occluded));
  set(shared::kFloatOutputId, frame.desc.output_format == OutputFormat::rgba32f);
  set(shared::kPhaseTableId, air::tabulated(frame.params.atmosphere));
  set_sizes(out, frame.shape.target);
  return out;
}

// Marches the listed samples through all cascades in one pass, one after the other, or side by side (section 1.8).
void march_cascades(Frame& f, CascadeProcessing processing) {
  const gpu::Shader& march = shaders::march_samples_comp;
  const std::uint32_t cascades = f.marched_cascades();
  if (processing == CascadeProcessing::multi_pass) {
    for (std::uint32_t i = 0; i < cascades; ++i) {
      f.dispatch_over(Resource::march_list, "march_samples", march, {shared::kOneCascade, i});
    }
  } else {
    f.dispatch_over(Resource::march_list, "march_samples", march, {static_cast<std::uint32_t>(processing), 0});
  }
  if (processing == CascadeProcessing::single_pass) return;
  const bool instanced = processing == CascadeProcessing::multi_pass_instanced;
  f.dispatch_over(Resource::march_list, "march_samples", march, {shared::kFinish, instanced ? cascades : 1});
}

// Marches the listed pixels, whose depth differs from that of all samples around them (section 1.7).
void march_and_correct(Frame& f, const char* name, const gpu::Shader& correct) {
  f.dispatch_over(Resource::correction_list, "march_samples", shaders::march_samples_comp, {shared::kPixels, 0});
  f.dispatch_over(Resource::correction_list, name, correct);
}

// Interpolates pixels between slices (section 1.7): first the blocks at one depth, then the pixels of the other blocks,
// and finally the pixels that fit no sample.
void unwarp_steps(Frame& f) {
  const VkExtent2D blocks = unwarp_blocks(f.shape.extent, f.shape.target);
  f.dispatch("unwarp", shaders::unwarp_comp, {blocks.width, blocks.height, 1});
  f.dispatch_over(Resource::discontinuity_blocks, "unwarp_pixels", shaders::unwarp_pixels_comp);
  march_and_correct(f, "correct_pixels", shaders::correct_pixels_comp);
}

// Interpolates with scattering.downscale: fills a buffer of half or a quarter of the resolution (Yusov, "IVB
// Atmospheric Light Scattering", 2012, sections 6.6 and 6.7), and then upscales it bilaterally (section 6.8).
void downscaled_steps(Frame& f) {
  const VkExtent2D blocks = unwarp_blocks(downscaled_extent(f.shape.extent, f.params), f.shape.target);
  const std::uint8_t extinction = f.constants[shared::kExtinctionId];
  f.constants[shared::kExtinctionId] = 0;  // used only by passes that compose the background
  f.dispatch("unwarp_downscaled", shaders::unwarp_comp, {blocks.width, blocks.height, 1});
  f.dispatch_over(Resource::discontinuity_blocks, "unwarp_downscaled_pixels", shaders::unwarp_pixels_comp);
  march_and_correct(f, "correct_downscaled", shaders::correct_downscaled_comp);
  f.constants[shared::kExtinctionId] = extinction;
  f.reset(Resource::discontinuity_blocks);
  f.reset(Resource::correction_list);
  f.dispatch("upscale", shaders::upscale_comp, {(f.shape.extent.width + 1) / 2, (f.shape.extent.height + 1) / 2, 1});
  f.dispatch_over(Resource::discontinuity_blocks, "upscale_pixels", shaders::upscale_pixels_comp);
  march_and_correct(f, "correct_pixels", shaders::correct_pixels_comp);
}

// Fills the froxel volume in bands of rows, so that a dispatch stays short. The default size has one band, the largest
// eight. With scattering.enabled off, the volume holds no light and full transmittance.
void froxel_steps(Frame& f) {
  constexpr std::uint32_t kTexelsPerBand = 512 * 64 * 256;
  const FroxelParams& p = f.params.froxels;
  const std::uint32_t group = shaders::froxels_comp.local_size[1];
  const std::uint32_t rows = std::max(kTexelsPerBand / (p.columns * p.slices * group), 1U) * group;
  for (std::uint32_t first = 0; first < p.rows; first += rows) {
    f.dispatch("froxels", shaders::froxels_comp, {p.columns, std::min(rows, p.rows - first), 1},
               {first, f.params.scattering.enabled ? 0U : 1U});
  }
}

void epipolar_steps(Frame& f) {
  const std::uint32_t slices = downscaled_count(f.params.epipolar.slices, f.params);
  const std::uint32_t samples = downscaled_count(f.params.epipolar.samples, f.params);
  const std::uint32_t cascades = f.marched_cascades();
  const CascadeProcessing processing =
      cascades > 0 ? f.params.shadows.cascade_processing : CascadeProcessing::single_pass;

  const std::uint32_t march_groups_z = processing == CascadeProcessing::multi_pass_instanced ? cascades : 1;
  f.dispatch("slice_end_points", shaders::slice_end_points_comp, {slices, 1, 1}, {march_groups_z, 0});  // 1.2
  f.dispatch("slice_samples", shaders::slice_samples_comp, {samples, slices, 1});  // 1.2, and in-scattering of 1.3
  f.dispatch("refine_samples", shaders::refine_samples_comp,                       // 1.3
             {slices * variant_for(shaders::refine_samples_comp, f.shape.target).local_size[0], 1, 1});
  if (cascades > 0) {
    f.dispatch("slice_directions", shaders::slice_directions_comp,
               {slices * shared::kLineThreads, cascades, 1});  // 1.4
  }
  if (uses_froxels(f.params)) froxel_steps(f);  // after the steps of FramePart::first, which need no shadows
  if (cascades > 0 && f.uses_tree()) f.dispatch_over(Resource::tree_blocks, "min_max_tree", shaders::min_max_tree_comp);
  march_cascades(f, processing);                                                               // 1.6, 1.8
  f.dispatch("interpolate_samples", shaders::interpolate_samples_comp, {samples, slices, 1});  // 1.3
  is_downscaled(f.params) ? downscaled_steps(f) : unwarp_steps(f);                             // 1.7
  if (f.params.epipolar.show_sampling) {
    // The marched samples are drawn over the interpolated ones.
    const gpu::Shader& show = shaders::show_sampling_comp;
    for (const std::uint32_t marched : {0U, 1U}) f.dispatch("show_sampling", show, {samples, slices, 1}, {marched, 0});
  }
}

// Marches every pixel in bands of rows, so that a dispatch stays short. In pictures of up to 4 million pixels, a band
// has about kPixelsPerBand pixels; larger pictures have kMaxBands bands of more pixels.
void brute_force_steps(Frame& f) {
  constexpr std::uint32_t kPixelsPerBand = 131072;
  constexpr std::uint32_t kMaxBands = 32;
  const gpu::Shader& shader = shaders::march_per_pixel_comp;
  const auto [width, height] = f.shape.extent;
  const std::uint32_t wanted = std::max(kPixelsPerBand / width, (height + kMaxBands - 1) / kMaxBands);
  const std::uint32_t group = shader.local_size[1];
  const std::uint32_t rows = std::max((wanted + group - 1) / group, 1U) * group;
  for (std::uint32_t first = 0; first < height; first += rows)
    f.dispatch("march_per_pixel", shader, {width, std::min(rows, height - first), 1}, {first, 0});
}

}  // namespace

std::span<const Step> FrameSteps::of(FramePart part) const {
  const std::span<const Step> all = {list_.data(), count_};
  if (part == FramePart::whole) return all;
  const auto second = std::find_if(all.begin(), all.end(), [](const Step& step) {
    const Uses uses = uses_of(step);
    return std::any_of(uses.begin(), uses.end(), [](const Use& use) {
      return info_of(use.resource).lifetime == Lifetime::caller && use.resource != Resource::scene_depth;
    });
  });
  const auto first = static_cast<std::size_t>(second - all.begin());
  return part == FramePart::first ? all.first(first) : all.subspan(first);
}

FrameShape frame_shape(const FrameInputs& inputs, const Params& params, Target target) {
  return {inputs.extent,
          static_cast<std::uint32_t>(inputs.cascades.size()),
          inputs.first_marched_cascade,
          inputs.shadow_colors.view != VK_NULL_HANDLE,
          tables_lack_single(inputs, params),
          target,
          has_clouds(inputs)};
}

FrameSteps frame_steps(const EffectDesc& desc, const Params& params, const FrameShape& shape) {
  Frame f = {desc, params, shape};
  f.constants = specialisation(f);
  const VkExtent3D pixels = {shape.extent.width, shape.extent.height, 1};
  if (desc.counters) f.other(Step::Kind::clear, "clear_counters", Resource::counters);
  const bool epipolar = params.scattering.enabled && params.scattering.technique == Technique::epipolar;
  if (uses_froxels(params) && !epipolar) froxel_steps(f);
  if (!params.scattering.enabled) {
    f.dispatch("no_air", shaders::no_air_comp, pixels);
  } else if (params.scattering.technique == Technique::brute_force) {
    brute_force_steps(f);
  } else if (params.scattering.technique == Technique::froxels) {
    f.dispatch("compose_froxels", shaders::compose_froxels_comp, pixels);
  } else {
    epipolar_steps(f);
  }
  if (desc.counters) {
    f.other(Step::Kind::copy, "copy_counters", Resource::counters, Resource::counters_readback);
    f.other(Step::Kind::host_read, "read_counters", Resource::counters_readback);
  }
  return f.steps;
}

Sparsity sparsity(VkExtent2D extent, const Params& params) {
  constexpr std::uint32_t kMany = 512;
  constexpr std::uint32_t kFew = 256;
  // Seams are visible if slices are farther apart along the border.
  constexpr std::uint32_t kVisiblePixels = 4;
  const std::uint32_t slices = params.epipolar.slices;
  if (slices >= kMany || is_downscaled(params) || is_homogeneous(params.scattering)) return Sparsity::none;
  if (slices * kVisiblePixels > 2 * (extent.width + extent.height)) return Sparsity::none;
  return slices < kFew ? Sparsity::all : Sparsity::skyline;
}

}  // namespace tyndall
