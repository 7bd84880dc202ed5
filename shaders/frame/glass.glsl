// The colour of sunlight behind stained glass.
#ifndef TYNDALL_GLASS_GLSL
#define TYNDALL_GLASS_GLSL

#include "frame/constants.glsl"
#include "frame/modes.glsl"
#include "lib/spectrum.glsl"

layout(binding = 10) uniform sampler2DArray shadow_colors;

// Returns the colour at a point of a cascade's map and a depth in it. Alpha may hold the depth of the glass nearest to
// the sun (FrameInputs::shadow_color_depths); light in front of that glass is not coloured. Without such depths,
// glass_depth_sign is 0 and all light is coloured.
Spectrum glass_color(vec2 uv, float depth, uint cascade) {
  if (!kColors) return Spectrum(1.0);
  vec4 glass = textureLod(shadow_colors, vec3(uv, float(cascade)), 0.0);
  return (clamp(depth, 0.0, 1.0) - glass.a) * frame.glass_depth_sign >= 0.0 ? FILTER(glass.rgb) : Spectrum(1.0);
}

#endif
