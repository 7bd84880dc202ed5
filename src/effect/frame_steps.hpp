// The steps of a frame, as a pure function of the parameters, the limits of the effect and the inputs that are present.
// The method is described in docs/epipolar.md.
#pragma once

#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "effect/step.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// The inputs that are present in a frame, as far as the steps depend on them.
struct FrameShape {
  VkExtent2D extent = {1, 1};
  std::uint32_t cascades = 0;
  std::uint32_t first_marched_cascade = 0;
  bool shadow_colors = false;
  bool integrate_single = false;  // integrate in place of scattering.single = table: tables_lack_single()
  Target target = Target::cpu;
  bool clouds = false;
};
[[nodiscard]] FrameShape frame_shape(const FrameInputs& inputs, const Params& params, Target target);

// A list of fixed capacity. It does not allocate, because it is created for every frame.
class FrameSteps {
 public:
  static constexpr std::size_t kMax = 64;

  void add(const Step& step) { list_[count_++] = step; }
  [[nodiscard]] const Step* begin() const { return list_.data(); }
  [[nodiscard]] const Step* end() const { return list_.data() + count_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  // Returns the steps of a part of the frame. The second part begins with the first step that uses an image of the
  // caller other than the depth.
  [[nodiscard]] std::span<const Step> of(FramePart part) const;

 private:
  std::array<Step, kMax> list_ = {};
  std::size_t count_ = 0;
};
[[nodiscard]] FrameSteps frame_steps(const EffectDesc& desc, const Params& params, const FrameShape& shape);

// The quantities that pixels compute from their own rays because there are few slices; see shared/epipolar.h.
enum class Sparsity : std::uint32_t {
  none = shared::kSparsityNone,
  skyline = shared::kSparsitySkyline,
  all = shared::kSparsityAll
};
[[nodiscard]] Sparsity sparsity(VkExtent2D extent, const Params& params);

using ResourceSet = std::bitset<kResources>;
// Returns the resources that frames of any shape use with these settings. The result does not depend on
// scattering.enabled, so switching scattering off and on allocates nothing.
[[nodiscard]] ResourceSet resources_of_frames(const EffectDesc& desc, const Params& params);
// Returns the pipelines of frames of any shape with these settings.
[[nodiscard]] std::vector<PipelineKey> pipelines_of_frames(const EffectDesc& desc, const Params& params,
                                                           Target target = Target::cpu);
// Returns the descriptor sets of frames of any shape with these settings.
[[nodiscard]] std::vector<SetKey> sets_of_frames(const EffectDesc& desc, const Params& params,
                                                 Target target = Target::cpu);
// Returns the pipelines of frames of any shape with any parameters, but with the representation of light and the kind
// of phase function (air::tabulated) of `similar`.
[[nodiscard]] std::vector<PipelineKey> all_frame_pipelines(const EffectDesc& desc, Target target = Target::cpu,
                                                           const Params& similar = {});

}  // namespace tyndall
