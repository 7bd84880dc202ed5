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

// Returns the ratio of the heights of the sun's or the moon's disc with and without refraction, where the elevation
// with refraction is given: 0.83 on the horizon, and 1 at the zenith.
[[nodiscard]] double refraction_flattening(double seen_elevation_deg, double angular_radius_deg);

// Returns the sun with the angles at which it stands. With sun.time, they are computed for sun.place or, if that is
// empty, for `terrain_place`, the place of an elevation file. Errors (invalid_argument): no place, or text that cannot
// be read.
[[nodiscard]] Result<SunParams> placed_sun(const SunParams& sun, const std::optional<Place>& terrain_place);

// Returns the moon with the angles at which it stands, and its size there. With MoonParams::by_date, they are those of
// the time and place of the sun. Errors: as placed_sun(), and no time.
[[nodiscard]] Result<MoonParams> placed_moon(const MoonParams& moon, const SunParams& sun,
                                             const std::optional<Place>& terrain_place);

// Returns the irradiance of the moon relative to that of the sun, above the atmosphere. `cos_sun_moon`: the cosine of
// the angle between both.
[[nodiscard]] double moon_irradiance_ratio(const MoonParams& placed, double cos_sun_moon);

}  // namespace tyndall::scene
