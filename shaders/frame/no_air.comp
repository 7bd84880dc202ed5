// Copies the scene's colour: scattering.enabled = false.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "frame/output.glsl"
#include "frame/picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  store_color(pixel, load_color(pixel));
}
