// Computes the Fourier coefficients in azimuth of the phase functions between the directions of incident and of
// scattered light, as in the discrete-ordinate method (Chandrasekhar, "Radiative Transfer", 1950, chapter VI; Stamnes
// et al., "Numerically stable algorithm for discrete-ordinate-method radiative transfer", 1988).
// Writes phase[((altitude * source zeniths + j) * gather zeniths + q) * modes + m], x: Rayleigh, y: aerosol:
//   2 * integral from 0 to pi of P cos(m phi) d phi times the quadrature weight of q [1].
// Each row is scaled to conserve energy: the entries of mode 0 add up to 1 over q.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/phase.glsl"
#include "precompute/gather_grid.glsl"

layout(local_size_x = 8) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 2) writeonly buffer phase_block { vec2 phase[]; };

const uint kAngles = 64u;

void main() {
  uint j = gl_GlobalInvocationID.x;
  uint altitude = gl_GlobalInvocationID.y;
  if (j >= kSourceZeniths || altitude >= kGatherAltitudes) return;
  float horizon = horizon_cos(gather_altitude(medium, altitude), medium.planet_radius_m);
  float theta = source_zenith(j);
  float mu = cos(theta);
  float sine = sin(theta);
  vec2 total = vec2(0.0);
  for (int pass = 0; pass < 2; ++pass) {
    vec2 scale = pass == 0 ? vec2(1.0) : 1.0 / total;
    for (uint q = 0u; q < kGatherZeniths; ++q) {
      bool below = q < 12u;
      float node = quadrature.node[q % 12u];
      float incident_mu = gather_zenith(horizon, node, below);
      float weight = quadrature.weight[q % 12u] * gather_zenith_stretch(horizon, node, below);
      float spread = sine * sqrt(max(1.0 - incident_mu * incident_mu, 0.0));
      vec2 modes[kModes];
      for (uint m = 0u; m < kModes; ++m) modes[m] = vec2(0.0);
      for (uint k = 0u; k < kAngles; ++k) {
        float cosine = cos((float(k) + 0.5) * kPi / float(kAngles));
        float nu = clamp(mu * incident_mu + spread * cosine, -1.0, 1.0);
        vec2 p = vec2(rayleigh_phase(nu), mie_phase(medium, nu)) * (2.0 * kPi / float(kAngles) * weight);
        // cos(m phi) by Chebyshev's recurrence.
        float before = cosine;
        float now = 1.0;
        for (uint m = 0u; m < kModes; ++m) {
          modes[m] += p * now;
          float after = 2.0 * cosine * now - before;
          before = now;
          now = after;
        }
      }
      if (pass == 0) {
        total += modes[0];
      } else {
        uint base = ((altitude * kSourceZeniths + j) * kGatherZeniths + q) * kModes;
        for (uint m = 0u; m < kModes; ++m) phase[base + m] = modes[m] * scale;
      }
    }
  }
}
