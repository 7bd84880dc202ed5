// The ray through a pixel, in the coordinates of shaders/lib.
#ifndef TYNDALL_VIEW_RAY_GLSL
#define TYNDALL_VIEW_RAY_GLSL

#include "lib/geometry.glsl"

struct Ray {
  vec3 direction;    // world, unit length
  float altitude;    // of the camera [m]
  float cos_zenith;  // at the camera
  float cos_sun_zenith;
  float cos_view_sun;
  float length_m;  // distance to the scene's surface; 1e9 for the sky
  bool sky;
};

// Returns the view-space depth [m] of a depth-buffer value at a position [pixels].
float view_depth(FrameConstants frame, vec2 position, float depth) {
  vec2 ndc = 2.0 * position / vec2(float(frame.width), float(frame.height)) - 1.0;
  vec4 p = frame.view_from_clip * vec4(ndc, depth, 1.0);
  return -p.z / p.w;
}

vec3 ray_direction(FrameConstants frame, vec2 position) {
  precise vec3 direction = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
  return normalize(direction);
}

// Returns the ray through a position [pixels; pixel centres are at + 0.5] to a view-space depth, or to the sky.
Ray ray_to_depth(FrameConstants frame, vec2 position, float depth_m, bool sky) {
  Ray ray;
  ray.direction = ray_direction(frame, position);
  ray.sky = sky;
  ray.length_m = sky ? 1e9 : depth_m / max(dot(ray.direction, frame.camera_forward), 1e-6);
  ray.altitude = frame.camera_altitude_m;
  ray.cos_zenith = clamp(dot(ray.direction, frame.camera_up), -1.0, 1.0);
  ray.cos_sun_zenith = clamp(dot(frame.direction_to_sun, frame.camera_up), -1.0, 1.0);
  ray.cos_view_sun = clamp(dot(frame.direction_to_sun, ray.direction), -1.0, 1.0);
  return ray;
}

Ray view_ray(FrameConstants frame, ivec2 pixel, float depth) {
  vec2 position = vec2(pixel) + 0.5;
  return ray_to_depth(frame, position, view_depth(frame, position, depth), depth == frame.sky_depth);
}

// Returns the cosine of the sun's zenith angle at distance t along the ray.
float cos_sun_zenith_along(Ray ray, float t, float radius) {
  float r0 = radius + ray.altitude;
  float r = radius + altitude_along(ray.altitude, ray.cos_zenith, t, radius);
  return clamp((r0 * ray.cos_sun_zenith + t * ray.cos_view_sun) / r, -1.0, 1.0);
}

// Returns whether a ray on which nothing is drawn ends at the planet. Its sphere is that of ground_below(), or lower if
// the land around the camera is.
bool hits_planet(FrameConstants frame, float h, float mu, float radius) {
  return mu < sphere_horizon_cos(h, frame.ground_m, radius);
}

// Computes the part of the ray inside the atmosphere; returns false if there is none. A ray to geometry ends there,
// even below the planet's sphere. A ray to the sky ends at the planet or at the top of the atmosphere.
bool clip_to_atmosphere(FrameConstants frame, Medium medium, Ray ray, out float start, out float end) {
  float radius = medium.planet_radius_m;
  if (!segment_below_top(ray.altitude, ray.cos_zenith, medium.atmosphere_height_m, radius, start, end)) return false;
  float reach = ray.length_m;
  if (ray.sky && hits_planet(frame, ray.altitude, ray.cos_zenith, radius)) {
    reach = distance_to_sphere(ray.altitude, ray.cos_zenith, frame.ground_m, radius);
  }
  end = min(end, reach);
  return end > start;
}

// Returns texture coordinates and depth of a world position in a shadow map.
vec3 shadow_uvz(mat4 shadow_from_world, vec3 position) {
  vec4 p = shadow_from_world * vec4(position, 1.0);
  return p.xyz / p.w;
}

#endif
