// The technique `froxels`: looks up every pixel in the froxel volume. Beyond the volume, in-scattering is added without
// shadows.
// In: colour and depth of the scene, the froxel volume. Out: radiance seen through the medium.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#include "frame/constants.glsl"
#include "frame/homogeneous_medium.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"
#include "frame/table_light.glsl"
#include "frame/view_ray.glsl"
#include "lib/froxels.glsl"
#include "lib/single_scattering.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 13) uniform sampler3D froxel_inscattering;
layout(binding = 14) uniform sampler3D froxel_transmittance;

// Returns the in-scattering between two distances of the ray, without shadows.
Spectrum light_beyond(Ray ray, float start, float from, float to) {
  Spectrum light = Spectrum(0.0);
  if (kHomogeneous) {
    Spectrum before, after, opacity;
    homogeneous_attenuation(from - start, before, opacity);
    homogeneous_attenuation(to - from, after, opacity);
    return kSingle == kNone ? light : before * opacity * homogeneous_phase(ray.cos_view_sun);
  }
  if (kSingle == kIntegration) {
    light += single_scattering(medium, ray.altitude, ray.cos_zenith, ray.cos_sun_zenith, ray.cos_view_sun, from, to,
                               int(frame.integration_steps) / 3);
  }
  if (!kLitTables && frame.unoccluded == 0u) return light;
  TableRay path = table_ray_of(ray, start);
  LitSections lit = nothing_lit();
  lit.dark_until = planet_shadow_end(ray, start);
  float lit_from = section_from(lit, from, start);
  for (int part = 0; part < 2; ++part) {
    // Part 0 is shadowed by the planet, part 1 is not.
    if (part == 0 ? !kLitTables : frame.unoccluded == 0u) continue;
    InScattering section = section_light(path, start, part == 0 ? lit_from : from, to);
    if (kSingle != kTable) section.high *= deep_factor(medium, path);
    if (part == 0 && kSingle == kTable) light += section.single;
    if (part == 0 ? kOccluded : true) light += section.high;
  }
  return light;
}

void main() {
  load_medium();
  load_frame();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  vec3 background = load_color(pixel);
  Ray ray = view_ray(frame, pixel, load_depth(pixel));
  float start, end;
  if (!clip_to_medium(ray, start, end)) {
    store_color(pixel, frame.only == 0u ? background : vec3(0.0));
    return;
  }
  vec2 uv = (vec2(pixel) + 0.5) / vec2(float(frame.width), float(frame.height));
  float w = froxel_coordinate(end, frame.froxel_near_m, frame.froxel_far_m, float(frame.froxel_slices));
  vec3 light = textureLod(froxel_inscattering, vec3(uv, w), 0.0).rgb;
  vec3 behind = TRANSMITTED(background, CHANNELS(textureLod(froxel_transmittance, vec3(uv, w), 0.0)));
  if (end > frame.froxel_far_m) {
    light += COLOR(light_beyond(ray, start, max(frame.froxel_far_m, start), end));
    Spectrum through, opacity;
    if (kHomogeneous) {
      homogeneous_attenuation(end - start, through, opacity);
    } else {
      float altitude = altitude_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
      float cosine = cos_zenith_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
      through = transmittance(medium, density_integral_along(medium, altitude, cosine, end - start));
    }
    behind = TRANSMITTED(background, through);
  }
  vec3 color = light * frame.sun_irradiance;
  if (frame.only == 0u) color += behind;
  store_color(pixel, color);
}
