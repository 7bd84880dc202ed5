// scattering.enabled = false: the output is the background.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D scene_color;
layout(binding = 1, OUTPUT_FORMAT) uniform writeonly image2D output_color;

layout(push_constant) uniform Push { uvec2 extent; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(extent.x) || pixel.y >= int(extent.y)) return;
  imageStore(output_color, pixel, vec4(texelFetch(scene_color, pixel, 0).rgb, 1.0));
}
