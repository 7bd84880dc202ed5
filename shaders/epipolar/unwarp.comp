// From slices to the picture: every pixel between four samples, two on each of two slices, weighted by nearness
// in the picture and in depth (Yusov 2013, section 1.7), and put over the background. The last and only pass over
// all pixels. What is interpolated is the source and the optical depth per metre; the pixel's own depth makes
// light of them, so that a sample of another depth is a fair substitute where there is none of the pixel's own.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"
#include "lib/optical_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kExtinction = 0u;  // 0 epipolar, 1 per pixel
layout(constant_id = 1) const bool kBreaks = false;   // list the pixels that no sample fits

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer sample_block { uvec4 samples[]; };
layout(binding = 5) uniform sampler2D scene_color;
layout(binding = 6) uniform sampler2D scene_depth;
layout(binding = 7, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 8) buffer break_list_block { WorkList breaks; uint break_list[]; };

#include "epipolar/ray_end.glsl"
#include "epipolar/slices.glsl"

// Below this sum of weights no sample is near in depth; the weights then still choose the nearest.
const float kLeastWeight = 1e-2;

struct Blend {
  float weight;
  vec3 source;
  vec3 log_density;
};

void blend(inout Blend b, uvec4 packed, float depth_m, float weight) {
  Sample s = unpack_sample(packed);
  float apart = abs(s.depth_m - depth_m) / max(max(s.depth_m, depth_m), 1.0);
  float nearness = epipolar.threshold / max(apart, epipolar.threshold);
  nearness *= nearness;
  // The last term keeps the sum above zero, whatever the samples.
  float w = weight * nearness * nearness + 1e-9;
  b.weight += w;
  b.source += w * s.source;
  b.log_density += w * s.log_density;
}

void blend_slice(inout Blend b, uint id, vec2 position, float depth_m, float weight) {
  EpipolarSlice slice = slices[id];
  vec2 offset = position - vec2(slice.entry_x, slice.entry_y);
  float along = dot(offset, vec2(slice.direction_x, slice.direction_y)) / slice.length_px;
  float place = clamp(along * float(epipolar.samples - 1u), 0.0, float(slice.last));
  uint i = min(uint(place), slice.last - 1u);
  float part = place - float(i);
  uint at = id * epipolar.samples + i;
  blend(b, samples[at], depth_m, weight * (1.0 - part));
  blend(b, samples[at + 1u], depth_m, weight * part);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  vec2 position = vec2(pixel) + 0.5;
  float depth = texelFetch(scene_depth, pixel, 0).r;
  bool sky = depth == frame.sky_depth;
  float visible_m = view_depth(frame, position, depth);
  float depth_m = sky ? sky_depth_m(ray_direction(frame, position)) : visible_m;

  float place = slice_coordinate(position);
  uint lower = uint(place);
  float part = place - float(lower);
  uint upper = lower + 1u;
  if (epipolar.closed != 0u) {
    lower = lower >= epipolar.slices ? lower - epipolar.slices : lower;
    upper = upper >= epipolar.slices ? upper - epipolar.slices : upper;
  } else {
    lower = min(lower, epipolar.slices - 1u);
    upper = min(upper, epipolar.slices - 1u);
  }
  Blend b = Blend(0.0, vec3(0.0), vec3(0.0));
  blend_slice(b, lower, position, depth_m, 1.0 - part);
  blend_slice(b, upper, position, depth_m, part);

  vec3 tau;
  if (kExtinction == 0u) {
    tau = optical_depth_at(b.log_density / b.weight, depth_m);
  } else {
    Ray ray = ray_to_depth(frame, position, visible_m, sky);
    float start, end;
    tau = vec3(0.0);
    if (clip_to_air(medium, ray, start, end)) {
      float from_altitude = altitude_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
      float from_cosine = cos_zenith_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
      tau = optical_depth(medium, column_along(medium, from_altitude, from_cosine, end - start));
    }
  }
  vec3 through, lost;
  attenuation(tau, through, lost);
  vec3 color = b.source * (lost / b.weight) * frame.sun_irradiance;
  if (frame.only == 0u) color += texelFetch(scene_color, pixel, 0).rgb * through;
  imageStore(output_color, pixel, vec4(color, 1.0));
  if (kBreaks && b.weight < kLeastWeight) {
    uint at = atomicAdd(breaks.count, 1u);
    break_list[at] = uint(pixel.y) << 16u | uint(pixel.x);
    atomicMax(breaks.groups_x, at / kMarchGroup + 1u);
  }
}
