// Integrates the source function of one order >= 2 along the rays that arrive at the points of the gathering grid, and
// adds the ground lit by the order before. Writes the incident light (gather_index). One invocation per sun x azimuth x
// (zenith of an altitude).
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer source_block { vec4 source[]; };

#include "precompute/ray_nodes.glsl"
#include "precompute/source_lookup.glsl"

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer node_block { RayNode nodes[]; };
layout(std430, binding = 2) writeonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 5) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 4) readonly buffer irradiance_block { vec4 irradiance[]; };  // order x altitude x sun

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // one more than that of the light that arrives
}
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
  vec3 radiance = vec3(0.0);
  for (uint i = 0u; i < kHighNodes; ++i) {
    RayNode node = nodes[base + kFirstHighNode + i];
    float sun_here = (r0 * mu_s + node.distance_m * nu) / (R + node.altitude_m);
    vec3 scattering = medium.rayleigh_scattering * node.rayleigh + medium.mie_scattering * node.mie;
    radiance += node.weight_m * scattering * source_at(medium, node.altitude_m, node.cos_zenith, sun_here, nu);
  }
  if (below) {
    RayNode end = nodes[base + kEndNode];
    float index = gather_sun_index(medium, (r0 * mu_s + end.distance_m * nu) / (R + gather_ground(h)));
    uint s = min(uint(index), kGatherSuns - 2u);
    uint row = irradiance_row(push.order - 2u, gather_ground_row(altitude) + s);
    vec3 light = mix(irradiance[row].rgb, irradiance[row + 1u].rgb, index - float(s));
    radiance += end.weight_m * light * (medium.ground_albedo / kPi);
  }
  incident[gather_index(altitude, zenith, azimuth, sun)] = vec4(radiance, 0.0);
}
