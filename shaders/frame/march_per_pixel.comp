// The brute-force technique: marches every pixel's ray and tests the shadow at every texel, in all modes of
// scattering.single and scattering.multiple. It is the reference that faster techniques are compared with.
// In: colour and depth of the scene, shadow cascades. Out: radiance seen through the medium, in units of the sun's
// irradiance per steradian.
// The shadow map is read once per texel that the ray crosses, so that no shadow boundary is missed. Beyond the last
// cascade the ray is integrated without shadows (Yusov 2013, section 1.6, without the epipolar geometry).
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#define RAY_SECTIONS 0u
#define MIN_READS frame.integration_steps

#include "frame/march_ray.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { uint first_row; }
push;  // first row of the picture of this dispatch

// Returns the single scattering over [start, end] of the ray. With kCloudFraction, also computes the fraction of it
// that remains behind clouds and glass.
Spectrum integrated_light(Ray ray, float start, float end, out Spectrum fraction) {
  March march = nothing_marched();
  float t = start;
  // View-space depth is proportional to the distance along the ray.
  float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
  float last = frame.cascade_count > 0u ? cascades[frame.cascade_count - 1u].far_m / depth_per_m : 0.0;
  float steps_per_m = float(frame.integration_steps) / max(min(last, end) - start, 1.0);
  for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
    float to = min(cascades[c].far_m / depth_per_m, end);
    if (to - t > 1e-3) {
      march_cascade(c, ray, t, to, steps_per_m, march);
      t = to;
    }
  }
  Spectrum light = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun) * march.rayleigh +
                   mie_scattering_towards(medium, ray.cos_view_sun) * march.mie;
  fraction = Spectrum(1.0);
  if (kClouds) {
    Spectrum plain = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun) * march.plain_rayleigh +
                     mie_scattering_towards(medium, ray.cos_view_sun) * march.plain_mie;
    if (end - t > 1e-3) add_clouded(ray, t, end, kCloudSteps, light, plain);
    fraction = cloud_fraction(light, plain);
  } else if (end - t > 1e-3) {
    light += single_scattering(medium, ray.altitude, ray.cos_zenith, ray.cos_sun_zenith, ray.cos_view_sun, t, end,
                               int(frame.integration_steps) / 3);
  }
  return light;
}

// Returns the in-scattering from the tables over [start, end], shadowed as far as the maps reach.
Spectrum shadowed_table_light(Ray ray, float start, float end) {
  TableRay path = table_ray_of(ray, start);
  LitSections lit = nothing_lit();
  float t = start;
  if (kLitTables) {
    float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
    lit.dark_until = planet_shadow_end(ray, start);
    for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
      float to = min(cascades[c].far_m / depth_per_m, end);
      float from = max(t, lit.dark_until);
      if (to - from > 1e-3) walk_cascade(c, ray, path, start, from, to, lit);
      if (to - t > 1e-3) t = to;
    }
    if (end - t <= 1e-3) t = end;  // a remainder too short for a cascade is not beyond the last one
  }
  return table_light(lit, path, start, t, end);
}

// Returns the in-scattering of a homogeneous medium over the lit parts of [start, end], in closed form.
Spectrum homogeneous_light(Ray ray, float start, float end) {
  Spectrum light = Spectrum(0.0);
  Spectrum before = Spectrum(1.0);
  Spectrum transmittance, opacity;
  float t = start;
  float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
  for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
    float to = min(cascades[c].far_m / depth_per_m, end);
    if (to - t <= 1e-3) continue;
    march_homogeneous(c, ray, t, to, light, before);
    t = to;
  }
  if (end - t <= 1e-3) return light * homogeneous_phase(ray.cos_view_sun);  // remainder too short for a cascade
  if (kClouds) {
    add_clouded_homogeneous(ray.direction, t, end, kCloudSteps, light, before);
    return light * homogeneous_phase(ray.cos_view_sun);
  }
  homogeneous_attenuation(end - t, transmittance, opacity);
  return (light + before * opacity) * homogeneous_phase(ray.cos_view_sun);
}

// Returns the in-scattering over [start, end] in the selected modes.
Spectrum inscattering(Ray ray, float start, float end) {
  Spectrum light = Spectrum(0.0);
  if (kHomogeneous) return kSingle == kNone ? light : homogeneous_light(ray, start, end);
  Spectrum fraction = Spectrum(1.0);
  if (kSingle == kIntegration || kCloudFraction) {
    Spectrum single = integrated_light(ray, start, end, fraction);
    if (kSingle == kIntegration) light += single;
  }
  if (kLitTables || frame.unoccluded != 0u) {
    Spectrum high = shadowed_table_light(ray, start, end);
    light += kCloudFraction ? fraction * high : high;
  }
  return light;
}

void main() {
  load_medium();
  load_frame();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, int(push.first_row));
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  vec3 background = load_color(pixel);
  float depth = load_depth(pixel);
  Ray ray = view_ray(frame, pixel, depth);
  float start, end;
  Spectrum inscattered = Spectrum(0.0);
  Spectrum path_transmittance = Spectrum(1.0);
  if (clip_to_medium(ray, start, end)) {
    inscattered = inscattering(ray, start, end);
    Spectrum opacity;
    if (kHomogeneous) homogeneous_attenuation(end - start, path_transmittance, opacity);
    float from_altitude = altitude_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
    float from_cosine = cos_zenith_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
    if (!kHomogeneous)
      path_transmittance =
          transmittance(medium, density_integral_along(medium, from_altitude, from_cosine, end - start));
  }
  vec3 color = COLOR(inscattered) * frame.sun_irradiance;
  if (frame.only == 0u) color += TRANSMITTED(background, path_transmittance);
  store_color(pixel, color);
  count(kSamplesMarched, 1u);
  count(kMarchSteps, steps_done);
  count(kShadowFetches, reads_done);
}
