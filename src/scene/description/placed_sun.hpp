// Where a scene's sun is: by its angles, or by place and time, with or without refraction.
#pragma once

#include <optional>

#include "scene/description/scene_params.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::scene {

// Returns by how much the atmosphere raises an object [deg], whose elevation without an atmosphere is given:
// Saemundsson, "Atmospheric refraction" (1986), at 1010 hPa and 10 degrees Celsius. It is 0 at the zenith, and fades to
// 0 from an elevation of -1 degree to one of -5 degrees, where the formula does not hold.
[[nodiscard]] double refraction_deg(double elevation_deg);

// Returns the sun with the angles at which it stands. With a time, they are those of the place, or else of
// `terrain_place`, the place of an elevation file. Errors (invalid_argument): no place, or text that cannot be read.
[[nodiscard]] Result<SunParams> placed_sun(const SunParams& sun, const std::optional<Place>& terrain_place);

}  // namespace tyndall::scene
