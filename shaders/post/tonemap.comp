// Exposure and tone mapping, one read and one write per pixel.
// In: linear radiance. Out: linear display values, 0 to 1.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "post/tonemap_curves.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(binding = 1, rgba32f) uniform writeonly image2D display;

layout(push_constant) uniform Push {
  uint operator_index;
  float exposure;
  float white_point;
} push;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(display);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec3 scaled = max(imageLoad(radiance, pixel).rgb, vec3(0.0)) * push.exposure;
  vec3 mapped = push.operator_index == 0u ? tonemap_exponential(scaled) : tonemap_uncharted2(scaled, push.white_point);
  imageStore(display, pixel, vec4(clamp(mapped, 0.0, 1.0), 1.0));
}
