// The planet's bare sphere at sea level, where there is no terrain: a plain ground that takes shadows.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/geometry.glsl"
#include "scene/mesh_light.glsl"

// The ground counts as farther away by this part when it is compared with meshes, so that a floor at sea level hides it
// however depths are rounded. Seen from a height h that is as if it lay lower by kBehindMeshes * h.
const float kBehindMeshes = 5.0e-4;

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
  // Along the ray: t^2 + 2 b t + c = 0 with c small near the ground, so that no digits are lost.
  float radius = mesh.planet_radius_m;
  vec3 p = mesh.camera_position;
  float b = dot(direction, p) + direction.y * radius;
  float c = dot(p, p) + 2.0 * radius * p.y;
  // For an eye below sea level the sphere is lower.
  float ground = ground_below(altitude_of(p, radius), radius);
  c -= ground * (2.0 * radius + ground);
  // b^2 - c from the ray's nearest approach would lose them far away; there it does not matter.
  float root = b * b - c;
  if (root < 0.0 || b >= 0.0 || c < 0.0) discard;
  float t = c / (sqrt(root) - b);
  vec3 position = p + direction * t;
  float depth = push.near_m / (t * view_depth_per_m);
  if (depth > 1.0) discard;
  gl_FragDepth = depth * (1.0 - kBehindMeshes);

  SurfaceLight light = surface_light(position);
  uint cascade;
  vec3 sum = irradiance(light, position, light.up, light.up, 1.0, cascade);
  vec3 albedo = mesh.ground_albedo;
  if (mesh.show_cascades != 0u && cascade < mesh.cascade_count) albedo = 0.75 * albedo + 0.25 * cascade_color(cascade);
  radiance = vec4(albedo * 0.318309886 * sum * mesh.sun_irradiance, 1.0);
}
