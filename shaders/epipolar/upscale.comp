// scattering.downscale: from the reduced picture to the whole one, and over its background (Yusov 2012, section 6.8). A
// pixel lies between four reduced ones, which are weighted bilinearly and by nearness in depth; those that none of the
// four fits are listed. An invocation does all pixels between the same four.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 64) in;  // along rows, as images lie in memory

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer sample_block { uvec4 samples[]; };
layout(std430, binding = 5) readonly buffer reduced_block { uvec4 reduced[]; };
layout(binding = 6) uniform sampler2D scene_color;
layout(binding = 7) uniform sampler2D scene_depth;
layout(binding = 8, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 9) buffer broken_list_block { WorkList broken; uint broken_list[]; };

layout(constant_id = 6) const int kDownscale = 2;

#include "epipolar/unwarp.glsl"
#include "epipolar/work_list.glsl"
#include "epipolar/reduced.glsl"

// Below this sum of weights a pixel goes back to the slices.
const float kLeastUpscaled = 0.1;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  ivec2 most = ivec2(epipolar.reduced_width, epipolar.reduced_height) - 1;
  if (cell.x > most.x + 1 || cell.y > most.y + 1) return;
  vec3 source[4];
  vec3 density[4];
  float depth_m[4];
  for (int k = 0; k < 4; ++k) {
    ivec2 at = clamp(cell - 1 + ivec2(k & 1, k >> 1), ivec2(0), most);
    Sample s = unpack_sample(reduced[reduced_index(uvec2(at))]);
    source[k] = s.source;
    density[k] = s.density;
    depth_m[k] = s.depth_m;
  }
  uint missed = 0u;  // a bit for each pixel
  float horizon = horizon_cos(frame.camera_altitude_m, medium.planet_radius_m);
  for (int i = 0; i < kDownscale * kDownscale; ++i) {
    ivec2 within = ivec2(i % kDownscale, i / kDownscale);
    ivec2 pixel = cell * kDownscale - kDownscale / 2 + within;
    bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < int(frame.width) && pixel.y < int(frame.height);
    vec2 position = vec2(pixel) + 0.5;
    float depth = texelFetch(scene_depth, pixel, 0).r;
    bool sky = depth == frame.sky_depth;
    float visible_m = view_depth(frame, position, depth);
    vec3 direction = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
    // The planet where nothing was drawn has a depth that takes a while to find.
    bool planet = sky && dot(direction, frame.camera_up) < horizon * length(direction);
    float own_m = sky ? kSkyDepth : visible_m;
    vec2 part = vec2(within) / float(kDownscale);
    vec4 bilinear = vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
    vec4 w;
    for (int k = 0; k < 4; ++k) w[k] = bilinear[k] * depth_nearness(depth_m[k], own_m);
    float sum = w.x + w.y + w.z + w.w;
    bool misses = planet || sum < kLeastUpscaled;
    missed |= inside && misses ? 1u << uint(i) : 0u;
    w /= max(sum, 1e-9);
    Blend b;
    b.weight = sum;
    b.source = w.x * source[0] + w.y * source[1] + w.z * source[2] + w.w * source[3];
    b.density = w.x * density[0] + w.y * density[1] + w.z * density[2] + w.w * density[3];
    vec3 background = texelFetch(scene_color, pixel, 0).rgb;
    vec3 color = compose(b, position, own_m, visible_m, sky, background);
    if (inside && !misses) imageStore(output_color, pixel, vec4(color, 1.0));
  }
  if (missed == 0u) return;
  uint slot = atomicAdd(broken.count, uint(bitCount(missed)));
  for (; missed != 0u; missed &= missed - 1u) {
    int i = findLSB(missed);
    ivec2 pixel = cell * kDownscale - kDownscale / 2 + ivec2(i % kDownscale, i / kDownscale);
    broken_list[slot++] = uint(pixel.y) << 16u | uint(pixel.x);
  }
  uint groups = (slot + kMarchGroup - 1u) / kMarchGroup;
  atomicMax(broken.groups_x, groups_along_x(groups));
  atomicMax(broken.groups_y, groups_along_y(groups));
}
