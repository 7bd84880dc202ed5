// The medium of O'Neil's model between the eye and a point. src/scene/sky/oneil_sky.cpp fills binding 6; binding 7 is
// the table of oneil-table.
#ifndef TYNDALL_ONEIL_AIR_GLSL
#define TYNDALL_ONEIL_AIR_GLSL

#include "scene/constant_ids.h"

layout(std430, binding = 7) readonly buffer oneil_table_block { vec4 oneil_texels[]; };
#define ONEIL_TEXEL(table, index) oneil_texels[index]
// Oneil::integral_method and Oneil::spacing as constants: src/scene/sky/oneil_sky.cpp selects the pipeline by them.
layout(constant_id = kIntegralMethodId) const uint kIntegralMethod = 0u;
layout(constant_id = kSampleSpacingId) const uint kSampleSpacing = 0u;
#define ONEIL_INTEGRAL_METHOD(o) kIntegralMethod
#define ONEIL_SPACING(o) kSampleSpacing
#include "lib/oneil.glsl"

layout(constant_id = kPerPixelId) const uint kPerPixel = 0u;

const uint kSunsOfSky = 128u;

layout(std430, binding = 6) readonly buffer model_block {
  Medium medium;
  Oneil oneil;
  vec3 eye_position;
  float eye_altitude_m;
  vec3 eye_up;        // away from the planet's centre
  float eye_cos_sun;  // cosine of the sun's zenith angle at the eye
  vec3 to_sun;
  float horizon_rad;    // zenith angle of the horizon
  vec3 sun_irradiance;  // above the atmosphere
  float air_shown;      // 0: no scattering
  vec3 north_pole;      // of the sphere's surface, in world space
  float ground_shown;   // 0: only the in-scattered light
  uint sphere_seed;
  uint is_sphere;  // 1: the ground is the sphere instead of the terrain
  float unused_model_0;
  float unused_model_1;
  // Sky irradiance at sea level / E0 for cosines of the sun's zenith angle from -1 to 1.
  vec4 sky_by_sun[kSunsOfSky];
};

// The end of a ray.
const uint kAtDistance = 0u;
const uint kAtGround = 1u;  // the sphere at sea level, which the ray hits
const uint kInSpace = 2u;

// Returns single scattering along the ray, without phase functions, and its transmittance, relative to the sun's
// irradiance. A ray that misses the atmosphere, or ends before it, gets no light.
OneilLight oneil_light(vec3 direction, float distance_m, uint ends) {
  OneilLight none = OneilLight(vec3(0.0), vec3(0.0), vec3(1.0));
  float R = medium.planet_radius_m;
  float top = medium.atmosphere_height_m;
  OneilRay ray = OneilRay(eye_altitude_m, clamp(dot(direction, eye_up), -1.0, 1.0), eye_cos_sun,
                          clamp(dot(direction, to_sun), -1.0, 1.0));
  float near;
  float far;
  if (air_shown == 0.0 || !shell_intersections(ray.h0, ray.mu, top, R, near, far) || far <= 0.0) {
    return none;
  }
  float start = ray.h0 > top ? max(near, 0.0) : 0.0;
  float end = far;
  if (ends == kAtDistance) {
    end = min(distance_m, far);
  } else if (ends == kAtGround) {
    end = distance_to_ground(ray.h0, ray.mu, R);
  }
  if (end <= start) {
    return none;
  }
  return oneil_scattering(medium, oneil, 0u, oneil_enter(medium, ray, start), 0.0, start > 0.0 ? end - start : end);
}

// Returns the radiance for the result of oneil_light(). The phase functions are evaluated here, per pixel.
vec3 oneil_inscattering(vec3 direction, OneilLight light) {
  float nu = clamp(dot(direction, to_sun), -1.0, 1.0);
  return oneil_radiance(medium, oneil, nu, light.rayleigh, light.mie) * sun_irradiance;
}

// Computes the light on the ground, relative to the sun's above the atmosphere: sunlight on a surface that faces the
// sun, and the irradiance of the open sky.
void light_on_ground(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  sun = vec3(1.0);
  sky = vec3(0.0);
  if (air_shown != 0.0) {
    sun = oneil_sunlight(medium, oneil, 0u, clamp(altitude_m, 0.0, medium.atmosphere_height_m), cos_sun_zenith);
    float place = clamp(0.5 + 0.5 * cos_sun_zenith, 0.0, 1.0) * float(kSunsOfSky - 1u);
    uint below = min(uint(place), kSunsOfSky - 2u);
    sky = mix(sky_by_sun[below].rgb, sky_by_sun[below + 1u].rgb, place - float(below));
  }
}

#endif
