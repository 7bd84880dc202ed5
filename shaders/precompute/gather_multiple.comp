// Integrates the source function of one order >= 2 along the rays that arrive at the points of the gathering grid, and
// adds the ground lit by the order before. Writes the incident light (gather_index). One invocation per sun x
// (kAnglesPerInvocation azimuths) x (zenith of an altitude).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "precompute/source_lookup.glsl"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer grid_rays_block { QuadratureRay rays[]; };
layout(std430, binding = 2) writeonly buffer incident_block { vec4 incident[]; };
layout(binding = 3) uniform sampler3D source_function;
layout(std430, binding = 4) readonly buffer irradiance_block { vec4 irradiance[]; };  // order x altitude x sun

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // one more than that of the light that arrives
}
push;

void main() {
  SunAxis suns = sun_axis(medium);
  float mu_s = gather_sun(medium, gl_GlobalInvocationID.x);
  float R = medium.planet_radius_m;
  Spectrum albedo = GROUND_ALBEDO(medium);
  uint sun = gl_GlobalInvocationID.x;
  uint azimuth = gl_GlobalInvocationID.y * kAnglesPerInvocation;
  uint altitude = gl_GlobalInvocationID.z / kGatherZeniths + push.first;
  uint zenith = gl_GlobalInvocationID.z % kGatherZeniths;
  if (sun >= kGatherSuns || azimuth >= kGatherAzimuths || altitude >= kGatherAltitudes) return;
  uint ray = altitude * kGatherZeniths + zenith;
  vec4 start = rays[ray].start;
  vec4 end = rays[ray].end;
  uint count = uint(start.w);
  float q0 = (R + start.x) * mu_s;
  float spread = sqrt(max((1.0 - start.y * start.y) * (1.0 - mu_s * mu_s), 0.0));
  float nu[kAnglesPerInvocation];
  Spectrum radiance[kAnglesPerInvocation];
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    nu[k] = clamp(start.y * mu_s + spread * cos(gather_azimuth(azimuth + k)), -1.0, 1.0);
    radiance[k] = Spectrum(0.0);
  }
  for (uint i = 0u; i < count; ++i) {
    RayNode node = rays[ray].high_nodes[i];
    [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
      float sun_here = (q0 + node.path.a * nu[k]) / node.place.w;
      float azimuth_here = acos(clamp(cos_azimuth(node.place.z, sun_here, nu[k]), -1.0, 1.0));
      radiance[k] += HIGH_PATH(rays[ray], node, i) * source_at(source_function, node.place.x, node.place.y,
                                                               source_azimuth_index(azimuth_here),
                                                               gather_sun_index(suns, sun_here));
    }
  }
  // Below the horizon, the ray ends on the ground.
  if (zenith < kGatherZeniths / 2u) {
    Spectrum reflected = RAY_END(rays[ray], end) * (albedo / kPi);
    [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
      float index = gather_sun_index(suns, (q0 + end.a * nu[k]) / (R + gather_ground(start.x)));
      uint s = min(uint(index), kGatherSuns - 2u);
      uint row = irradiance_row(push.order - 2u, gather_ground_row(altitude) + s);
      radiance[k] += reflected * mix(CHANNELS(irradiance[row]), CHANNELS(irradiance[row + 1u]), index - float(s));
    }
  }
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    incident[gather_index(altitude, zenith, azimuth + k, sun)] = STORED(radiance[k], 0.0);
  }
}
