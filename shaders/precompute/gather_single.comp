// Integrates the light that is scattered or reflected once along the rays that arrive at the points of the gathering
// grid. The phase functions are exact, so that order 2 receives the full aureole of the sun. Writes the incident light
// (gather_index), radiance / E0. One invocation per sun x azimuth x (zenith of an altitude).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/phase.glsl"
#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"
#include "precompute/ray_nodes.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 3) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 1) readonly buffer node_block { RayNode nodes[]; };
layout(std430, binding = 2) writeonly buffer incident_block { vec4 incident[]; };

layout(push_constant) uniform Push { uint first; }
push;

void main() {
  uint sun = gl_GlobalInvocationID.x;
  uint azimuth = gl_GlobalInvocationID.y;
  uint zenith = gl_GlobalInvocationID.z % kGatherZeniths;
  uint altitude = gl_GlobalInvocationID.z / kGatherZeniths + push.first;
  if (sun >= kGatherSuns || azimuth >= kGatherAzimuths || altitude >= kGatherAltitudes) return;
  uint base = (altitude * kGatherZeniths + zenith) * kNodeStride;
  float R = medium.planet_radius_m;
  float h = gather_altitude(medium, altitude);
  float r0 = R + h;
  float mu_s = gather_sun(medium, sun);
  bool below = zenith < kGatherZeniths / 2u;
  float mu = gather_zenith(horizon_cos(h, R), quadrature.node[zenith % 12u], below);
  float spread = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0));
  float nu = clamp(mu * mu_s + spread * cos(gather_azimuth(azimuth)), -1.0, 1.0);
  vec3 rayleigh = medium.rayleigh_scattering * rayleigh_phase(nu);
  vec3 mie = medium.mie_scattering * mie_phase(medium, nu);
  vec3 radiance = vec3(0.0);
  for (uint i = 0u; i < kSingleNodes; ++i) {
    RayNode node = nodes[base + i];
    vec3 light = sun_transmittance_at(medium, node.altitude_m, r0 * mu_s + node.distance_m * nu);
    radiance += node.weight_m * light * (rayleigh * node.rayleigh + mie * node.mie);
  }
  if (below) {
    RayNode end = nodes[base + kEndNode];
    float q = r0 * mu_s + end.distance_m * nu;
    float ground = gather_ground(h);
    vec3 light = max(q / (R + ground), 0.0) * sun_transmittance_at(medium, ground, q);
    radiance += end.weight_m * light * (medium.ground_albedo / kPi);
  }
  incident[gather_index(altitude, zenith, azimuth, sun)] = vec4(radiance, 0.0);
}
