// The copy baseline: reads depth and colour and writes colour, the least that a full-screen effect can cost. `bench`
// times it in the same run as the effect.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D scene_color;
layout(binding = 1) uniform sampler2D scene_depth;
layout(binding = 2, rgba32f) uniform writeonly image2D output_color;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(output_color);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  float depth = texelFetch(scene_depth, pixel, 0).r;
  imageStore(output_color, pixel, texelFetch(scene_color, pixel, 0) * (depth >= 0.0 ? 1.0 : 0.0));
}
