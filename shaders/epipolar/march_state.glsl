// The state of a ray between passes that march one cascade each.
#ifndef TYNDALL_MARCH_STATE_GLSL
#define TYNDALL_MARCH_STATE_GLSL

#include "epipolar/march.glsl"

layout(std430, binding = 15) buffer march_states_block { vec4 states[]; };

// kStateBytes and kSpectralStateBytes of src/effect/resources.cpp
#ifdef SPECTRAL
const uint kStateVectors = 5u;
#else
const uint kStateVectors = 4u;
#endif

void store_march(uint at, March m) {
  uint i = at * kStateVectors;
  // With clouds, no mode reads single scattering from the tables.
  if (kCloudFraction) m.lit.light.single = m.plain;
  states[i] = vec4(m.lit.light.single.rgb, m.lit.first);
  states[i + 1u] = vec4(m.lit.light.high.rgb, m.lit.total);
  states[i + 2u] = vec4(m.light.rgb, m.end_lit_fraction);
  states[i + 3u] = STORED(m.lit.tint, 0.0);
#ifdef SPECTRAL
  states[i + 4u] = vec4(m.lit.light.single.a, m.lit.light.high.a, m.light.a, 0.0);
#endif
}

March load_march(uint at) {
  uint i = at * kStateVectors;
  vec4 single = states[i];
  vec4 high = states[i + 1u];
  vec4 light = states[i + 2u];
  March m = nothing_marched();
#ifdef SPECTRAL
  vec4 fourth_channel = states[i + 4u];
  m.lit.light = InScattering(vec4(single.rgb, fourth_channel.x), vec4(high.rgb, fourth_channel.y));
#else
  m.lit.light = InScattering(single.rgb, high.rgb);
#endif
  m.lit.first = single.a;
  m.lit.total = high.a;
  m.lit.tint = CHANNELS(states[i + 3u]);
#ifdef SPECTRAL
  m.light = vec4(light.rgb, fourth_channel.z);
#else
  m.light = light.rgb;
#endif
  if (kCloudFraction) {
    m.plain = m.lit.light.single;
    m.lit.light.single = Spectrum(0.0);
  }
  m.end_lit_fraction = light.a;
  return m;
}

#endif
