// The planet as a bare sphere at sea level, for scenes without terrain. It receives shadows.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/geometry.glsl"
#include "scene/mesh_light.glsl"

// Returns by how much the ground counts as farther away in the depth test against meshes. A floor at sea level then
// hides the ground however depths are rounded. The effect sees the ground lower by as much, so this must stay far below
// the scale height of the aerosol, from space too.
float behind_meshes(float distance_m) { return min(5.0e-4 * distance_m, 5.0) + 2.0e-7 * distance_m; }

layout(location = 0) in vec2 ndc;
layout(location = 0) out vec4 radiance;

layout(push_constant) uniform Push {
  mat4
      local_from_ndc;  // directions: (x, y, 1, 0) of the picture to the local frame, the length along the view's axis 1
  float near_m;
}
push;

void main() {
  vec3 direction = mat3(push.local_from_ndc) * vec3(ndc, 1.0);
  float view_depth_per_m = 1.0 / length(direction);
  direction *= view_depth_per_m;
  // Along the ray: t^2 + 2 b t + c = 0. c is small near the ground, so nothing cancels.
  float radius = mesh.planet_radius_m;
  vec3 p = mesh.camera_position;
  float b = dot(direction, p) + direction.y * radius;
  float c = dot(p, p) + 2.0 * radius * p.y;
  // For an eye below sea level, the sphere lies at ground_below() instead of at sea level.
  float ground = ground_below(altitude_of(p, radius), radius);
  c -= ground * (2.0 * radius + ground);
  float root = b * b - c;
  if (c > radius * radius) {
    // Far from the planet, b^2 - c is the difference of large numbers. The distance of the ray from the centre is
    // precise.
    float from_centre = length(cross(p + vec3(0.0, radius, 0.0), direction));
    root = (radius + ground - from_centre) * (radius + ground + from_centre);
  }
  if (root < 0.0 || b >= 0.0 || c < 0.0) discard;
  float t = c / (sqrt(root) - b);
  vec3 position = p + direction * t;
  float depth = push.near_m / (t * view_depth_per_m);
  if (depth > 1.0) discard;
  gl_FragDepth = push.near_m / ((t + behind_meshes(t)) * view_depth_per_m);

  SurfaceLight light = surface_light(position);
  uint cascade;
  vec3 sum = irradiance(light, position, light.up, light.up, 1.0, false, cascade);
  vec3 albedo = mesh.ground_albedo;
  if (mesh.show_cascades != 0u && cascade < mesh.cascade_count) albedo = 0.75 * albedo + 0.25 * cascade_color(cascade);
  radiance = vec4(albedo * 0.318309886 * sum * mesh.sun_irradiance, 1.0);
}
