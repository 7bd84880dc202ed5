// Light on meshes and on the bare ground: the sun through the atmosphere and through glass, and the sky.
#ifndef TYNDALL_MESH_LIGHT_GLSL
#define TYNDALL_MESH_LIGHT_GLSL

#include "scene/mesh.h"
#include "tyndall/light_tables.glsl"

layout(std430, binding = 0) readonly buffer mesh_block { MeshConstants mesh; };
layout(binding = 4) uniform sampler2D sun_transmittance;
layout(binding = 5) uniform sampler2D sky_irradiance;

#define SHADED mesh
#define SHADOW_MAPS 6
#define SHADOW_COLORS 7
#include "scene/sun_shadow.glsl"

struct SurfaceLight {
  vec3 up;       // away from the planet's centre
  vec3 sun;      // irradiance at normal incidence, without shadows
  vec3 sky;      // on a horizontal surface under an open sky
  vec3 bounced;  // from the ground below, on a surface that faces it
};

SurfaceLight surface_light(vec3 position) {
  SurfaceLight light;
  vec3 from_centre = position + vec3(0.0, mesh.planet_radius_m, 0.0);
  light.up = normalize(from_centre);
  // The altitude in a form that does not cancel against the radius.
  float altitude = (dot(position, position) + 2.0 * mesh.planet_radius_m * position.y) /
                   (length(from_centre) + mesh.planet_radius_m);
  float cos_sun = dot(light.up, mesh.direction_to_sun);
  vec2 uv = light_table_uv(altitude, cos_sun, mesh.planet_radius_m, mesh.atmosphere_height_m);
  light.sun = texture(sun_transmittance, uv).rgb;
  light.sky = texture(sky_irradiance, uv).rgb;
  light.bounced = mesh.ground_albedo * (light.sky + light.sun * max(cos_sun, 0.0));
  return light;
}

// Returns the irradiance on one side of a surface. `shape` is the triangle's normal, `normal` the shading normal.
vec3 irradiance(SurfaceLight light, vec3 position, vec3 shape, vec3 normal, float sky_light, bool is_glass,
                out uint cascade) {
  float up = 0.5 * (1.0 + dot(normal, light.up));
  vec3 sum = sky_light * (light.sky * up + light.bounced * (1.0 - up));
  cascade = mesh.cascade_count;
  float cosine = dot(normal, mesh.direction_to_sun);
  if (cosine > 0.0 && dot(shape, mesh.direction_to_sun) > 0.0) {
    float lit = sun_light_at(position, shape, cascade);
    if (lit > 0.0) sum += light.sun * (lit * cosine) * sun_color_at(position, shape, cascade, is_glass);
  }
  return sum;
}

#endif
