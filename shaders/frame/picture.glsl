// Access to the caller's images. A frame covers a rectangle of each image. Pixels are counted from the rectangle's
// upper left corner. Include after declaring `frame` and the images that the shader uses. These are macros so that a
// shader need not declare images that it does not use.
#ifndef TYNDALL_PICTURE_GLSL
#define TYNDALL_PICTURE_GLSL

#define LOAD_COLOR(pixel) texelFetch(scene_color, (pixel) + frame.color_offset, 0).rgb
#define LOAD_DEPTH(pixel) texelFetch(scene_depth, (pixel) + frame.depth_offset, 0).r
#define STORE_COLOR(pixel, color) imageStore(output_color, (pixel) + frame.output_offset, vec4(color, 1.0))

// Gathers the depths of the 2 x 2 pixels whose upper left one is `corner`, in the order of textureGather: lower left,
// lower right, upper right, upper left. Outside the image its border pixels are repeated. Outside the rectangle but
// inside the image, the image's own depths are returned.
#define GATHER_DEPTH(corner) \
  textureGather(scene_depth, (vec2((corner) + frame.depth_offset) + 1.0) / vec2(textureSize(scene_depth, 0)))

#endif
