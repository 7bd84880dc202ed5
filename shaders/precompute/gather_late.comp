// Integrates the source function of a late order along the rays of the gathering grid, and adds the ground lit by the
// order before. Reads the source function and writes the incident light as Fourier terms in azimuth (late_source.glsl).
// The height of the sun changes along a ray, which couples the terms. Terms 0 and 1 include this: they are evaluated in
// two azimuths, 45 and 135 degrees. The others are small, and use the height of the sun at the beginning of the ray.
// One invocation per sun x zenith x altitude.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_values.glsl"
#include "precompute/late_source.glsl"
#include "precompute/source_lookup.glsl"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer grid_rays_block { QuadratureRay rays[]; };
layout(std430, binding = 2) writeonly buffer incident_block { vec4 incident[]; };
layout(std430, binding = 3) readonly buffer late_terms_block { vec4 late_terms[]; };
layout(std430, binding = 4) readonly buffer irradiance_block { vec4 irradiance[]; };
layout(std430, binding = 5) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};

layout(push_constant) uniform Push {
  uint first;  // altitude
  uint order;  // the order that scatter_late will compute from the result
}
push;

const float kCosine[kLateAzimuths] =
    float[kLateAzimuths](0.707106781186548, -0.707106781186548);  // of the two azimuths

// Terms 0 and 1 between two suns, as they are stored.
struct FirstTerms {
  Spectrum mean;
  Spectrum ratio;
};

FirstTerms between_suns(uint altitude, uint zenith, uint sun, float part) {
  uint mean = late_source_index(altitude, zenith, 0u, sun);
  uint ratio = late_source_index(altitude, zenith, 1u, sun);
  return FirstTerms(mix(CHANNELS(late_terms[mean]), CHANNELS(late_terms[mean + 1u]), part),
                    mix(CHANNELS(late_terms[ratio]), CHANNELS(late_terms[ratio + 1u]), part));
}

FirstTerms mix_terms(FirstTerms a, FirstTerms b, float part) {
  return FirstTerms(mix(a.mean, b.mean, part), mix(a.ratio, b.ratio, part));
}

Spectrum term_at(uint m, uint altitude, uint zenith, uint sun) {
  return CHANNELS(late_terms[late_source_index(altitude, zenith, m, sun)]);
}

void main() {
  SunAxis suns = sun_axis(medium);
  float mu_s = gather_sun(medium, gl_GlobalInvocationID.x);
  float R = medium.planet_radius_m;
  Spectrum albedo = GROUND_ALBEDO(medium);
  uint modes = late_modes(shape, push.order - 1u);
  uint sun = gl_GlobalInvocationID.x;
  uint zenith = gl_GlobalInvocationID.y;
  uint altitude = gl_GlobalInvocationID.z + push.first;
  if (sun >= kGatherSuns || zenith >= kGatherZeniths || altitude >= kGatherAltitudes) return;
  uint ray = altitude * kGatherZeniths + zenith;
  vec4 start = rays[ray].start;
  vec4 end = rays[ray].end;
  uint count = uint(start.w);
  float q0 = (R + start.x) * mu_s;
  float mu = start.y;
  float spread = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0));
  Spectrum radiance[kLateAzimuths] = Spectrum[kLateAzimuths](Spectrum(0.0), Spectrum(0.0));
  Spectrum terms[kLateTerms];
  for (uint m = 0u; m < kLateTerms; ++m) terms[m] = Spectrum(0.0);
  for (uint i = 0u; i < count; ++i) {
    RayNode node = rays[ray].high_nodes[i];
    uint a = min(uint(node.place.x), kGatherAltitudes - 2u);
    float a_part = node.place.x - float(a);
    uint z = min(uint(node.place.y), kSourceZeniths - 2u);
    float z_part = node.place.y - float(z);
    for (uint k = 0u; k < kLateAzimuths; ++k) {
      float nu = mu * mu_s + spread * kCosine[k];
      float sun_here = clamp((q0 + node.path.a * nu) / node.place.w, -1.0, 1.0);
      float s_index = gather_sun_index(suns, sun_here);
      uint s = min(uint(s_index), kGatherSuns - 2u);
      float part = s_index - float(s);
      FirstTerms low = mix_terms(between_suns(a, z, s, part), between_suns(a, z + 1u, s, part), z_part);
      FirstTerms high = mix_terms(between_suns(a + 1u, z, s, part), between_suns(a + 1u, z + 1u, s, part), z_part);
      FirstTerms here = mix_terms(low, high, a_part);
      float cosine = clamp(cos_azimuth(node.place.z, sun_here, nu), -1.0, 1.0);
      radiance[k] +=
          HIGH_PATH(rays[ray], node, i) * value_from_texel(here.mean) * max(1.0 + here.ratio * cosine, Spectrum(0.0));
    }
    for (uint m = kLateModes; m < modes; ++m) {
      Spectrum low = mix(term_at(m, a, z, sun), term_at(m, a, z + 1u, sun), z_part);
      Spectrum high = mix(term_at(m, a + 1u, z, sun), term_at(m, a + 1u, z + 1u, sun), z_part);
      terms[m] += HIGH_PATH(rays[ray], node, i) * mix(low, high, a_part);
    }
  }
  if (zenith < kGatherZeniths / 2u) {
    for (uint k = 0u; k < kLateAzimuths; ++k) {
      float nu = mu * mu_s + spread * kCosine[k];
      float index = gather_sun_index(suns, (q0 + end.a * nu) / (R + gather_ground(start.x)));
      uint s = min(uint(index), kGatherSuns - 2u);
      uint row = irradiance_row(push.order - 2u, gather_ground_row(altitude) + s);
      Spectrum light = mix(CHANNELS(irradiance[row]), CHANNELS(irradiance[row + 1u]), index - float(s));
      radiance[k] += RAY_END(rays[ray], end) * light * (albedo / kPi);
    }
  }
  terms[0] = 0.5 * (radiance[0] + radiance[1]);
  terms[1] = (radiance[0] - radiance[1]) / (kCosine[0] - kCosine[1]);
  for (uint m = 0u; m < modes; ++m) incident[late_incident_index(altitude, zenith, m, sun)] = STORED(terms[m], 0.0);
}
