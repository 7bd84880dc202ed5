// Hoffman and Preetham's model in a frame: its constants, which src/scene/sky/homogeneous_sky.cpp fills, and the medium
// between the eye and a point.
#ifndef TYNDALL_HOMOGENEOUS_AIR_GLSL
#define TYNDALL_HOMOGENEOUS_AIR_GLSL

#include "lib/homogeneous.glsl"
#include "scene/constant_ids.h"

layout(constant_id = kPerPixelId) const uint kPerPixel = 0u;  // scattering.evaluate = pixel

const float kSunsOfSky = 64.0;

layout(std430, binding = 6) readonly buffer model_block {
  Homogeneous medium;
  vec3 eye_position;  // this and all points and directions are in the local frame [m]
  float eye_altitude_m;
  vec3 eye_up;
  float eye_cos_sun;
  vec3 to_sun;
  uint in_space;
  vec3 sun_on_ground;   // relative to that above the atmosphere; for eyes inside the atmosphere only
  float air_shown;      // 0 without scattering.enabled
  vec3 sky_on_ground;   // irradiance, for eyes inside the atmosphere only
  float ground_shown;   // 0 with scattering.only
  vec3 sun_irradiance;  // above the atmosphere
  float unused_model;
  vec4 sky_by_sun[];  // sky irradiance for eyes in space, at 64 square roots of the sun's cosine
};

// Computes transmittance (`extinction`) and in-scattered radiance from the eye to `offset`, which is a surface or, with
// `sky`, a direction. `air_m` is the optical length of air along the ray.
void air_to(vec3 offset, bool sky, out vec3 extinction, out vec3 inscattering, out float air_m) {
  float distance_m = length(offset);
  vec3 direction = offset / max(distance_m, 1e-6);
  float mu = clamp(dot(direction, eye_up), -1.0, 1.0);
  float nu = clamp(dot(direction, to_sun), -1.0, 1.0);
  HomogeneousPath path = homogeneous_path(medium, eye_altitude_m, mu, eye_cos_sun, nu, sky ? -1.0 : distance_m);
  vec3 sun = in_space != 0u ? homogeneous_sun(medium, path.mu_s) : sun_on_ground;
  inscattering = homogeneous_inscattering(medium, path, nu, extinction) * sun * sun_irradiance * air_shown;
  extinction = mix(vec3(1.0), extinction, air_shown);
  air_m = path.air_m;
}

#endif
