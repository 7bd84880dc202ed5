// Single scattering by numerical integration in double precision, from shaders/lib: the model `single` of `probe` and
// `validate`. Radiance is relative to the sun's irradiance above the atmosphere [1/sr]; the ground is black and the sun
// a point. Pure functions, safe from any thread.
#pragma once

#include <array>
#include <span>

#include "effect/shared.hpp"
#include "rays/ray_query.hpp"

namespace tyndall::models {

// A ray from an eye at `altitude_m`, which may be above the atmosphere or slightly below sea level.
struct Ray {
  double altitude_m = 0.0;
  double cos_view_zenith = 1.0;
  double cos_sun_zenith = 1.0;
  double cos_view_sun = 1.0;  // between the view direction (away from the camera) and the direction to the sun
};

// Returns the ray for the given azimuth between view and sun directions. Angles in rad.
[[nodiscard]] Ray ray_from_angles(double altitude_m, double view_zenith_rad, double sun_zenith_rad, double azimuth_rad);

[[nodiscard]] Ray ray_from_query(const RayQuery& query);

struct Answer {
  std::array<double, 3> radiance = {};       // [1/sr]
  std::array<double, 3> transmittance = {};  // to the ground or out of the atmosphere
  // Radiance and transmittance at the fourth wavelength of scattering.color = spectral.
  double radiance_fourth = 0.0;
  double transmittance_fourth = 0.0;
};

// Computes single scattering within 0.01 % of the integral on Earth. `steps` is as in
// shaders/lib/single_scattering.glsl.
[[nodiscard]] Answer single_scattering(const shared::Medium& medium, const Ray& ray, int steps = 24);

// Returns the horizontal irradiance / E0 of the sky's single scattering, at an altitude within or above the atmosphere.
// `phase_rows`: those of the medium (src/effect/phase_rows.hpp); empty if its phase function has a formula.
[[nodiscard]] std::array<double, 3> single_sky_irradiance(const shared::Medium& medium, double altitude_m,
                                                          double cos_sun_zenith,
                                                          std::span<const shared::vec4> phase_rows = {});

// Returns the transmittance of sunlight to a point: 0 if the planet hides the sun.
[[nodiscard]] std::array<double, 3> sun_transmittance(const shared::Medium& medium, double altitude_m,
                                                      double cos_sun_zenith);

// Returns the transmittance over a distance [m] from an altitude, at a zenith angle. The planet is ignored.
[[nodiscard]] std::array<double, 3> transmittance_along(const shared::Medium& medium, double altitude_m,
                                                        double cos_zenith, double distance_m);

// Returns the radiance / E0 [1/sr] that the directly sunlit ground at the end of a ray reflects towards the eye,
// without attenuation on the way. The ground is Lambertian with Medium::ground_albedo. Returns 0 for rays that miss it.
[[nodiscard]] std::array<double, 3> sunlit_ground(const shared::Medium& medium, const Ray& ray);

// Converts a ray for the shaders of shaders/probe. In double precision, moves its start to where it enters the
// atmosphere, and clips its end.
[[nodiscard]] shared::ProbeRay prepare_probe_ray(const shared::Medium& medium, const Ray& ray);

}  // namespace tyndall::models
