// Texels of a table as floats: what a test can compare. In: a table; out: 32 x 256 texels, row by row.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D table;
layout(std430, binding = 1) writeonly buffer texel_block { vec4 texels[]; };

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  // Tables with fewer texels repeat their last.
  texels[at.y * 32 + at.x] = texelFetch(table, min(at, textureSize(table, 0) - 1), 0);
}
