// Determines the resources and pipelines of frames before any of them is recorded, by listing the steps of all frames
// that the settings allow.
#include <algorithm>

#include "effect/frame_steps.hpp"

namespace tyndall {
namespace {

// Calls body(steps) for frames of every shape.
template <typename Body>
void for_each_shape(const EffectDesc& desc, const Params& params, Target target, Body&& body) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{16384, 16384}}) {
    for (const std::uint32_t cascades : {0U, desc.max_cascades}) {
      for (const bool colors : {false, true}) {
        if (colors && !desc.shadow_colors) continue;
        for (const bool integrate_single : {false, true}) {
          body(frame_steps(desc, params, {extent, cascades, 0, colors, integrate_single, target}));
        }
        if (desc.clouds) body(frame_steps(desc, params, {extent, cascades, 0, colors, false, target, true}));
      }
    }
  }
}

void add_pipelines(std::vector<PipelineKey>& out, const EffectDesc& desc, const Params& params, Target target) {
  for_each_shape(desc, params, target, [&](const FrameSteps& steps) {
    for (const Step& step : steps) {
      if (!step.dispatches()) continue;
      if (std::find(out.begin(), out.end(), step.pipeline) == out.end()) out.push_back(step.pipeline);
    }
  });
}

}  // namespace

ResourceSet resources_of_frames(const EffectDesc& desc, const Params& params) {
  Params enabled = params;
  enabled.scattering.enabled = true;
  ResourceSet out;
  // The variants for all targets have the same bindings.
  for_each_shape(desc, enabled, Target::cpu, [&](const FrameSteps& steps) {
    for (const Step& step : steps) {
      for (const Use& use : uses_of(step)) out.set(index_of(use.resource));
    }
  });
  return out;
}

std::vector<PipelineKey> pipelines_of_frames(const EffectDesc& desc, const Params& params, Target target) {
  std::vector<PipelineKey> out;
  add_pipelines(out, desc, params, target);
  return out;
}

std::vector<SetKey> sets_of_frames(const EffectDesc& desc, const Params& params, Target target) {
  std::vector<SetKey> out;
  for_each_shape(desc, params, target, [&](const FrameSteps& steps) {
    for (const Step& step : steps) {
      if (!step.dispatches()) continue;
      const SetKey key = set_key(step);
      if (std::find(out.begin(), out.end(), key) == out.end()) out.push_back(key);
    }
  });
  return out;
}

std::vector<PipelineKey> all_frame_pipelines(const EffectDesc& desc, Target target, const Params& similar) {
  std::vector<PipelineKey> out;
  const auto add = [&](Params params) {
    params.scattering.color = similar.scattering.color;
    params.atmosphere.mie_phase = similar.atmosphere.mie_phase;
    add_pipelines(out, desc, params, target);
  };
  // Each loop below varies one group of constants. Apart from the medium, no shader has constants of two groups, so the
  // groups need not be combined.
  // FrameSteps.AllPipelinesAreFound of tests/unit/frame_steps_test.cpp verifies this with all combinations.
  Params p;
  p.epipolar.show_sampling = true;
  add(p);
  p.scattering.enabled = false;
  add(p);
  for (const Refinement refinement : {Refinement::depth, Refinement::inscattering}) {
    for (const MinMaxFormat format : {MinMaxFormat::unorm16, MinMaxFormat::float32}) {
      p = {};
      p.epipolar.refinement = refinement;
      p.epipolar.min_max_format = format;
      add(p);
    }
  }
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    for (const Extinction extinction : {Extinction::epipolar, Extinction::per_pixel}) {
      for (const std::uint32_t downscale : {1U, 2U, 4U}) {
        for (const std::uint32_t slices : {64U, 256U, 512U}) {  // one per Sparsity
          p = {};
          p.scattering.medium = medium;
          p.scattering.extinction = extinction;
          p.scattering.downscale = downscale;
          p.epipolar.slices = slices;
          add(p);
        }
      }
    }
    for (const SingleScattering single :
         {SingleScattering::none, SingleScattering::integration, SingleScattering::table}) {
      for (const MultipleScattering multiple :
           {MultipleScattering::none, MultipleScattering::occluded, MultipleScattering::unoccluded}) {
        for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
          for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
            for (const bool tree : {false, true}) {
              p = {};
              p.scattering.medium = medium;
              p.scattering.single = single;
              p.scattering.multiple = multiple;
              p.scattering.sections = sections;
              p.scattering.technique = technique;
              p.epipolar.min_max_tree = tree;
              add(p);
            }
          }
        }
      }
    }
  }
  return out;
}

}  // namespace tyndall
