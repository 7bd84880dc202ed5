// Scatters the incident light of order n - 1 at the points of the gathering grid into every direction, as one Fourier
// series in azimuth per zenith angle. Writes the source function of order n (fourth root, per scattering coefficient),
// its sum over the orders so far (linear; fourth root once complete), the horizontal irradiance of order n - 1, and its
// sum. From 3 orders on, the source function of the last order is written as the terms from which the late orders
// continue (late_source.glsl), and these complete the sums. With fewer orders, the pass after the last order completes
// them. One group per altitude x sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "lib/medium.glsl"
#include "lib/table_values.glsl"
#include "precompute/half_texel.glsl"
#include "precompute/late_source.glsl"
#include "precompute/phase_terms.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 3) readonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 4) writeonly buffer late_terms_block { vec4 late_terms[]; };
layout(std430, binding = 5) buffer sum_block { vec4 sums[]; };
layout(std430, binding = 6) buffer irradiance_block { vec4 irradiance[]; };
layout(std430, binding = 7) buffer sky_block { vec4 sky[]; };
layout(binding = 8, rgba16f) uniform writeonly image3D source_function;

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // n, that of the source function
}
push;

shared Spectrum light[kGatherZeniths * kModes];
shared Spectrum scattered[kSourceZeniths * kModes];

// Cosines of the multiples of an angle by recurrence: advance() goes from cos(x - step) and cos(x) to cos(x) and
// cos(x + step).
struct Cosine {
  float before;
  float now;
};
void advance(inout Cosine c, float twice_cos_step) { c = Cosine(c.now, twice_cos_step * c.now - c.before); }

// Returns i / n for small numbers; some devices divide integers slowly.
uint quotient(uint i, float inverse_n) { return uint((float(i) + 0.5) * inverse_n); }

// Each invocation computes several values that share their loads.
const uint kModesEach = 4u;
const uint kZenithsEach = 3u;
const uint kAzimuthsEach = 3u;

// Computes the Fourier series of the incident light in azimuth.
void transform_light(uint lane, uint altitude, uint sun) {
  const uint kGroups = kModes / kModesEach;
  for (uint i = lane; i < kGatherZeniths * kGroups; i += 32u) {
    uint q = i / kGroups;
    uint first = i % kGroups * kModesEach;
    Cosine c[kModesEach];
    float twice[kModesEach];
    Spectrum sums[kModesEach];
    [[unroll]] for (uint n = 0u; n < kModesEach; ++n) {
      float m = float(first + n);
      twice[n] = 2.0 * cos(m * (kPi / float(kGatherAzimuths)));
      float start = cos(m * gather_azimuth(0u));
      c[n] = Cosine(start, start);
      sums[n] = Spectrum(0.0);
    }
    for (uint k = 0u; k < kGatherAzimuths; ++k) {
      Spectrum radiance = CHANNELS(incident[gather_index(altitude, q, k, sun)]);
      [[unroll]] for (uint n = 0u; n < kModesEach; ++n) {
        sums[n] += radiance * c[n].now;
        advance(c[n], twice[n]);
      }
    }
    [[unroll]] for (uint n = 0u; n < kModesEach; ++n) {
      light[q * kModes + first + n] = sums[n] * ((first + n == 0u ? 1.0 : 2.0) / float(kGatherAzimuths));
    }
  }
}

void scatter_modes(uint lane, uint altitude, uint modes, Spectrum aerosol) {
  const uint kGroups = kSourceZeniths / kZenithsEach;
  float inverse = 1.0 / float(modes);
  for (uint i = lane; i < kGroups * modes; i += 32u) {
    uint j = quotient(i, inverse);
    uint m = i - j * modes;
    Spectrum sums[kZenithsEach];
    [[unroll]] for (uint n = 0u; n < kZenithsEach; ++n) sums[n] = Spectrum(0.0);
    for (uint q = 0u; q < kGatherZeniths; ++q) {
      Spectrum radiance = light[q * kModes + m];
      Spectrum from_aerosol = radiance * aerosol;
      Spectrum from_air = radiance - from_aerosol;
      [[unroll]] for (uint n = 0u; n < kZenithsEach; ++n) {
        PhaseTerm p = phase_term(((altitude * kSourceZeniths + j + n * kGroups) * kGatherZeniths + q) * kModes + m);
        sums[n] += from_air * p.rayleigh + from_aerosol * p.aerosol;
      }
    }
    [[unroll]] for (uint n = 0u; n < kZenithsEach; ++n) scattered[(j + n * kGroups) * kModes + m] = sums[n];
  }
}

