// Computes the Fourier coefficients in azimuth of the phase functions between the directions of incident and of
// scattered light, as in the discrete-ordinate method (Chandrasekhar, "Radiative Transfer", 1950, chapter VI; Stamnes
// et al., "Numerically stable algorithm for discrete-ordinate-method radiative transfer", 1988).
// Writes phase[((altitude * source zeniths + j) * gather zeniths + q) * modes + m], x: Rayleigh, y: aerosol (see
// kPhaseTerms for tables of the aerosol's phase function):
//   2 * integral from 0 to pi of P cos(m phi) d phi times the quadrature weight of q [1].
// Each row is scaled to conserve energy: the entries of mode 0 add up to 1 over q.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "precompute/phase_block.glsl"

#include "precompute/gather_grid.glsl"

layout(local_size_x = 8) in;

layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 2) writeonly buffer phase_block { vec2 phase[]; };

const uint kAngles = 64u;

// Rayleigh, and the aerosol in each channel. Without a table of the phase function, all channels are equal.
struct Both {
  float rayleigh;
  vec4 aerosol;
};

Both phases(float nu) {
  Both p = Both(rayleigh_phase(nu), vec4(0.0));
  if (kPhaseTable) {
    p.aerosol = tabulated_phase(medium, nu);
  } else {
    p.aerosol.x = mie_phase(medium, nu);
  }
  return p;
}

void store(uint index, float rayleigh, vec4 aerosol) {
  if (kPhaseTable) {
    phase[kPhaseTerms * index] = vec2(rayleigh, aerosol.x);
    phase[kPhaseTerms * index + 1u] = aerosol.yz;
    phase[kPhaseTerms * index + 2u] = vec2(aerosol.w, 0.0);
  } else {
    phase[index] = vec2(rayleigh, aerosol.x);
  }
}

void main() {
  uint j = gl_GlobalInvocationID.x;
  uint altitude = gl_GlobalInvocationID.y;
  if (j >= kSourceZeniths || altitude >= kGatherAltitudes) return;
  float horizon = horizon_cos(gather_altitude(medium, altitude), medium.planet_radius_m);
  float theta = source_zenith(j);
  float mu = cos(theta);
  float sine = sin(theta);
  Both total = Both(0.0, vec4(0.0));
  for (int pass = 0; pass < 2; ++pass) {
    Both scale = Both(1.0, vec4(1.0));
    if (pass == 1) scale = Both(1.0 / total.rayleigh, 1.0 / total.aerosol);
    for (uint q = 0u; q < kGatherZeniths; ++q) {
      bool below = q < 12u;
      float node = quadrature.node[q % 12u];
      float incident_mu = gather_zenith(horizon, node, below);
      float weight = quadrature.weight[q % 12u] * gather_zenith_stretch(horizon, node, below);
      float spread = sine * sqrt(max(1.0 - incident_mu * incident_mu, 0.0));
      float rayleigh[kModes];
      vec4 aerosol[kModes];
      for (uint m = 0u; m < kModes; ++m) {
        rayleigh[m] = 0.0;
        aerosol[m] = vec4(0.0);
      }
      for (uint k = 0u; k < kAngles; ++k) {
        float cosine = cos((float(k) + 0.5) * kPi / float(kAngles));
        float nu = clamp(mu * incident_mu + spread * cosine, -1.0, 1.0);
        Both p = phases(nu);
        float part = 2.0 * kPi / float(kAngles) * weight;
        p = Both(p.rayleigh * part, p.aerosol * part);
        // cos(m phi) by Chebyshev's recurrence.
        float before = cosine;
        float now = 1.0;
        for (uint m = 0u; m < kModes; ++m) {
          rayleigh[m] += p.rayleigh * now;
          aerosol[m] += p.aerosol * now;
          float after = 2.0 * cosine * now - before;
          before = now;
          now = after;
        }
      }
      if (pass == 0) {
        total = Both(total.rayleigh + rayleigh[0], total.aerosol + aerosol[0]);
      } else {
        uint base = ((altitude * kSourceZeniths + j) * kGatherZeniths + q) * kModes;
        for (uint m = 0u; m < kModes; ++m) store(base + m, rayleigh[m] * scale.rayleigh, aerosol[m] * scale.aerosol);
      }
    }
  }
}
