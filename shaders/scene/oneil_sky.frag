// The sky of O'Neil's model, what lies beyond it seen through it, and below the horizon the planet as a sphere.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/moon.glsl"
#include "scene/oneil_air.glsl"
#include "scene/planet_surface.glsl"

layout(location = 0) in vec3 offset;
layout(location = 1) in vec3 vertex_rayleigh;
layout(location = 2) in vec3 vertex_mie;
layout(location = 3) in vec3 vertex_through;
layout(location = 0) out vec4 radiance;

// Radiance of the sphere in this direction, before the air takes its part.
vec3 sphere_radiance(vec3 direction) {
  float R = medium.planet_radius_m;
  float mu = dot(direction, eye_up);
  float distance_m = distance_to_ground(eye_altitude_m, mu, R);
  vec3 up = normalize(eye_up * (R + eye_altitude_m) + direction * distance_m);
  float cos_sun = dot(up, to_sun);
  float facing = max(-dot(up, direction), 0.02);
  float footprint_rad = distance_m * pixel_angle_rad / (R * sqrt(facing));
  vec3 albedo = is_sphere != 0u ? planet_albedo(mat3(world_from_local) * up, north_pole, footprint_rad, sphere_seed) : kUnseenAlbedo;
  vec3 sun;
  vec3 sky;
  light_on_ground(0.0, cos_sun, sun, sky);
  return albedo * 0.318309886 * (sun * max(cos_sun, 0.0) + sky) * sun_irradiance;
}

void main() {
  vec3 direction = normalize(offset);
  vec3 rayleigh = vertex_rayleigh;
  vec3 mie = vertex_mie;
  vec3 through = vertex_through;
  bool on_ground = ray_hits_ground(eye_altitude_m, dot(direction, eye_up), medium.planet_radius_m);
  if (kPerPixel != 0u) oneil_air(direction, 0.0, on_ground ? kAtGround : kInSpace, rayleigh, mie, through);
  vec3 behind = vec3(0.0);
  if (ground_shown != 0.0) behind = on_ground ? sphere_radiance(direction) : beyond_air(direction);
  radiance = vec4(behind * through + air_radiance(direction, rayleigh, mie), 1.0);
}
