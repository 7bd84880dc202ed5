// What glass leaves of the sun's light in the air. Include after declaring frame and shadow_colors, a sampler2DArray.
#ifndef TYNDALL_GLASS_GLSL
#define TYNDALL_GLASS_GLSL

#include "frame/modes.glsl"

// At a place of a cascade's map and a depth in it. Alpha may hold the depth of the glass nearest to the sun
// (FrameInputs::shadow_color_depths): before it the light is as it was. Without, glass_depth_sign is 0 and nothing lies
// before.
vec3 glass_color(vec2 uv, float depth, uint cascade) {
  if (!kColors) return vec3(1.0);
  vec4 glass = textureLod(shadow_colors, vec3(uv, float(cascade)), 0.0);
  return (clamp(depth, 0.0, 1.0) - glass.a) * frame.glass_depth_sign >= 0.0 ? glass.rgb : vec3(1.0);
}

#endif
