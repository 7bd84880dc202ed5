// Marks samples in the picture: marched ones by four bright red pixels, interpolated ones by one dark red pixel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "epipolar/slices.glsl"
#include "frame/output.glsl"

layout(local_size_x = 32, local_size_y = 2) in;

layout(std430, binding = 13) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 14) readonly buffer interpolation_sources_block { uint sources[]; };

layout(push_constant) uniform Push { uint marched; };  // 0: interpolated samples; 1, in a later pass: marched samples

void mark(ivec2 pixel, vec3 color) {
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  store_color(pixel, color * dot(frame.sun_irradiance, vec3(0.333)));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint id = gl_GlobalInvocationID.y;
  if (i >= epipolar.samples || id >= epipolar.slices || i > slices[id].last) return;
  uint source = sources[id * epipolar.samples + i];
  bool is_marched = (source & 0xFFFFu) == source >> 16u;
  if (is_marched != (marched != 0u)) return;
  ivec2 pixel = ivec2(floor(sample_position(slices[id], i)));
  if (!is_marched) {
    mark(pixel, vec3(0.02, 0.0, 0.0));
    return;
  }
  for (int k = 0; k < 4; ++k) mark(pixel + ivec2(k & 1, k >> 1), vec3(0.3, 0.0, 0.0));
}
