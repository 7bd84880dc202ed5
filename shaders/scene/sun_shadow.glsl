// Sunlight on surfaces from the cascades: choice of the cascade, bias, filter, and the colour of glass that the light
// has come through. The includer defines SHADED, a block with the fields named below, SHADOW_MAPS, the binding of the
// maps, and, where it wants the colour, SHADOW_COLORS, the binding of the maps of colours.
#ifndef TYNDALL_SUN_SHADOW_GLSL
#define TYNDALL_SUN_SHADOW_GLSL

layout(binding = SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;

// Texels that the filter reaches over.
const float kFilterMargin = 3.0;

// How far inside cascade c a place in it is: 0 at the margin, 1 well inside, negative outside. Behind the last
// cascade's depths, away from the sun, all casters are nearer.
float cascade_margin(uint c, vec3 uvz) {
  float edge = kFilterMargin / SHADED.shadow_resolution;
  vec2 inside = min(uvz.xy, 1.0 - uvz.xy) - edge;
  bool deep_enough = uvz.z >= 0.0 && (uvz.z <= 1.0 || c + 1u == SHADED.cascade_count);
  return min(min(inside.x, inside.y) / 0.05, deep_enough ? 1.0 : -1.0);
}

// The place in cascade c of a receiver, moved along its normal by about the filter's footprint, so that it does not
// shadow itself (Holbert, "Normal Offset Shadows", 2011).
vec3 cascade_place(uint c, vec3 position, vec3 normal) {
  vec4 size = SHADED.cascade[c];
  float texel_m = max(size.y, size.z);
  float cosine = clamp(dot(normal, SHADED.direction_to_sun), 0.0, 1.0);
  float reach = SHADED.smooth_shadows != 0u ? 2.0 : 1.0;
  vec3 moved =
      position + normal * (texel_m * reach * sqrt(1.0 - cosine * cosine)) + SHADED.direction_to_sun * (0.5 * texel_m);
  return (SHADED.shadow_from_local[c] * vec4(moved, 1.0)).xyz;
}

// Lit fraction in one cascade.
float cascade_light(uint c, vec3 position, vec3 normal, out float margin) {
  vec3 uvz = cascade_place(c, position, normal);
  margin = cascade_margin(c, uvz);
  if (margin < 0.0) return 1.0;
  uvz.z = clamp(uvz.z, 0.0, 1.0);
  if (SHADED.smooth_shadows == 0u) return texture(shadow_maps, vec4(uvz.xy, float(c), uvz.z));
  // Nine bilinear comparisons with the weights of a tent three texels wide.
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

// Lit fraction of a surface point, and the cascade that answered (cascade_count: none did).
float sun_light_at(vec3 position, vec3 normal, out uint answered) {
  answered = SHADED.cascade_count;
  float view_depth = dot(position - SHADED.camera_position, SHADED.camera_forward);
  for (uint c = 0u; c < SHADED.cascade_count; ++c) {
    if (SHADED.best_cascade == 0u && view_depth > SHADED.cascade[c].x) continue;
    float margin;
    float light = cascade_light(c, position, normal, margin);
    if (margin < 0.0) continue;
    answered = c;
    // Towards its edge a cascade gives way to the next, so that no line shows.
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

// What glass leaves of the light of one place in a map. Alpha is the depth of the glass nearest to the sun: what lies
// before it is not coloured by it. Half floats round depths to 1/4096.
vec3 glass_color(vec3 place, float depth) {
  vec4 glass = texture(shadow_colors, place);
  return depth + 0.0005 > glass.a ? glass.rgb : vec3(1.0);
}

// What glass leaves of the sun's light at a surface point for which `cascade` has answered.
vec3 sun_color_at(vec3 position, vec3 normal, uint cascade) {
  if (SHADED.has_glass == 0u || cascade >= SHADED.cascade_count) return vec3(1.0);
  vec3 uvz = cascade_place(cascade, position, normal);
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
