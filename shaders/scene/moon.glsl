// The background beyond the atmosphere: the sun's disc and in front of it a sunlit moon. The moon is a sphere that
// scatters by the law of Lommel and Seeliger, so that a full moon is as bright at its rim as in its middle. Its plains
// are dark patches of noise.
#ifndef TYNDALL_MOON_GLSL
#define TYNDALL_MOON_GLSL

#include "scene/noise3.glsl"
#include "scene/sun_disc.glsl"

// The full moon reflects like a Lambertian disc of this albedo (Allen's Astrophysical Quantities, 4th edition, 2000:
// geometric albedo 0.12).
const float kMoonAlbedo = 0.12;

// Returns the relative albedo at a point of the moon's surface; the mean is 1. n is in world space, so that features
// stay in place. Detail smaller than `footprint` fades.
float moon_shade(vec3 n, float footprint) {
  float plains = smoothstep(-0.05, 0.25, noise3_sum(n * 1.7, 4, 1.7 * footprint, 77u));
  float craters = noise3_sum(n * 9.0, 4, 9.0 * footprint, 78u);
  return (1.0 - 0.45 * plains) * (1.0 + 0.35 * craters) * 1.15;
}

vec3 beyond_air(vec3 direction) {
  vec3 light = sun_disc(direction) + airglow;
  if (moon_radius_rad > 0.0) {
    float angle = 2.0 * asin(min(0.5 * distance(direction, direction_to_moon), 1.0));
    float forward = dot(direction, -vec3(local_from_view[2]));
    float pixel = pixel_angle_rad * forward * forward;
    float cover = clamp((moon_radius_rad - angle) / pixel + 0.5, 0.0, 1.0);
    if (cover > 0.0) {
      // The visible point of the sphere, as seen from far away.
      vec3 across = (direction - direction_to_moon * dot(direction, direction_to_moon)) / sin(moon_radius_rad);
      float off = min(dot(across, across), 1.0);
      float facing = sqrt(1.0 - off);
      vec3 n = normalize(across - direction_to_moon * max(facing, 0.02));
      float sun = max(dot(n, direction_to_sun), 0.0);
      float lit = 2.0 * kMoonAlbedo * sun / max(sun + facing, 1.0e-4);
      light =
          mix(light,
              moon_irradiance * (0.318309886 * lit * moon_shade(mat3(world_from_local) * n, pixel / moon_radius_rad)),
              cover);
    }
  }
  return light;
}

#endif
