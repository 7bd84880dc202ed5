// What a ray has gathered, between passes that march one cascade each. Include after declaring
//   buffer state_block { float states[]; };
#ifndef TYNDALL_MARCH_STATE_GLSL
#define TYNDALL_MARCH_STATE_GLSL

const uint kStateFloats = 16u;  // as in src/effect/epipolar.cpp

void store_march(uint at, March m) {
  uint i = at * kStateFloats;
  states[i] = m.lit.first;
  states[i + 1u] = m.lit.total;
  states[i + 14u] = m.end_share;
  for (uint k = 0u; k < 3u; ++k) {
    states[i + 2u + k] = m.lit.light.single[k];
    states[i + 5u + k] = m.lit.light.high[k];
    states[i + 8u + k] = m.light[k];
    states[i + 11u + k] = m.lit.tint[k];
  }
}

March load_march(uint at) {
  uint i = at * kStateFloats;
  March m = nothing_marched();
  m.lit.first = states[i];
  m.lit.total = states[i + 1u];
  m.end_share = states[i + 14u];
  m.lit.light.single = vec3(states[i + 2u], states[i + 3u], states[i + 4u]);
  m.lit.light.high = vec3(states[i + 5u], states[i + 6u], states[i + 7u]);
  m.light = vec3(states[i + 8u], states[i + 9u], states[i + 10u]);
  m.lit.tint = vec3(states[i + 11u], states[i + 12u], states[i + 13u]);
  return m;
}

#endif
