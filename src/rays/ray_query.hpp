// A query of `probe` and `validate` to a model or the reference: the radiance along a ray, or the irradiance of the
// sky.
#pragma once

namespace tyndall {

struct RayQuery {
  // Above sea level, inside the atmosphere or in space; at least -11000 m, and at least minus a quarter of the planet's
  // radius (docs/adr/0007-below-sea-level.md).
  double altitude_m = 0.0;
  double view_zenith_rad = 0.0;  // [0; pi] between the ray and the local vertical; not used for the sky
  double sun_zenith_rad = 0.0;   // [0; pi] between the sun and the local vertical
  double azimuth_rad = 0.0;      // between ray and sun around the local vertical; 0 looks towards the sun
  bool sky_irradiance = false;   // true: the diffuse irradiance of a horizontal surface facing up
};

}  // namespace tyndall
