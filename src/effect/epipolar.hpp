// Epipolar sampling: its pipelines, and the recording of its passes in their order.
// The method and the reasons for where it departs from the published one: docs/epipolar.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "effect/epipolar_plan.hpp"
#include "effect/modes.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/timer.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

class Epipolar {
 public:
  // Buffers for other settings, in place of those whose size changes.
  struct Pending {
    EffectDesc desc;
    std::array<gpu::Buffer, kEpipolarBuffers> buffers = {};
    std::array<bool, kEpipolarBuffers> replaced = {};
  };

  // Makes the pipelines that do not depend on parameters. There are no buffers before the first commit().
  Result<void> create(const gpu::Device& device, const EffectDesc& desc);
  // Allocates what other settings need and changes nothing.
  Result<Pending> plan(const EffectDesc& desc, const Params& params);
  // Takes over what was planned last. Commands in flight may still use the buffers that it replaces: they are freed
  // when begin_frame() has been called often enough.
  void commit(Pending&& pending) noexcept;
  void begin_frame();
  // Makes the pipelines that these settings need, where missing. They are expensive to make.
  Result<void> prepare(const EffectDesc& desc, const Params& params);
  // All others, at most `budget`, which is counted down; `progress` counts those that exist, and all.
  Result<void> prepare_others(std::uint32_t& budget, Progress& progress);

  // Records all passes. `resources` are those of the frame: medium_block, frame_block, epipolar_block,
  // counter_block, scene_color, scene_depth, shadow_maps, shadow_depths, shadow_colors, the scattering tables,
  // output_color.
  Result<void> record(VkCommandBuffer cmd, const FrameInputs& inputs, const Params& params,
                      std::span<const gpu::NamedResource> resources, gpu::Timer* timer);

  [[nodiscard]] VkDeviceSize bytes(EpipolarBuffer buffer) const {
    return buffers_[static_cast<std::uint32_t>(buffer)].bytes;
  }
  [[nodiscard]] VkDeviceSize bytes() const;          // in use
  [[nodiscard]] VkDeviceSize retired_bytes() const;  // waiting for frames in flight

 private:
  using Buffers = std::array<gpu::Buffer, kEpipolarBuffers>;
  struct Retired {
    gpu::Buffer buffer;
    std::uint32_t frames_left;
  };
  using PerMode = std::array<gpu::Pipeline, kModeCount>;
  // Specialised for a medium. The second line is made when asked for.
  struct PerMedium {
    gpu::Pipeline slice_samples, correct_pixels;
    std::array<std::array<gpu::Pipeline, kSparsities>, 2> unwarp, unwarp_pixels;          // by Extinction and Sparsity
    std::array<gpu::Pipeline, 2> unwarp_reduced, unwarp_reduced_pixels, correct_reduced;  // by whether to a quarter
    std::array<std::array<gpu::Pipeline, 2>, 2> upscale, upscale_pixels;                  // by Extinction, and that
  };

  Result<void> create_pipelines();
  Result<void> make_downscaled(MediumKind medium, std::uint32_t extinction, std::uint32_t downscale);
  Result<void> make_of_medium(MediumKind medium, std::uint32_t extinction, Sparsity sparsity);
  // Whether the march looks at the shadows at all.
  [[nodiscard]] static bool walks(const Params& params);
  // Whether it looks at them through the trees.
  [[nodiscard]] static bool uses_trees(const Params& params);
  Result<void> make_march(bool tree, bool colors, std::uint32_t mode);

  const gpu::Device* device_ = nullptr;
  EffectDesc desc_;
  Buffers buffers_ = {};
  std::vector<Retired> retired_ = {};
  gpu::Pipeline slice_end_points_, slice_directions_, interpolate_samples_, show_sampling_;
  std::array<gpu::Pipeline, 2> refine_samples_;          // by Refinement
  std::array<gpu::Pipeline, 2> shadow_tree_;             // by MinMaxFormat
  std::array<std::array<PerMode, 2>, 2> march_samples_;  // without and with tree, and colours; made when asked for
  std::array<PerMedium, 2> of_medium_;  // by MediumKind; those of the homogeneous one are made when asked for
};

}  // namespace tyndall
