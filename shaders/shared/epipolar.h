// The structures shared by the passes of epipolar sampling. Compiled as GLSL (std430) and as C++
// (src/effect/shared.hpp). Positions in the picture are in pixels from its upper left corner; pixel centres are at +
// 0.5. The border is the rectangle through the centres of the outermost pixels. Its sides are 0 left (downwards), 1
// bottom (to the right), 2 right (upwards) and 3 top (to the left).
#ifndef TYNDALL_SHARED_EPIPOLAR
#define TYNDALL_SHARED_EPIPOLAR

struct EpipolarConstants {
  uint slices;
  uint samples;  // per slice
  uint initial_step;
  uint epipole_density;
  float threshold;
  uint optimize_locations;
  float min_weight;  // a pixel with a smaller sum of weights is marched separately
  uint show_depth_breaks;
  // The epipole is (sun_x, sun_y) / sun_w: the image of the sun or, if the sun is behind the camera, of the opposite
  // point. sun_w >= 0; it is 0 for a sun at a right angle to the view.
  float sun_x;
  float sun_y;
  float sun_w;
  uint sun_in_picture;
  float fallback_x;  // direction away from the epipole where it coincides with a position on the border
  float fallback_y;
  float perimeter;  // of the sides at which slices end [pixels]
  uint closed;      // 1: slices end at all four sides, and the last is next to the first
  // The start of each side along the perimeter; < 0: no slice ends there.
  float left_start;
  float bottom_start;
  float right_start;
  float top_start;
  uint first_cascade;  // marched
  uint cascades;       // index after the last marched one
  uint tree_cells;     // largest number per slice line, a multiple of kTreeBlock; 0: no trees
  uint tree_format;    // MinMaxFormat
  // The picture for which in-scattering is computed; `slices` and `samples` are for its size.
  uint downscale;
  uint downscaled_width;
  uint downscaled_height;
  uint correction_capacity;   // capacity of the list of pixels to be marched; a multiple of kMarchGroup
  float min_weight_sky;       // min_weight for pixels of the sky; larger in twilight, when the sky is much brighter
  float discontinuity_ratio;  // ratio of the depths of neighbouring samples below which both are marched; 0: never
  float depth_tolerance;      // relative difference of depth up to which all samples are equally suitable
  // A pixel is marched if samples at other depths have lost a part of the weight, and this part of the difference
  // between the samples exceeds this fraction of the pixel's colour.
  float tolerated_difference;
};

// A slice: sample i is at line.xy + stride i, for i <= last. A position p of the picture projects to sample dot(p -
// line.xy, line.zw). (These are vectors because CPU devices load a vector in half the time of its components.)
struct EpipolarSlice {
  vec4 line;  // entry and axis
  vec2 stride;
  uint last;           // the first sample at or beyond the border
  uint first_marched;  // start of its samples in the list of marched ones
};

// The slice line in a cascade's map: texture coordinates line.xy + x line.zw, where x counts cells of one texel (along
// the axis that changes faster) from the camera.
struct SliceLine {
  vec4 line;
  // x: the first cell; y: the number of cells inside the map and within the reach of the cascade; z: how many of these,
  // from the first on, are in the tree because rays of marched samples reach them.
  ivec3 cells;
  float depth;  // depth of the camera
};

const uint kTreeBlock = 256u;    // cells per block of a tree
const uint kTreeLeafLevel = 3u;  // nodes of 8, 16, ... 256 cells: 2 to the power of the level
const uint kTreeTopLevel = 8u;
const uint kTreeNodes = 64u;   // per block, including one unused
const uint kLineThreads = 8u;  // invocations of slice_directions.comp per slice line
const uint kTreeGroup = 8u;    // blocks built by one workgroup

// The number of Rayleigh scale heights above which there is almost no medium: a camera above them sees a limb.
const float kAllOfAir = 5.0f;

// The quantities that pixels compute from their own rays because there are few slices.
const uint kSparsityNone = 0u;
// Next to a skyline, pixels of the sky compute density integrals, and use more distant samples.
const uint kSparsitySkyline = 1u;
// All pixels of the sky, and pixels between samples at other depths, also compute density integrals.
const uint kSparsityAll = 2u;

// The width in pixels of a block of unwarp.comp; the height is 2. On CPU devices, wide blocks share most work. On GPUs,
// 8 x 8 threads of 2 x 2 pixels cover whole sectors of the picture's memory, with few registers per thread.
const uint kUnwarpWidthCpu = 4u;
const uint kUnwarpWidthGpu = 2u;

// The kinds of dispatches of march_samples.comp. The first three are those of CascadeProcessing.
const uint kAllCascades = 0u;
const uint kOneCascade = 1u;     // one cascade, added to the results of the previous ones
const uint kCascadesAside = 2u;  // one cascade per workgroup along z
const uint kFinish = 3u;         // computes in-scattering from the results of all cascades
const uint kPixels = 4u;         // pixels, all cascades

const uint kMarchGroup = 64u;  // invocations per workgroup
// The largest number of workgroups of an indirect dispatch along an axis, which every device supports. Longer lists
// continue along y. (A loop in the shader would be slower: CPU devices store everything that lives across iterations in
// memory, and the trees took twice as long.)
const uint kMaxGroups = 65535u;

// The head of a list that is processed by an indirect dispatch: the dispatch arguments, then the number of items.
struct WorkList {
  uint groups_x;
  uint groups_y;
  uint groups_z;
  uint count;
};

#endif
