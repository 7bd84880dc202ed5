// The froxel volume: in-scattering and transmittance from the camera to points of the view, with light shafts, for
// transparent surfaces, particles and forward shading. Each invocation marches one column from near to far, in the
// modes and with the functions of march_per_pixel.comp, and stores what it has gathered at every texel. In: shadow
// cascades. Out: radiance in units of the sun's irradiance per steradian, and transmittance of red, green and blue, or
// at the four wavelengths.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS
#define RAY_SECTIONS frame.froxel_slices
#define MIN_READS 1.0

#include "frame/march_ray.glsl"
#include "lib/froxels.glsl"
#include "lib/half.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push {
  uint first_row;  // first row of columns of this dispatch
  uint without_medium;
}
push;
layout(binding = 13, rgba16f) uniform writeonly image3D froxel_inscattering;
layout(binding = 14, rgba16f) uniform writeonly image3D froxel_transmittance;

// The light that has been gathered along a column of froxels up to the distance `t`. Beyond the last cascade, t grows
// only in modes in which the light is a sum over sections.
struct Column {
  float t;
  March march;            // integration
  Spectrum beyond;        // integration: light from beyond the cascades
  Spectrum plain_beyond;  // kCloudFraction: the same without clouds
  LitSections lit;        // tables
  float lit_until;        // tables: the distance up to which `lit` is known
  Spectrum light;         // homogeneous medium, without its phase function
  Spectrum before;        // homogeneous medium: transmittance up to t
};

const float kCloudStepsOfSlice = 64.0;  // beyond the cascades

float depth_per_m(Ray ray) { return max(dot(ray.direction, frame.camera_forward), 1e-6); }

// With kCloudFraction, also computes the fraction of the light that remains behind clouds and glass.
Spectrum integrate_to(inout Column column, Ray ray, float start, float to, out Spectrum fraction) {
  float last = frame.cascade_count > 0u ? cascades[frame.cascade_count - 1u].far_m / depth_per_m(ray) : 0.0;
  float steps_per_m = float(frame.integration_steps) / max(min(last, frame.froxel_far_m) - start, 1.0);
  for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
    float end = min(cascades[c].far_m / depth_per_m(ray), to);
    if (end - column.t <= 1e-3) continue;
    march_cascade(c, ray, column.t, end, steps_per_m, column.march);
    column.t = end;
  }
  if (to - column.t > 1e-3) {
    if (kClouds) {
      add_clouded(ray, column.t, to, kCloudStepsOfSlice, column.beyond, column.plain_beyond);
    } else {
      column.beyond += single_scattering(medium, ray.altitude, ray.cos_zenith, ray.cos_sun_zenith, ray.cos_view_sun,
                                         column.t, to, int(frame.integration_steps) / 3);
    }
    column.t = to;
  }
  Spectrum light = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun) * column.march.rayleigh +
                   mie_scattering_towards(medium, ray.cos_view_sun) * column.march.mie + column.beyond;
  fraction = Spectrum(1.0);
  if (kCloudFraction) {
    Spectrum plain = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun) * column.march.plain_rayleigh +
                     mie_scattering_towards(medium, ray.cos_view_sun) * column.march.plain_mie + column.plain_beyond;
    fraction = cloud_fraction(light, plain);
  }
  return light;
}

Spectrum look_up_to(inout Column column, Ray ray, TableRay path, float start, float to) {
  if (kLitTables) {
    for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
      float end = min(cascades[c].far_m / depth_per_m(ray), to);
      float from = max(column.lit_until, column.lit.dark_until);
      if (end - from > 1e-3) walk_cascade(c, ray, path, start, from, end, column.lit);
      if (end - column.lit_until > 1e-3) column.lit_until = end;
    }
  }
  // A remainder too short for a cascade is not beyond the last one.
  float known = kLitTables && to - column.lit_until <= 1e-3 ? to : column.lit_until;
  return table_light(column.lit, path, start, known, to);
}

Spectrum homogeneous_to(inout Column column, Ray ray, float to) {
  for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
    float end = min(cascades[c].far_m / depth_per_m(ray), to);
    if (end - column.t <= 1e-3) continue;
    march_homogeneous(c, ray, column.t, end, column.light, column.before);
    column.t = end;
  }
  if (kClouds && to - column.t > 1e-3) {
    add_clouded_homogeneous(ray.direction, column.t, to, kCloudStepsOfSlice, column.light, column.before);
    column.t = to;
  }
  if (to - column.t > 1e-3) {
    Spectrum transmittance, opacity;
    homogeneous_attenuation(to - column.t, transmittance, opacity);
    column.light += column.before * opacity;
    column.before *= transmittance;
    column.t = to;
  }
  return column.light * homogeneous_phase(ray.cos_view_sun);
}

void main() {
  load_medium();
  load_frame();
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, int(push.first_row));
  if (at.x >= int(frame.froxel_columns) || at.y >= int(frame.froxel_rows)) return;
  vec2 uv = (vec2(at) + 0.5) / vec2(float(frame.froxel_columns), float(frame.froxel_rows));
  Ray ray = ray_to_depth(frame, uv * vec2(float(frame.width), float(frame.height)), 0.0, true);
  float start, end;
  bool inside = clip_to_medium(ray, start, end) && push.without_medium == 0u;
  float from_altitude = altitude_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
  float from_cosine = cos_zenith_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
  Column column = Column(start, nothing_marched(), Spectrum(0.0), Spectrum(0.0), nothing_lit(), start, Spectrum(0.0),
                         Spectrum(1.0));
  if (kLitTables) column.lit.dark_until = planet_shadow_end(ray, start);
  TableRay path = table_ray_of(ray, start);
  Spectrum light = Spectrum(0.0);
  Spectrum path_transmittance = Spectrum(1.0);
  float before = start;
  for (uint k = 0u; k < frame.froxel_slices; ++k) {
    float x = float(k) / float(frame.froxel_slices - 1u);
    float to = min(froxel_distance(x, frame.froxel_near_m, frame.froxel_far_m), end);
    if (inside && to > before) {
      before = to;
      light = Spectrum(0.0);
      if (kHomogeneous) {
        if (kSingle != kNone) light = homogeneous_to(column, ray, to);
        Spectrum opacity;
        homogeneous_attenuation(to - start, path_transmittance, opacity);
      } else {
        Spectrum fraction = Spectrum(1.0);
        if (kSingle == kIntegration || kCloudFraction) {
          Spectrum single = integrate_to(column, ray, start, to, fraction);
          if (kSingle == kIntegration) light += single;
        }
        if (kLitTables || frame.unoccluded != 0u) {
          Spectrum high = look_up_to(column, ray, path, start, to);
          light += kCloudFraction ? fraction * high : high;
        }
        path_transmittance =
            transmittance(medium, density_integral_along(medium, from_altitude, from_cosine, to - start));
      }
    }
    imageStore(froxel_inscattering, ivec3(at, int(k)), vec4(min(COLOR(light), vec3(kLargestHalf)), 1.0));
    imageStore(froxel_transmittance, ivec3(at, int(k)), STORED(path_transmittance, 1.0));
  }
}
