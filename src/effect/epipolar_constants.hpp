// Computes the constants of the epipolar shaders as a pure function of inputs and settings. Among the constants are the
// epipole and the sides of the picture on which slices end.
#pragma once

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

[[nodiscard]] shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc,
                                                           const Params& params);

}  // namespace tyndall
