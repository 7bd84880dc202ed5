// Computes the constants of the shaders from the inputs of a frame. Pure functions without Vulkan objects.
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// Returns the inverse of a 4×4 matrix, computed in double precision. A singular matrix gives non-finite entries.
[[nodiscard]] Mat4 inverse(const Mat4& matrix);

// Returns the shape of the scattering tables for the parameters tables.*.
[[nodiscard]] shared::TableShape table_shape(const Params& params);
// Returns whether rays are marched through coloured maps.
[[nodiscard]] inline bool has_colors(const FrameInputs& inputs, const Params& params) {
  return inputs.shadow_colors.view != VK_NULL_HANDLE && !inputs.cascades.empty() && params.scattering.light_shafts;
}
[[nodiscard]] inline bool has_clouds(const FrameInputs& inputs) { return inputs.clouds.map.view != VK_NULL_HANDLE; }
// Returns the altitude of the camera above the planet's sphere [m]. It is computed in double precision, because the
// centre of the planet is millions of metres away.
[[nodiscard]] double camera_altitude_m(const FrameInputs& inputs, const Params& params);
// Returns whether single scattering must be integrated because the tables do not resolve it: below sea level while the
// sun sets or rises, and below the lowest altitude of the tables (docs/adr/0007-below-sea-level.md).
[[nodiscard]] bool tables_lack_single(double altitude_m, double cos_sun_zenith, double radius_m);
[[nodiscard]] bool tables_lack_single(const FrameInputs& inputs, const Params& params);
[[nodiscard]] shared::FrameConstants frame_constants(const FrameInputs& inputs, const EffectDesc& desc,
                                                     const Params& params);
using CascadeArray = std::array<shared::CascadeConstants, shared::kMaxCascades>;
[[nodiscard]] CascadeArray cascade_constants(const FrameInputs& inputs);

// Returns an error with a one-line message if a frame cannot be recorded. Remarks on frames that can be recorded are in
// remarks.hpp.
[[nodiscard]] Result<void> check_frame(const FrameInputs& inputs, const EffectDesc& desc, const Params& params);

}  // namespace tyndall
