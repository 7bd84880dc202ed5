// From the light that arrives at a point to the light that its air scatters into every direction, as one
// Fourier series in azimuth per zenith angle; and the horizontal irradiance there.
// In: incident light of order n - 1. Out: source of order n (fourth root, per scattering coefficient), the sum
// of the orders so far (linear; fourth root once complete, with the orders beyond as a geometric series),
// irradiance of order n - 1, and the sum of the irradiances so far. One group per altitude x sun.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/medium.glsl"
#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block { TableShape shape; ZenithQuadrature quadrature; };
layout(std430, binding = 2) readonly buffer phase_block { vec2 phase[]; };
layout(std430, binding = 3) readonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 4) buffer source_block { vec4 source[]; };
layout(std430, binding = 5) buffer sum_block { vec4 sums[]; };
layout(std430, binding = 6) buffer irradiance_block { vec4 irradiance[]; };
layout(std430, binding = 7) buffer sky_block { vec4 sky[]; };

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // n: of the light that is scattered here
} push;

// Of a geometric series of orders; what conservative scattering in thick air can come near.
const float kLargestRatio = 0.95;

shared vec3 light[kGatherZeniths * kModes];
shared vec3 scattered[kSourceZeniths * kModes];

// The sum of r + r^2 + ... for the ratio of two orders.
vec3 beyond(vec3 last, vec3 before) {
  vec3 ratio = min(last / max(before, vec3(1.0e-30)), vec3(kLargestRatio));
  return ratio / (1.0 - ratio);
}

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

void scatter_modes(uint lane, uint altitude, float h) {
  vec3 density = densities(medium, h);
  vec3 rayleigh = medium.rayleigh_scattering * density.x;
  vec3 mie = medium.mie_scattering * density.y;
  vec3 share = mie / max(rayleigh + mie, vec3(1.0e-30));
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

void store_source(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint j = i / kSourceAzimuths;
    float phi = float(i % kSourceAzimuths) * kPi / float(kSourceAzimuths - 1u);
    vec3 value = vec3(0.0);
    for (uint m = 0u; m < kModes; ++m) value += scattered[j * kModes + m] * cos(float(m) * phi);
    value = max(value, vec3(0.0));
    uint index = source_index(altitude, j, i % kSourceAzimuths, sun);
    vec3 before = value_from_texel(source[index].rgb);
    vec3 sum = push.order == 2u ? value : sums[index].rgb + value;
    if (push.order >= shape.orders) {
      if (push.order > 2u) sum += value * beyond(value, before);
      sum = texel_from_value(sum);
    }
    source[index] = vec4(texel_from_value(value), 0.0);
    sums[index] = vec4(sum, 0.0);
  }
}

// Of the light that arrives, on a horizontal surface that faces up.
void store_irradiance(uint altitude, uint sun, float h) {
  float horizon = horizon_cos(h, medium.planet_radius_m);
  vec3 sum = vec3(0.0);
  for (uint q = kGatherZeniths / 2u; q < kGatherZeniths; ++q) {
    float node = quadrature.node[q - 12u];
    float weight = quadrature.weight[q - 12u] * gather_zenith_stretch(horizon, node, false);
    sum += light[q * kModes] * (2.0 * kPi * weight * max(gather_zenith(horizon, node, false), 0.0));
  }
  uint index = altitude * kGatherSuns + sun;
  vec3 before = irradiance[index].rgb;
  irradiance[index] = vec4(sum, 0.0);
  if (push.order == 2u) {
    sky[index] = vec4(sum, 0.0);
  } else {
    if (push.order > shape.orders && push.order > 3u) sum += sum * beyond(sum, before);
    sky[index] += vec4(sum, 0.0);
  }
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint sun = gl_WorkGroupID.x;
  uint altitude = gl_WorkGroupID.y + push.first;
  float h = gather_altitude(medium, altitude);
  transform_light(lane, altitude, sun);
  barrier();
  if (push.order <= shape.orders) {
    scatter_modes(lane, altitude, h);
    barrier();
    store_source(lane, altitude, sun);
  }
  if (lane == 0u) store_irradiance(altitude, sun, h);
}
