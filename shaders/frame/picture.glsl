// The caller's images. A frame covers a rectangle of each image. Pixels are counted from the rectangle's upper left
// corner.
#ifndef TYNDALL_PICTURE_GLSL
#define TYNDALL_PICTURE_GLSL

#include "frame/constants.glsl"
#include "lib/half.glsl"

layout(binding = 3) uniform sampler2D scene_color;
layout(binding = 4) uniform sampler2D scene_depth;

// Returns the colour of a pixel. A sun's disc may exceed the range of half floats and be stored as infinite. It then
// has the largest of them, because infinity minus infinity, or times 0, would make the pixel black.
vec3 load_color(ivec2 pixel) {
  const float kInfinite = 1e30;
  vec3 color = texelFetch(scene_color, pixel + frame.color_offset, 0).rgb;
  return mix(color, vec3(kLargestHalf), greaterThan(color, vec3(kInfinite)));
}
float load_depth(ivec2 pixel) { return texelFetch(scene_depth, pixel + frame.depth_offset, 0).r; }

// Gathers the depths of the 2 x 2 pixels whose upper left one is `corner`, in the order of textureGather: lower left,
// lower right, upper right, upper left. Outside the image its border pixels are repeated. Outside the rectangle but
// inside the image, the image's own depths are returned.
vec4 gather_depth(ivec2 corner) {
  return textureGather(scene_depth, (vec2(corner + frame.depth_offset) + 1.0) / vec2(textureSize(scene_depth, 0)));
}

#endif
