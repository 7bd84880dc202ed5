// Scatters the incident light of a late order: writes the source function of the next order as Fourier terms in
// azimuth, and adds it and the horizontal irradiance to their sums (late_source.glsl). The last turn completes the sums
// by an estimate of all orders beyond: a geometric series with one ratio per channel. One invocation per sun x source
// zenith x altitude.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_values.glsl"
#include "precompute/half_texel.glsl"
#include "precompute/late_source.glsl"
#include "precompute/phase_terms.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 3) readonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 4) buffer late_terms_block { vec4 late_terms[]; };
layout(std430, binding = 5) readonly buffer sum_block { vec4 sums[]; };
layout(std430, binding = 6) buffer irradiance_block { vec4 irradiance[]; };
layout(std430, binding = 7) buffer sky_block { vec4 sky[]; };
layout(binding = 8, rgba16f) uniform writeonly image3D source_function;

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // order of the source function that this pass writes
}
push;

// Bound on the ratio of successive orders. Conservative scattering in thick air comes close to 1.
const float kMaxRatio = 0.95;

// Returns the ratio of successive orders, which after many scatterings is the largest eigenvalue of transport and
// therefore the same at every point, direction and sun. The irradiance at sea level approaches it from below under the
// highest sun and from above under one on the horizon; the mean of both is returned.
Spectrum settled_ratio() {
  Spectrum sum = Spectrum(0.0);
  for (int end = 0; end < 2; ++end) {
    uint sun = end == 0 ? kGatherSuns - 1u : uint(gather_sun_index(sun_axis(medium), 0.0) + 0.5);
    uint point = kGatherBelow * kGatherSuns + sun;
    Spectrum now = CHANNELS(irradiance[irradiance_row(push.order - 2u, point)]);
    Spectrum before = CHANNELS(irradiance[irradiance_row(push.order - 3u, point)]);
    sum += 0.5 * min(now / max(before, Spectrum(1.0e-30)), Spectrum(kMaxRatio));
  }
  return sum;
}

void main() {
  uint sun = gl_GlobalInvocationID.x;
  uint zenith = gl_GlobalInvocationID.y;
  uint altitude = gl_GlobalInvocationID.z + push.first;
  if (sun >= kGatherSuns || zenith >= kSourceZeniths || altitude >= kGatherAltitudes) return;
  float h = gather_altitude(medium, altitude);
  Spectrum aerosol = aerosol_part(medium, h);
  bool last = push.order == shape.orders + kLateOrders;
  Spectrum beyond = Spectrum(0.0);
  if (last) {
    Spectrum ratio = settled_ratio();
    beyond = ratio / (1.0 - ratio);
  }
  Spectrum terms[kLateTerms];
  for (uint m = 0u; m < kLateTerms; ++m) terms[m] = Spectrum(0.0);
  uint modes = late_modes(shape, push.order - 1u);
  for (uint q = 0u; q < kGatherZeniths; ++q) {
    for (uint m = 0u; m < modes; ++m) {
      PhaseTerm p = phase_term(((altitude * kSourceZeniths + zenith) * kGatherZeniths + q) * kModes + m);
      Spectrum light = CHANNELS(incident[late_incident_index(altitude, q, m, sun)]);
      terms[m] += light * (p.rayleigh * (1.0 - aerosol) + p.aerosol * aerosol);
    }
  }
  Spectrum sums_of[kLateTerms];
  for (uint m = 0u; m < kLateTerms; ++m) {
    uint sum_index = late_sum_index(altitude, zenith, m, sun);
    Spectrum sum = terms[m];
    if (push.order > shape.orders + 1u) sum += CHANNELS(late_terms[sum_index]);
    sums_of[m] = sum + terms[m] * beyond;
    late_terms[sum_index] = STORED(sum, 0.0);
    Spectrum stored = m == 0u   ? texel_from_value(terms[0])
                      : m == 1u ? terms[1] / max(terms[0], Spectrum(1.0e-30))
                                : terms[m];
    late_terms[late_source_index(altitude, zenith, m, sun)] = STORED(stored, 0.0);
  }
  if (last) {
    for (uint k = 0u; k < kSourceAzimuths; ++k) {
      float phi = source_azimuth(k);
      Spectrum value = Spectrum(0.0);
      for (uint m = 0u; m < kLateTerms; ++m) {
        // Vulkan bounds the error of cos() within half a turn only.
        float turns = float(m) * phi / (2.0 * kPi);
        value += sums_of[m] * cos((turns - floor(turns + 0.5)) * (2.0 * kPi));
      }
      uint index = source_index(altitude, zenith, k, sun);
      Spectrum all = CHANNELS(sums[index]) + max(value, Spectrum(0.0));
      imageStore(source_function, source_texel(altitude, zenith, k, sun), half_texel(texel_from_value(all)));
    }
  }
  if (zenith == 0u) {
    float horizon = horizon_cos(h, medium.planet_radius_m);
    Spectrum sum = Spectrum(0.0);
    for (uint q = kGatherZeniths / 2u; q < kGatherZeniths; ++q) {
      float node = quadrature.node[q - 12u];
      float weight = quadrature.weight[q - 12u] * gather_zenith_stretch(horizon, node, false);
      sum += CHANNELS(incident[late_incident_index(altitude, q, 0u, sun)]) *
             (2.0 * kPi * weight * max(gather_zenith(horizon, node, false), 0.0));
    }
    uint point = altitude * kGatherSuns + sun;
    irradiance[irradiance_row(push.order - 1u, point)] = STORED(sum, 0.0);
    sky[point] += STORED(sum * (1.0 + beyond), 0.0);
  }
}
