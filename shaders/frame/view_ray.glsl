// The ray through a pixel, in the coordinates that the physics of lib/ works with.
#ifndef TYNDALL_VIEW_RAY_GLSL
#define TYNDALL_VIEW_RAY_GLSL

#include "lib/geometry.glsl"

struct Ray {
  vec3 direction;      // world, unit length
  float altitude;      // of the camera [m]
  float cos_zenith;    // at the camera
  float cos_sun_zenith;
  float cos_view_sun;
  float length_m;      // to what the depth buffer shows; 1e9 for the sky
  bool sky;
};

vec3 view_position(mat4 view_from_clip, vec2 ndc, float depth) {
  vec4 p = view_from_clip * vec4(ndc, depth, 1.0);
  return p.xyz / p.w;
}

Ray view_ray(FrameConstants frame, ivec2 pixel, float depth) {
  vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / vec2(float(frame.width), float(frame.height)) - 1.0;
  Ray ray;
  vec3 near = view_position(frame.view_from_clip, ndc, frame.near_depth);
  ray.direction = normalize(mat3(frame.world_from_view) * near);
  ray.sky = depth == frame.sky_depth;
  ray.length_m = 1e9;
  if (!ray.sky) ray.length_m = length(view_position(frame.view_from_clip, ndc, depth));
  ray.altitude = frame.camera_altitude_m;
  ray.cos_zenith = clamp(dot(ray.direction, frame.camera_up), -1.0, 1.0);
  ray.cos_sun_zenith = clamp(dot(frame.direction_to_sun, frame.camera_up), -1.0, 1.0);
  ray.cos_view_sun = clamp(dot(frame.direction_to_sun, ray.direction), -1.0, 1.0);
  return ray;
}

// Cosine of the sun's zenith angle at distance t along the ray.
float cos_sun_zenith_along(Ray ray, float t, float radius) {
  float r0 = radius + ray.altitude;
  float r = radius + altitude_along(ray.altitude, ray.cos_zenith, t, radius);
  return clamp((r0 * ray.cos_sun_zenith + t * ray.cos_view_sun) / r, -1.0, 1.0);
}

// The part of the ray inside the air: false when there is none. Rays to geometry end there, whether or
// not sea level is in the way; rays to the sky end at the planet or at the top of the air.
bool clip_to_air(Medium medium, Ray ray, out float start, out float end) {
  bool hits_ground;
  bool in_air = atmosphere_segment(ray.altitude, ray.cos_zenith, medium.atmosphere_height_m,
                                   medium.planet_radius_m, start, end, hits_ground);
  if (!in_air) return false;
  if (!ray.sky) end = hits_ground ? ray.length_m : min(end, ray.length_m);
  return end > start;
}

// Texture coordinates and depth of a world position in a shadow map.
vec3 shadow_uvz(mat4 shadow_from_world, vec3 position) {
  vec4 p = shadow_from_world * vec4(position, 1.0);
  return p.xyz / p.w;
}

#endif
