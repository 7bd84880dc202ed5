// Remarks on inputs that are valid but probably unintended: EffectDesc::check_inputs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// The state of the effect on which remarks depend.
struct FrameState {
  const EffectDesc& desc;
  const Params& params;
  const shared::FrameConstants& frame;
  bool tables_ready = false;  // the tables have been built at least once
};

class Remarks {
 public:
  // Reports probable mistakes in a frame that has passed check_frame() through `device`. Each kind of remark is made
  // once per view, and repeated only after a frame in which it did not apply. Allocates nothing.
  void on_frame(const FrameInputs& inputs, const FrameState& state, const DeviceInfo& device);

 private:
  std::array<std::uint64_t, kMaxViews> said_ = {};  // a bit per kind
  // The camera of the previous frame, and whether it appeared to be inverted.
  struct Before {
    bool known = false;
    bool suspect = false;
    Mat4 world_from_view;
  };
  std::array<Before, kMaxViews> before_;
};

}  // namespace tyndall
