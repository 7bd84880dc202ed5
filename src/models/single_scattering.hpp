// Light scattered once, by numerical integration in double precision over shaders/lib: the model `single` of
// `probe` and `validate`. Radiance is relative to the sun's irradiance above the atmosphere [1/sr]; the
// ground is black and the sun a point. Pure functions, safe from any thread.
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "rays/ray_query.hpp"

namespace tyndall::models {

// A question: light arriving at an altitude from a direction. Altitudes may be above the atmosphere, and
// slightly below sea level.
struct Ray {
  double altitude_m = 0.0;
  double cos_view_zenith = 1.0;
  double cos_sun_zenith = 1.0;
  double cos_view_sun = 1.0;  // between the view direction (away from the camera) and the direction to the sun
};

// The ray whose view and sun directions differ by the azimuth given. Angles in rad.
[[nodiscard]] Ray ray_from_angles(double altitude_m, double view_zenith_rad, double sun_zenith_rad, double azimuth_rad);

[[nodiscard]] Ray ray_from_query(const RayQuery& query);

struct Answer {
  std::array<double, 3> radiance = {};       // [1/sr]
  std::array<double, 3> transmittance = {};  // to the ground or out of the atmosphere
};

// Within 0.01 % of the integral on Earth; `steps` as for single_scattering in shaders/lib.
[[nodiscard]] Answer single_scattering(const shared::Medium& medium, const Ray& ray, int steps = 24);

// Horizontal irradiance / E0 of the sky's light scattered once, at an altitude within or above the
// atmosphere.
[[nodiscard]] std::array<double, 3> single_sky_irradiance(const shared::Medium& medium, double altitude_m,
                                                          double cos_sun_zenith);

// Of the sun's light to a point: 0 where the planet hides the sun.
[[nodiscard]] std::array<double, 3> sun_transmittance(const shared::Medium& medium, double altitude_m,
                                                      double cos_sun_zenith);

// What the ground at the end of a ray sends towards the eye when the sun alone lights it, before the air
// takes its part: radiance / E0 [1/sr] by Medium::ground_albedo, a Lambertian surface; 0 for rays that miss
// it.
[[nodiscard]] std::array<double, 3> sunlit_ground(const shared::Medium& medium, const Ray& ray);

// The ray as the GPU probe reads it: begun at the entry into the atmosphere and clipped, in double precision.
[[nodiscard]] shared::ProbeRay prepare_probe_ray(const shared::Medium& medium, const Ray& ray);

}  // namespace tyndall::models
