// The pass for transparent surfaces of glass.cpp: a pane of glass that fills the picture, at one depth. It is drawn
// after Effect::record, over what is seen through the atmosphere, so only the pane itself gets haze: that between it
// and the camera.
#version 450
#extension GL_GOOGLE_include_directive : require

#define TYNDALL_FIRST_BINDING 1
#include "tyndall/atmosphere.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform image2D picture;
layout(push_constant) uniform Push {
  vec3 radiance;  // that leaves the pane
  float opacity;
  vec2 tan_half;  // of the field of view
  float depth_m;  // in view space
};

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(picture)))) return;
  vec2 uv = (vec2(pixel) + 0.5) / vec2(imageSize(picture));
  float distance_m = depth_m * length(vec3((2.0 * uv - 1.0) * tan_half, 1.0));
  vec3 pane = tyndall_apply(tyndall_froxel(uv, distance_m), radiance);
  vec3 behind = imageLoad(picture, pixel).rgb;
  imageStore(picture, pixel, vec4(mix(behind, pane, opacity), 1.0));
}
