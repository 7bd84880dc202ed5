// Stores the marched in-scattering of listed pixels of the half- or quarter-resolution buffer (Yusov 2012, section
// 6.7).
#version 460
#extension GL_GOOGLE_include_directive : require

#define READ_DOWNSCALED

#include "epipolar/downscaled.glsl"
#include "epipolar/records.glsl"
#include "epipolar/store_downscaled.glsl"
#include "epipolar/work_list.glsl"
#include "frame/homogeneous_medium.glsl"
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
  Spectrum transmittance, opacity;
  Spectrum tau = Spectrum(0.0);
  bool inside = clip_to_medium(ray, start, end);
  if (kHomogeneous)
    tau = HOMOGENEOUS_EXTINCTION * (end - start);
  else if (inside)
    tau = optical_depth(medium, density_integral_along(medium, ray.altitude, ray.cos_zenith, end));
  attenuation(tau, transmittance, opacity);
  ivec2 place = pixel / kDownscale;
  Sample s;
  s.depth_m = downscaled[downscaled_index(place)].a;
  s.extinction = extinction_of(tau, s.depth_m);
  s.source = unpack_light(corrected[at]) / max(opacity, Spectrum(1e-20));
  if (kHomogeneous && !inside) s.source = Spectrum(1.0);
  store_downscaled(place, s.depth_m, s.source, s.extinction);
}

void main() {
  uint at = list_item(kMarchGroup);
  bool overflown = work.count > epipolar.correction_capacity;  // correction_list.glsl
  if (at < work.count && !overflown) put_pixel(at);
}
