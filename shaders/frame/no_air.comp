// Copies the scene's colour: scattering.enabled = false.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D scene_color;
layout(binding = 1, OUTPUT_FORMAT) uniform writeonly image2D output_color;

layout(push_constant) uniform Push {
  uvec2 extent;
  ivec2 color_offset;
  ivec2 output_offset;
}
frame;

#include "frame/picture.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.extent.x) || pixel.y >= int(frame.extent.y)) return;
  STORE_COLOR(pixel, LOAD_COLOR(pixel));
}
