// The push constants for drawing one part of a mesh: the view and the part's material.
#ifndef TYNDALL_MESH_PUSH_GLSL
#define TYNDALL_MESH_PUSH_GLSL

layout(push_constant) uniform Push {
  mat4 clip_from_local;
  vec4 color;
  float alpha_cutoff;
  float transmission;
  uint kind;  // a SurfaceKind
  uint double_sided;
}
push;

const uint kOpaque = 0u;
const uint kMask = 1u;
const uint kBlend = 2u;
const uint kGlass = 3u;

// Returns the transmittance of the surface for a base colour.
vec3 passing(vec4 base) {
  if (push.kind == kGlass) return base.rgb * push.transmission;
  if (push.kind == kBlend) return (1.0 - base.a) * mix(vec3(1.0), base.rgb, base.a);
  return vec3(0.0);
}

#endif
