// Sunlight on surfaces from the shadow cascades: selection of the cascade, bias, filter, and the colour of glass in the
// light's path. The including file defines SHADED, a block with the fields used below; SHADOW_MAPS, the binding of the
// shadow maps; and optionally SHADOW_COLORS, the binding of the colour maps.
#ifndef TYNDALL_SUN_SHADOW_GLSL
#define TYNDALL_SUN_SHADOW_GLSL

layout(binding = SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;

// The reach of the filter in texels.
const float kFilterMargin = 3.0;

// Returns how far inside cascade c a point is: 0 at the margin, 1 well inside, negative outside. Beyond the depth range
// of the last cascade, away from the sun, all casters are nearer, so the point counts as inside.
float cascade_margin(uint c, vec3 uvz) {
  float edge = kFilterMargin / SHADED.shadow_resolution;
  vec2 inside = min(uvz.xy, 1.0 - uvz.xy) - edge;
  bool deep_enough = uvz.z >= 0.0 && (uvz.z <= 1.0 || c + 1u == SHADED.cascade_count);
  return min(min(inside.x, inside.y) / 0.05, deep_enough ? 1.0 : -1.0);
}

// Returns a receiver's position in cascade c. The receiver is moved along its normal by about the filter's footprint to
// avoid self-shadowing (Holbert, "Normal Offset Shadows", 2011).
vec3 cascade_place(uint c, vec3 position, vec3 normal) {
  vec4 size = SHADED.cascade[c];
  float texel_m = max(size.y, size.z);
  float cosine = clamp(dot(normal, SHADED.direction_to_sun), 0.0, 1.0);
  float reach = SHADED.smooth_shadows != 0u ? 2.0 : 1.0;
  vec3 moved =
      position + normal * (texel_m * reach * sqrt(1.0 - cosine * cosine)) + SHADED.direction_to_sun * (0.5 * texel_m);
  return (SHADED.shadow_from_local[c] * vec4(moved, 1.0)).xyz;
}

// Returns the lit fraction according to one cascade.
float cascade_light(uint c, vec3 position, vec3 normal, out float margin) {
  vec3 uvz = cascade_place(c, position, normal);
  margin = cascade_margin(c, uvz);
  if (margin < 0.0) return 1.0;
  uvz.z = clamp(uvz.z, 0.0, 1.0);
  if (SHADED.smooth_shadows == 0u) return texture(shadow_maps, vec4(uvz.xy, float(c), uvz.z));
  // Nine bilinear comparisons, weighted by a tent three texels wide.
  float texel = 1.0 / SHADED.shadow_resolution;
  float light = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = (x == 0 ? 2.0 : 1.0) * (y == 0 ? 2.0 : 1.0);
      light += weight * texture(shadow_maps, vec4(uvz.xy + vec2(x, y) * texel, float(c), uvz.z));
    }
  }
  return light / 16.0;
}

// Returns the lit fraction of a surface point. `answered` is the cascade that was used; cascade_count means none.
float sun_light_at(vec3 position, vec3 normal, out uint answered) {
  answered = SHADED.cascade_count;
  float view_depth = dot(position - SHADED.camera_position, SHADED.camera_forward);
  for (uint c = 0u; c < SHADED.cascade_count; ++c) {
    if (SHADED.best_cascade == 0u && view_depth > SHADED.cascade[c].x) continue;
    float margin;
    float light = cascade_light(c, position, normal, margin);
    if (margin < 0.0) continue;
    answered = c;
    // Blend into the next cascade near the edge, so that no line shows.
    if (margin < 1.0 && c + 1u < SHADED.cascade_count) {
      float next_margin;
      float next = cascade_light(c + 1u, position, normal, next_margin);
      if (next_margin >= 0.0) light = mix(next, light, margin);
    } else if (c + 1u == SHADED.cascade_count) {
      light = mix(1.0, light, clamp(margin, 0.0, 1.0));
    }
    return light;
  }
  return 1.0;
}

#ifdef SHADOW_COLORS
layout(binding = SHADOW_COLORS) uniform sampler2DArray shadow_colors;

// Covers half-float depths, which are rounded to 1/4096.
const float kGlassTolerance = 0.0005;

// Returns the colour of the light at a point of a map. Alpha is the depth of the glass nearest to the sun; light in
// front of that glass is not coloured.
vec3 glass_color(vec3 place, float depth) {
  vec4 glass = texture(shadow_colors, place);
  return depth > glass.a ? glass.rgb : vec3(1.0);
}

// Returns the colour of the sunlight at a surface point for which sun_light_at() used `cascade`. `is_glass`: the
// surface is drawn into the colour maps itself, and its own colour does not affect the light that reaches it.
vec3 sun_color_at(vec3 position, vec3 normal, uint cascade, bool is_glass) {
  if (SHADED.has_glass == 0u || cascade >= SHADED.cascade_count) return vec3(1.0);
  vec3 uvz = cascade_place(cascade, position, normal);
  uvz.z += is_glass ? -kGlassTolerance : kGlassTolerance;
  if (SHADED.smooth_shadows == 0u) return glass_color(vec3(uvz.xy, float(cascade)), uvz.z);
  float texel = 1.0 / SHADED.shadow_resolution;
  vec3 color = vec3(0.0);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = (x == 0 ? 2.0 : 1.0) * (y == 0 ? 2.0 : 1.0);
      color += weight * glass_color(vec3(uvz.xy + vec2(x, y) * texel, float(cascade)), uvz.z);
    }
  }
  return color / 16.0;
}
#endif

vec3 cascade_color(uint c) {
  const vec3 colors[8] = vec3[8](vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 1, 0), vec3(0, 1, 1), vec3(1, 0, 1),
                                 vec3(0.3, 1, 0.7), vec3(0.7, 0.3, 1), vec3(1, 0.7, 0.3));
  return colors[min(c, 7u)];
}

#endif
