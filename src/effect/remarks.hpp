// Remarks on inputs that can be recorded but are hardly meant: EffectDesc::check_inputs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// What remarks are made from, besides the inputs.
struct FrameState {
  const EffectDesc& desc;
  const Params& params;
  const shared::FrameConstants& frame;
  bool tables_ready = false;                // built at least once
  std::optional<std::uint64_t> unfinished;  // index of the frame whose commands may still use the slot
};

class Remarks {
 public:
  // Reports through `device` what looks wrong in a frame that passes check_frame(). Each kind of remark is made
  // once for a view, and again only after a frame in which it did not hold. Allocates nothing.
  void on_frame(const FrameInputs& inputs, const FrameState& state, const DeviceInfo& device);

 private:
  std::array<std::uint64_t, kMaxViews> said_ = {};  // bit: kind
  // The camera of the frame before, and whether it looked like the inverse of one.
  struct Before {
    bool known = false;
    bool suspect = false;
    Mat4 world_from_view;
  };
  std::array<Before, kMaxViews> before_;
};

}  // namespace tyndall
