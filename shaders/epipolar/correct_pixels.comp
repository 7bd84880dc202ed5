// Composes the marched in-scattering of listed pixels with their background, or marks these pixels.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "epipolar/constants.glsl"
#include "epipolar/ray_end.glsl"
#include "epipolar/work_list.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"
#include "lib/optical_depth.glsl"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 16) readonly buffer work_block {
  WorkList work;
  uint items[];
};
layout(std430, binding = 17) readonly buffer corrected_inscattering_block { uvec2 corrected[]; };

void put_pixel(uint at) {
  ivec2 pixel = ivec2(items[at] & 0xFFFFu, items[at] >> 16u);
  Ray ray = view_ray(frame, pixel, load_depth(pixel));
  float start, end;
  Spectrum transmitted = Spectrum(1.0);
  Spectrum opacity;
  Spectrum light = unpack_light(corrected[at]);
#ifdef SPECTRAL
  if (kHomogeneous) light *= homogeneous_phase(ray.cos_view_sun);
#endif
  vec3 color = COLOR(light) * frame.sun_irradiance;
  if (clip_to_medium(ray, start, end)) {
    if (kHomogeneous)
      homogeneous_attenuation(end - start, transmitted, opacity);
    else
      transmitted = transmittance(medium, density_integral_along(medium, ray.altitude, ray.cos_zenith, end));
  }
#ifndef SPECTRAL
  if (kHomogeneous) color *= homogeneous_phase(ray.cos_view_sun);
#endif
  if (frame.only == 0u) color += TRANSMITTED(load_color(pixel), transmitted);
  // The mark is green and as bright as a white surface in sunlight, so that it is visible on any background.
  if (epipolar.show_depth_breaks != 0u) color = vec3(0.0, dot(frame.sun_irradiance, vec3(0.1)), 0.0);
  store_color(pixel, color);
}

void main() {
  uint at = list_item(kMarchGroup);
  bool overflown = work.count > epipolar.correction_capacity;  // correction_list.glsl
  if (at < work.count && !overflown) put_pixel(at);
}
