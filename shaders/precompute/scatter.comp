// Scatters the incident light of order n - 1 at the points of the gathering grid into every direction, as one Fourier
// series in azimuth per zenith angle. Writes the source function of order n (fourth root, per scattering coefficient),
// its sum over the orders so far (linear; fourth root once complete), the horizontal irradiance of order n - 1, and its
// sum. From 3 orders on, the source function of the last order is written as the terms from which the late orders
// continue (late_source.glsl), and these complete the sums; otherwise, the pass after the last order does. One group
// per altitude x sun.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/medium.glsl"
#include "lib/table_values.glsl"
#include "precompute/late_source.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 2) readonly buffer phase_block { vec2 phase[]; };
layout(std430, binding = 3) readonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 4) buffer source_block { vec4 source[]; };
layout(std430, binding = 5) buffer sum_block { vec4 sums[]; };
layout(std430, binding = 6) buffer irradiance_block { vec4 irradiance[]; };
layout(std430, binding = 7) buffer sky_block { vec4 sky[]; };

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // n, that of the source function
}
push;

shared vec3 light[kGatherZeniths * kModes];
shared vec3 scattered[kSourceZeniths * kModes];

void transform_light(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kGatherZeniths * kModes; i += 32u) {
    uint q = i / kModes;
    uint m = i % kModes;
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < kGatherAzimuths; ++k) {
      sum += incident[gather_index(altitude, q, k, sun)].rgb * cos(float(m) * gather_azimuth(k));
    }
    light[i] = sum * ((m == 0u ? 1.0 : 2.0) / float(kGatherAzimuths));
  }
}

void scatter_modes(uint lane, uint altitude, vec3 share) {
  for (uint i = lane; i < kSourceZeniths * kModes; i += 32u) {
    uint j = i / kModes;
    uint m = i % kModes;
    vec3 sum = vec3(0.0);
    for (uint q = 0u; q < kGatherZeniths; ++q) {
      vec2 p = phase[((altitude * kSourceZeniths + j) * kGatherZeniths + q) * kModes + m];
      sum += light[q * kModes + m] * (p.x * (1.0 - share) + p.y * share);
    }
    scattered[i] = sum;
  }
}

vec3 scattered_towards(uint j, float phi) {
  vec3 value = vec3(0.0);
  for (uint m = 0u; m < kModes; ++m) value += scattered[j * kModes + m] * cos(float(m) * phi);
  return max(value, vec3(0.0));
}

void store_source(uint lane, uint altitude, uint sun) {
  bool late = push.order == shape.orders && shape.orders > 2u;
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint j = i / kSourceAzimuths;
    uint index = source_index(altitude, j, i % kSourceAzimuths, sun);
    vec3 value = scattered_towards(j, source_azimuth(i % kSourceAzimuths));
    if (!late) source[index] = vec4(texel_from_value(value), 0.0);
    sums[index] = vec4(push.order == 2u ? value : sums[index].rgb + value, 0.0);
  }
  if (!late) return;
  for (uint i = lane; i < kSourceZeniths * kLateTerms; i += 32u) {
    uint j = i / kLateTerms;
    uint m = i % kLateTerms;
    vec3 term = scattered[j * kModes + m];
    if (m == 0u) term = texel_from_value(term);
    if (m == 1u) term /= max(scattered[j * kModes], vec3(1.0e-30));
    source[late_source_index(altitude, j, m, sun)] = vec4(term, 0.0);
  }
}

void complete_sums(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint index = source_index(altitude, i / kSourceAzimuths, i % kSourceAzimuths, sun);
    sums[index] = vec4(texel_from_value(sums[index].rgb), 0.0);
  }
}

// Writes the irradiance of the incident light on a horizontal surface that faces up.
void store_irradiance(uint altitude, uint sun, float h) {
  float horizon = horizon_cos(h, medium.planet_radius_m);
  vec3 sum = vec3(0.0);
  for (uint q = kGatherZeniths / 2u; q < kGatherZeniths; ++q) {
    float node = quadrature.node[q - 12u];
    float weight = quadrature.weight[q - 12u] * gather_zenith_stretch(horizon, node, false);
    sum += light[q * kModes] * (2.0 * kPi * weight * max(gather_zenith(horizon, node, false), 0.0));
  }
  uint point = altitude * kGatherSuns + sun;
  irradiance[irradiance_row(push.order - 1u, point)] = vec4(sum, 0.0);
  if (push.order == 2u) {
    sky[point] = vec4(sum, 0.0);
  } else {
    sky[point] += vec4(sum, 0.0);
  }
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint sun = gl_WorkGroupID.x;
  uint altitude = gl_WorkGroupID.y + push.first;
  float h = gather_altitude(medium, altitude);
  transform_light(lane, altitude, sun);
  barrier();
  bool complete = push.order > shape.orders;
  if (!complete) scatter_modes(lane, altitude, aerosol_part(medium, h));
  barrier();
  if (!complete) {
    store_source(lane, altitude, sun);
  } else {
    complete_sums(lane, altitude, sun);
  }
  if (lane == 0u) store_irradiance(altitude, sun, h);
}
