// Integrates the light that is scattered or reflected once along the rays that arrive at the points of the gathering
// grid. Phase functions that have a formula are exact, so that order 2 receives the full aureole of the sun; tables
// are without the details that the grid does not resolve (src/effect/phase_rows.hpp). Writes the incident light
// (gather_index), radiance / E0. One invocation per sun x (kAnglesPerInvocation azimuths) x (zenith of an altitude).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "precompute/phase_block.glsl"

#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 1) readonly buffer grid_rays_block { QuadratureRay rays[]; };
layout(std430, binding = 2) writeonly buffer incident_block { vec4 incident[]; };

layout(push_constant) uniform Push { uint first; }
push;  // altitude

void main() {
  Medium m = medium;
  uint sun = gl_GlobalInvocationID.x;
  uint azimuth = gl_GlobalInvocationID.y * kAnglesPerInvocation;
  uint altitude = gl_GlobalInvocationID.z / kGatherZeniths + push.first;
  uint zenith = gl_GlobalInvocationID.z % kGatherZeniths;
  if (sun >= kGatherSuns || azimuth >= kGatherAzimuths || altitude >= kGatherAltitudes) return;
  uint ray = altitude * kGatherZeniths + zenith;
  vec4 start = rays[ray].start;
  vec4 end = rays[ray].end;
  uint count = uint(start.z);
  float mu_s = gather_sun(m, sun);
  float q0 = (m.planet_radius_m + start.x) * mu_s;
  float spread = sqrt(max((1.0 - start.y * start.y) * (1.0 - mu_s * mu_s), 0.0));
  float nu[kAnglesPerInvocation];
  Spectrum rayleigh[kAnglesPerInvocation];
  Spectrum mie[kAnglesPerInvocation];
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    nu[k] = clamp(start.y * mu_s + spread * cos(gather_azimuth(azimuth + k)), -1.0, 1.0);
    rayleigh[k] = Spectrum(0.0);
    mie[k] = Spectrum(0.0);
  }
  for (uint i = 0u; i < count; ++i) {
    RayNode node = rays[ray].single_nodes[i];
    [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
      Spectrum light = SINGLE_PATH(node) * sun_transmittance_at(m, node.place.z, q0 + node.path.a * nu[k]);
      rayleigh[k] += light * node.place.x;
      mie[k] += light * node.place.y;
    }
  }
  // Below the horizon, the ray ends on the ground, which the sun lights.
  bool below = zenith < kGatherZeniths / 2u;
  float ground = gather_ground(start.x);
  Spectrum reflected = below ? RAY_END(rays[ray], end) * (GROUND_ALBEDO(m) / kPi) : Spectrum(0.0);
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    float q = q0 + end.a * nu[k];
    Spectrum radiance = reflected * (max(q / (m.planet_radius_m + ground), 0.0) * sun_transmittance_at(m, ground, q));
    radiance +=
        RAYLEIGH_SCATTERING(m) * rayleigh_phase(nu[k]) * rayleigh[k] + mie_scattering_towards(m, nu[k]) * mie[k];
    incident[gather_index(altitude, zenith, azimuth + k, sun)] = STORED(radiance, 0.0);
  }
}