void store_value(uint altitude, uint j, uint k, uint sun, bool late, Spectrum value) {
  if (!late) imageStore(source_function, source_texel(altitude, j, k, sun), half_texel(texel_from_value(value)));
  uint index = source_index(altitude, j, k, sun);
  if (push.order > 2u) value += CHANNELS(sums[index]);
  sums[index] = STORED(value, 0.0);
}

void store_source(uint lane, uint altitude, uint sun, uint modes) {
  const uint kGroups = kSourceAzimuths / kAzimuthsEach;
  bool late = push.order == shape.orders && shape.orders > 2u;
  for (uint i = lane; i < kSourceZeniths * kGroups; i += 32u) {
    uint j = i / kGroups;
    uint first = i % kGroups * kAzimuthsEach;
    Cosine c[kAzimuthsEach];
    float twice[kAzimuthsEach];
    Spectrum values[kAzimuthsEach];
    [[unroll]] for (uint n = 0u; n < kAzimuthsEach; ++n) {
      float cosine = cos(source_azimuth(first + n));
      c[n] = Cosine(cosine, 1.0);
      twice[n] = 2.0 * cosine;
      values[n] = Spectrum(0.0);
    }
    for (uint m = 0u; m < modes; ++m) {
      Spectrum term = scattered[j * kModes + m];
      [[unroll]] for (uint n = 0u; n < kAzimuthsEach; ++n) {
        values[n] += term * c[n].now;
        advance(c[n], twice[n]);
      }
    }
    [[unroll]] for (uint n = 0u; n < kAzimuthsEach; ++n) {
      store_value(altitude, j, first + n, sun, late, max(values[n], Spectrum(0.0)));
    }
  }
  if (!late) return;
  for (uint i = lane; i < kSourceZeniths * kLateTerms; i += 32u) {
    uint j = i / kLateTerms;
    uint m = i % kLateTerms;
    Spectrum term = scattered[j * kModes + m];
    if (m == 0u) term = texel_from_value(term);
    if (m == 1u) term /= max(scattered[j * kModes], Spectrum(1.0e-30));
    late_terms[late_source_index(altitude, j, m, sun)] = STORED(term, 0.0);
  }
}

// Writes the sums of the source functions to the image, from which the table of the higher orders is integrated.
void complete_sums(uint lane, uint altitude, uint sun) {
  for (uint i = lane; i < kSourceZeniths * kSourceAzimuths; i += 32u) {
    uint j = i / kSourceAzimuths;
    uint k = i % kSourceAzimuths;
    Spectrum texel = texel_from_value(CHANNELS(sums[source_index(altitude, j, k, sun)]));
    imageStore(source_function, source_texel(altitude, j, k, sun), half_texel(texel));
  }
}

// Writes the irradiance of the incident light on a horizontal surface that faces up.
void store_irradiance(uint altitude, uint sun, float h) {
  float horizon = horizon_cos(h, medium.planet_radius_m);
  Spectrum sum = Spectrum(0.0);
  for (uint q = kGatherZeniths / 2u; q < kGatherZeniths; ++q) {
    float node = quadrature.node[q - 12u];
    float weight = quadrature.weight[q - 12u] * gather_zenith_stretch(horizon, node, false);
    sum += light[q * kModes] * (2.0 * kPi * weight * max(gather_zenith(horizon, node, false), 0.0));
  }
  uint point = altitude * kGatherSuns + sun;
  irradiance[irradiance_row(push.order - 1u, point)] = STORED(sum, 0.0);
  if (push.order == 2u) {
    sky[point] = STORED(sum, 0.0);
  } else {
    sky[point] += STORED(sum, 0.0);
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
  uint modes = source_modes(push.order);
  if (!complete) scatter_modes(lane, altitude, modes, aerosol_part(medium, h));
  barrier();
  if (!complete) {
    store_source(lane, altitude, sun, modes);
  } else {
    complete_sums(lane, altitude, sun);
  }
  if (lane == 0u) store_irradiance(altitude, sun, h);
}
