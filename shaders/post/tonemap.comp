// Applies exposure and tone mapping with one read and one write per pixel. In: linear radiance. Out: linear display
// values in [0; 1].
#version 460
#extension GL_GOOGLE_include_directive : require

#include "post/constant_ids.h"
#include "post/tonemap_curves.glsl"
#include "shared/exposure.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kOperatorId) const uint kOperator = 3u;

layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(binding = 1, rgba32f) uniform writeonly image2D display;
layout(std430, binding = 2) readonly buffer ExposureBlock { ExposureState state; }
exposure_block;

layout(push_constant) uniform Push {
  float exposure;
  uint auto_exposure;
  float white_point;
  float saturation;
}
push;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(display);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  float exposure = push.auto_exposure != 0u ? exposure_block.state.exposure : push.exposure;
  vec3 scaled = tonemap_scaled(imageLoad(radiance, pixel).rgb, exposure);
  vec3 mapped = tonemap_apply(kOperator, scaled, push.white_point, push.saturation);
  imageStore(display, pixel, vec4(clamp(mapped, 0.0, 1.0), 1.0));
}
