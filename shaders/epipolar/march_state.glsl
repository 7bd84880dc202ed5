// The state of a ray between passes that march one cascade each.
#ifndef TYNDALL_MARCH_STATE_GLSL
#define TYNDALL_MARCH_STATE_GLSL

#include "epipolar/march.glsl"

layout(std430, binding = 15) buffer march_states_block { vec4 states[]; };

const uint kStateVectors = 4u;  // kStateBytes of src/effect/resources.cpp

void store_march(uint at, March m) {
  uint i = at * kStateVectors;
  states[i] = vec4(m.lit.light.single, m.lit.first);
  states[i + 1u] = vec4(m.lit.light.high, m.lit.total);
  states[i + 2u] = vec4(m.light, m.end_lit_fraction);
  states[i + 3u] = vec4(m.lit.tint, 0.0);
}

March load_march(uint at) {
  uint i = at * kStateVectors;
  vec4 single = states[i];
  vec4 high = states[i + 1u];
  vec4 light = states[i + 2u];
  March m = nothing_marched();
  m.lit.light = InScattering(single.rgb, high.rgb);
  m.lit.first = single.a;
  m.lit.total = high.a;
  m.lit.tint = states[i + 3u].rgb;
  m.light = light.rgb;
  m.end_lit_fraction = light.a;
  return m;
}

#endif
