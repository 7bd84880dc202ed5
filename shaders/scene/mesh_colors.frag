// The transmittance of glass, multiplied into a colour map. Alpha stores the smallest depth.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/mesh_push.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in float handed;
layout(location = 0) out vec4 left;

layout(binding = 3) uniform sampler2D base_color;

void main() {
  // Only the sunward side of a closed body is drawn. (The maps are mirrored because v points up.)
  bool front = gl_FrontFacing != (handed > 0.0);
  if (!front && push.double_sided == 0u) discard;
  vec4 base = texture(base_color, uv) * push.color * vertex_color;
  if (base.a < push.alpha_cutoff) discard;
  left = vec4(passing(base), gl_FragCoord.z);
}
