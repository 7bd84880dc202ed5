// Sunlight on surfaces from the cascades: choice of the cascade, bias and filter.
#ifndef TYNDALL_TERRAIN_SHADOW_GLSL
#define TYNDALL_TERRAIN_SHADOW_GLSL

#include "scene/terrain_surface.glsl"

layout(binding = 3) uniform sampler2DArrayShadow shadow_maps;

// Texels that the filter reaches over.
const float kFilterMargin = 3.0;

// How far inside cascade c a place in it is: 0 at the margin, 1 well inside, negative outside.
float cascade_margin(vec3 uvz) {
  float edge = kFilterMargin / terrain.shadow_resolution;
  vec2 inside = min(uvz.xy, 1.0 - uvz.xy) - edge;
  float depth = min(uvz.z, 1.0 - uvz.z);
  return min(min(inside.x, inside.y) / 0.05, depth >= 0.0 ? 1.0 : -1.0);
}

// Lit fraction in one cascade. The receiver is moved along its normal by about the filter's footprint, so
// that it does not shadow itself (Holbert, "Normal Offset Shadows", 2011).
float cascade_light(uint c, vec3 position, vec3 normal, out float margin) {
  vec4 size = terrain.cascade[c];
  float texel_m = max(size.y, size.z);
  float cosine = clamp(dot(normal, terrain.direction_to_sun), 0.0, 1.0);
  float reach = terrain.smooth_shadows != 0u ? 2.0 : 1.0;
  vec3 moved = position + normal * (texel_m * reach * sqrt(1.0 - cosine * cosine)) +
               terrain.direction_to_sun * (0.5 * texel_m);
  vec3 uvz = (terrain.shadow_from_world[c] * vec4(moved, 1.0)).xyz;
  margin = cascade_margin(uvz);
  if (margin < 0.0) return 1.0;
  uvz.z = clamp(uvz.z, 0.0, 1.0);
  if (terrain.smooth_shadows == 0u) return texture(shadow_maps, vec4(uvz.xy, float(c), uvz.z));
  // Nine bilinear comparisons with the weights of a tent three texels wide.
  float texel = 1.0 / terrain.shadow_resolution;
  float light = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = (x == 0 ? 2.0 : 1.0) * (y == 0 ? 2.0 : 1.0);
      light += weight * texture(shadow_maps, vec4(uvz.xy + vec2(x, y) * texel, float(c), uvz.z));
    }
  }
  return light / 16.0;
}

// Lit fraction of a surface point, and the cascade that answered (cascade_count: none did).
float sun_light_at(vec3 position, vec3 normal, out uint answered) {
  answered = terrain.cascade_count;
  float view_depth = dot(position - terrain.camera_position, terrain.camera_forward);
  for (uint c = 0u; c < terrain.cascade_count; ++c) {
    if (terrain.best_cascade == 0u && view_depth > terrain.cascade[c].x) continue;
    float margin;
    float light = cascade_light(c, position, normal, margin);
    if (margin < 0.0) continue;
    answered = c;
    // Towards its edge a cascade gives way to the next, so that no line shows.
    if (margin < 1.0 && c + 1u < terrain.cascade_count) {
      float next_margin;
      float next = cascade_light(c + 1u, position, normal, next_margin);
      if (next_margin >= 0.0) light = mix(next, light, margin);
    } else if (c + 1u == terrain.cascade_count) {
      light = mix(1.0, light, clamp(margin, 0.0, 1.0));
    }
    return light;
  }
  return 1.0;
}

vec3 cascade_color(uint c) {
  const vec3 colors[8] = vec3[8](vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 1, 0), vec3(0, 1, 1), vec3(1, 0, 1),
                                 vec3(0.3, 1, 0.7), vec3(0.7, 0.3, 1), vec3(1, 0.7, 0.3));
  return colors[min(c, 7u)];
}

#endif
