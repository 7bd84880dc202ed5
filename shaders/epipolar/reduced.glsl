// The reduced picture of scattering.downscale. Include after declaring frame and epipolar.
#ifndef TYNDALL_REDUCED_GLSL
#define TYNDALL_REDUCED_GLSL

// The picture's pixel that a reduced one stands for: the middle of its block of downscale x downscale, or what is left
// of that at the right and lower border.
ivec2 pixel_of_reduced(uvec2 at) {
  return min(ivec2(at * epipolar.downscale + epipolar.downscale / 2u), ivec2(frame.width, frame.height) - 1);
}

uint reduced_index(uvec2 at) { return at.y * epipolar.reduced_width + at.x; }

#endif
