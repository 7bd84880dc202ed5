// The geometry of epipolar sampling that the shaders are given: the epipole, and where slices end on the border of the
// picture. A pure function.
#pragma once

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

[[nodiscard]] shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc,
                                                           const Params& params);

}  // namespace tyndall
