// The sky of O'Neil's model with the background behind it; below the horizon, the planet as a sphere.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/moon.glsl"
#include "scene/oneil_air.glsl"
#include "scene/planet_surface.glsl"

layout(location = 0) in vec3 offset;
layout(location = 1) in vec3 vertex_rayleigh;
layout(location = 2) in vec3 vertex_mie;
layout(location = 3) in vec3 vertex_transmittance;
layout(location = 0) out vec4 radiance;

// Returns the radiance of the sphere in this direction, without the medium in front of it.
vec3 sphere_radiance(vec3 direction) {
  float R = medium.planet_radius_m;
  float mu = dot(direction, eye_up);
  float distance_m = distance_to_ground(eye_altitude_m, mu, R);
  vec3 up = normalize(eye_up * (R + eye_altitude_m) + direction * distance_m);
  float cos_sun = dot(up, to_sun);
  float facing = max(-dot(up, direction), 0.02);
  float footprint_rad = distance_m * pixel_angle_rad / (R * sqrt(facing));
  vec3 albedo = is_sphere != 0u ? planet_albedo(mat3(world_from_local) * up, north_pole, footprint_rad, sphere_seed)
                                : kUnseenAlbedo;
  vec3 sun;
  vec3 sky;
  light_on_ground(0.0, cos_sun, sun, sky);
  return albedo * 0.318309886 * (sun * max(cos_sun, 0.0) + sky) * sun_irradiance;
}

// Returns whether the medium must be evaluated per pixel even when it is evaluated at the vertices otherwise. That is
// so near the horizon, where both sides differ, and in the limb seen from space. The mesh's edges are arcs of great
// circles, which deviate from the circle of constant zenith angle through their vertices by up to the square of their
// length over 8 (kSag_rad at 45 degrees).
bool in_limb(float mu, bool on_ground) {
  const float kSag_rad = 9.0e-4;
  const float kRow_rad = 2.0e-3;  // below the horizon, where the radiance changes like a square root
  bool in_space = eye_altitude_m > medium.atmosphere_height_m;
  float beside = mu - cos(horizon_rad);
  return (in_space && !on_ground) || abs(beside) < (kSag_rad + kRow_rad) * sin(horizon_rad);
}

void main() {
  vec3 direction = normalize(offset);
  OneilLight light = OneilLight(vertex_rayleigh, vertex_mie, vertex_transmittance);
  float mu = dot(direction, eye_up);
  bool on_ground = ray_hits_ground(eye_altitude_m, mu, medium.planet_radius_m);
  if (kPerPixel != 0u || in_limb(mu, on_ground)) light = oneil_light(direction, 0.0, on_ground ? kAtGround : kInSpace);
  vec3 behind = vec3(0.0);
  if (ground_shown != 0.0) behind = on_ground ? sphere_radiance(direction) : beyond_air(direction);
  radiance = vec4(behind * light.transmittance + oneil_inscattering(direction, light), 1.0);
}
