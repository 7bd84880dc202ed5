// Copies the scene's colour: scattering.enabled = false.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/frame_constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D scene_color;
layout(binding = 1, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 2) readonly buffer frame_block { FrameConstants frame; };

#include "frame/picture.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  STORE_COLOR(pixel, LOAD_COLOR(pixel));
}
