// From what the caller passes to what the shaders read: pure functions, no Vulkan objects.
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// The inverse of any invertible 4×4 matrix, computed in double precision. A singular matrix gives
// non-finite entries.
[[nodiscard]] Mat4 inverse(const Mat4& matrix);

// The shape of the scattering tables, as tables.* asks for it.
[[nodiscard]] shared::TableShape table_shape(const Params& params);
// Whether the air is marched through coloured maps.
[[nodiscard]] inline bool has_colors(const FrameInputs& inputs, const Params& params) {
  return inputs.shadow_colors.view != VK_NULL_HANDLE && !inputs.cascades.empty() && params.scattering.light_shafts;
}
// Above the planet's sphere, in double: its centre is millions of metres away.
[[nodiscard]] double camera_altitude_m(const FrameInputs& inputs, const Params& params);
[[nodiscard]] shared::FrameConstants frame_constants(const FrameInputs& inputs, const EffectDesc& desc,
                                                     const Params& params);
using CascadeArray = std::array<shared::CascadeConstants, shared::kMaxCascades>;
[[nodiscard]] CascadeArray cascade_constants(const FrameInputs& inputs);

// Why a frame cannot be recorded, as an error of one line. Remarks on frames that can be are in remarks.hpp.
[[nodiscard]] Result<void> check_frame(const FrameInputs& inputs, const EffectDesc& desc, const Params& params);

}  // namespace tyndall
