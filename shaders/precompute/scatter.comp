// Scatters the incident light of order n - 1 at the points of the gathering grid into every direction, as one Fourier
// series in azimuth per zenith angle. Writes the source function of order n (fourth root, per scattering coefficient),
// its sum over the orders so far (linear; fourth root once complete), the horizontal irradiance of order n - 1, and its
// sum. The pass after the last order completes the sums. From 3 orders on, it adds the order that follows from the last
// incident light, and an estimate of all orders beyond. One group per altitude x sun.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/medium.glsl"
#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"

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

// Bound on the ratio of successive orders. Conservative scattering in thick air comes close to 1.
const float kMaxRatio = 0.95;

shared vec3 light[kGatherZeniths * kModes];
shared vec3 scattered[kSourceZeniths * kModes];
shared vec3 partial_now[32];
shared vec3 partial_before[32];
shared vec3 ratio;  // of an order to the one before, once that has settled

// Returns the sum of all orders after `last`, from the last two. Successive orders are taken for the sum of two
// geometric series: a slow one, whose ratio is the largest eigenvalue of transport and therefore the same at every
// point, direction and sun, and one that falls twice as fast. The ratio of the two orders themselves would not do:
// where the sun is low and the aerosol dense, light of the first orders is still arriving, and their ratio is far above
// that of later ones.
vec3 orders_beyond(vec3 last, vec3 before, vec3 ratio) {
  vec3 fast = 0.5 * ratio;
  vec3 scale = 1.0 / ((1.0 - ratio) * (1.0 - fast));
  return max((last * (ratio + fast - ratio * fast) - before * ratio * fast) * scale, vec3(0.0));
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

// Sets `ratio` to the ratio of the last two orders of the source at sea level, averaged over all directions, once it
// has settled: it rises to that value under the highest sun and falls to it under one on the horizon, and their mean is
// close. The mean of what is scattered is the mean of the light that arrives.
void find_ratio(uint lane) {
  float horizon = horizon_cos(0.0, medium.planet_radius_m);
  if (lane == 0u) ratio = vec3(0.0);
  for (int end = 0; end < 2; ++end) {
    uint sun = end == 0 ? kGatherSuns - 1u : uint(gather_sun_index(medium, 0.0) + 0.5);
    vec3 now = vec3(0.0);
    for (uint i = lane; i < kGatherZeniths * kGatherAzimuths; i += 32u) {
      uint q = i / kGatherAzimuths;
      float stretch = gather_zenith_stretch(horizon, quadrature.node[q % 12u], q < kGatherZeniths / 2u);
      float weight = quadrature.weight[q % 12u] * stretch * (0.5 / float(kGatherAzimuths));
      now += weight * incident[gather_index(kGatherBelow, q, i % kGatherAzimuths, sun)].rgb;
    }
    vec3 before = vec3(0.0);
    for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
      uint j = i / kSourceAzimuths;
      uint k = i % kSourceAzimuths;
      float weight = (k == 0u || k == kSourceAzimuths - 1u ? 0.25 : 0.5) / float(kSourceAzimuths - 1u);
      before += (weight * source_zenith_weight(j) * sin(source_zenith(j))) *
                value_from_texel(source[source_index(kGatherBelow, j, k, sun)].rgb);
    }
    partial_now[lane] = now;
    partial_before[lane] = before;
    barrier();
    if (lane == 0u) {
      for (uint i = 1u; i < 32u; ++i) {
        now += partial_now[i];
        before += partial_before[i];
      }
      ratio += 0.5 * min(now / max(before, vec3(1.0e-30)), vec3(kMaxRatio));
    }
    barrier();
  }
}

vec3 scattered_towards(uint j, float phi) {
  vec3 value = vec3(0.0);
  for (uint m = 0u; m < kModes; ++m) value += scattered[j * kModes + m] * cos(float(m) * phi);
  return max(value, vec3(0.0));
}

void store_source(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint j = i / kSourceAzimuths;
    uint index = source_index(altitude, j, i % kSourceAzimuths, sun);
    vec3 value = scattered_towards(j, float(i % kSourceAzimuths) * kPi / float(kSourceAzimuths - 1u));
    source[index] = vec4(texel_from_value(value), 0.0);
    sums[index] = vec4(push.order == 2u ? value : sums[index].rgb + value, 0.0);
  }
}

// Leaves the sources as they are: other groups read them for the ratio.
void complete_sums(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint j = i / kSourceAzimuths;
    uint index = source_index(altitude, j, i % kSourceAzimuths, sun);
    vec3 sum = sums[index].rgb;
    if (shape.orders > 2u) {
      vec3 value = scattered_towards(j, float(i % kSourceAzimuths) * kPi / float(kSourceAzimuths - 1u));
      sum += value + orders_beyond(value, value_from_texel(source[index].rgb), ratio);
    }
    sums[index] = vec4(texel_from_value(sum), 0.0);
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
  uint index = altitude * kGatherSuns + sun;
  vec3 before = irradiance[index].rgb;
  irradiance[index] = vec4(sum, 0.0);
  if (push.order == 2u) {
    sky[index] = vec4(sum, 0.0);
  } else {
    if (push.order > shape.orders && push.order > 3u) sum += orders_beyond(sum, before, ratio);
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
  bool complete = push.order > shape.orders;
  if (complete && shape.orders > 2u) find_ratio(lane);
  if (!complete || shape.orders > 2u) scatter_modes(lane, altitude, h);
  barrier();
  if (!complete) {
    store_source(lane, altitude, sun);
  } else {
    complete_sums(lane, altitude, sun);
  }
  if (lane == 0u) store_irradiance(altitude, sun, h);
}
