// The caller's images. A frame covers a rectangle of each; pixels are counted from its upper left corner, whatever the
// image's size. Include after declaring frame and those of scene_color, scene_depth and output_color that the shader
// uses: these are macros so that none has to be declared without a use.
#ifndef TYNDALL_PICTURE_GLSL
#define TYNDALL_PICTURE_GLSL

#define LOAD_COLOR(pixel) texelFetch(scene_color, (pixel) + frame.color_offset, 0).rgb
#define LOAD_DEPTH(pixel) texelFetch(scene_depth, (pixel) + frame.depth_offset, 0).r
#define STORE_COLOR(pixel, color) imageStore(output_color, (pixel) + frame.output_offset, vec4(color, 1.0))

// Depths of the square of 2 x 2 pixels whose upper left one is `corner`, in the order of textureGather: lower left,
// lower right, upper right, upper left. Where the square reaches beyond the image, its outermost pixels are repeated;
// beyond the rectangle it holds what lies there in the image.
#define GATHER_DEPTH(corner) \
  textureGather(scene_depth, (vec2((corner) + frame.depth_offset) + 1.0) / vec2(textureSize(scene_depth, 0)))

#endif
