// Stores the marched in-scattering of listed pixels of the half- or quarter-resolution buffer (Yusov 2012, section
// 6.7).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"
#include "lib/optical_depth.glsl"
#include "epipolar/work_list.glsl"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer work_block {
  WorkList work;
  uint items[];
};
layout(std430, binding = 4) readonly buffer corrected_inscattering_block { uvec2 corrected[]; };
layout(std430, binding = 5) buffer downscaled_inscattering_block { vec4 downscaled[]; };
layout(binding = 6) uniform sampler2D scene_depth;

#include "epipolar/records.glsl"
#include "epipolar/downscaled.glsl"
#include "frame/homogeneous_medium.glsl"
#include "frame/picture.glsl"

void put_pixel(uint at) {
  ivec2 pixel = ivec2(items[at] & 0xFFFFu, items[at] >> 16u);
  Ray ray = view_ray(frame, pixel, LOAD_DEPTH(pixel));
  float start, end;
  vec3 transmittance, opacity;
  vec3 tau = vec3(0.0);
  bool inside = clip_to_medium(ray, start, end);
  if (kHomogeneous)
    tau = frame.homogeneous.extinction * (end - start);
  else if (inside)
    tau = optical_depth(medium, density_integral_along(medium, ray.altitude, ray.cos_zenith, end));
  attenuation(tau, transmittance, opacity);
  ivec2 place = pixel / kDownscale;
  Sample s;
  s.depth_m = downscaled[downscaled_index(place)].a;
  s.extinction = extinction_of(tau, s.depth_m);
  s.source = unpack_light(corrected[at]) / max(opacity, vec3(1e-20));
  if (kHomogeneous && !inside) s.source = vec3(1.0);
  STORE_DOWNSCALED(place, s.depth_m, s);
}

void main() {
  uint at = list_item(kMarchGroup);
  bool overflown = work.count > epipolar.correction_capacity;  // correction_list.glsl
  if (at < work.count && !overflown) put_pixel(at);
}
