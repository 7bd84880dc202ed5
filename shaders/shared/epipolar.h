// What the passes of epipolar sampling share. Compiled by GLSL (std430) and by C++ (src/effect/shared.hpp).
// Places in the picture are in pixels, from its upper left corner; a pixel's middle is at + 0.5. The border is
// the rectangle of the outermost pixels' middles; its sides are 0 left (downwards), 1 bottom (to the right),
// 2 right (upwards) and 3 top (to the left).
#ifndef TYNDALL_SHARED_EPIPOLAR
#define TYNDALL_SHARED_EPIPOLAR

struct EpipolarConstants {
  uint slices;
  uint samples;  // of each slice
  uint initial_step;
  uint epipole_density;
  float threshold;
  uint optimize_locations;
  float least_weight;  // a pixel with a smaller sum of weights is marched by itself
  uint show_depth_breaks;
  // The epipole: where the sun stands in the picture or, behind the camera, the point opposite to it, is
  // (sun_x, sun_y) / sun_w; sun_w >= 0, and 0 for a sun at right angles to the view.
  float sun_x;
  float sun_y;
  float sun_w;
  uint sun_in_picture;
  float fallback_x;  // direction away from the epipole, where it coincides with a place on the border
  float fallback_y;
  float perimeter;  // of the sides on which slices end [pixels]
  uint closed;      // 1: slices end on all four, and the last is next to the first
  // Where each side begins along the perimeter; < 0: no slice ends there.
  float left_start;
  float bottom_start;
  float right_start;
  float top_start;
  uint first_cascade;  // marched
  uint cascades;       // behind the last marched one
  uint tree_cells;     // of a row, at most; a multiple of kTreeBlock; 0: no trees
  uint tree_format;    // MinMaxFormat
  // The picture that the light is computed for; `slices` and `samples` are those for it.
  uint downscale;
  uint reduced_width;
  uint reduced_height;
  uint break_capacity;  // of the list of pixels to be marched; a multiple of kMarchGroup
};

// A slice: sample i lies at line.xy + stride x i, i <= last; a place p of the picture falls on sample
// dot(p - line.xy, line.zw). (Vectors, because CPU devices load one in half the time of its numbers.)
struct EpipolarSlice {
  vec4 line;  // entry and axis
  vec2 stride;
  uint last;           // sample: the first at or behind the border
  uint first_marched;  // where its samples begin in the list of marched ones
};

// The line of a slice in a cascade's map: texture coordinates line.xy + x line.zw, where x counts cells of one
// texel (along the axis that changes faster) from the camera on.
struct ShadowRow {
  vec4 line;
  // x: the first, y: how many are inside the map and within the reach of the cascade, z: how many of these, from the
  // first on, are in the tree, because rays of marched samples come to them.
  ivec3 cells;
  float depth;  // of the camera
};

const uint kTreeBlock = 256u;    // cells of a tree
const uint kTreeLeafLevel = 3u;  // nodes of 8, 16, ... 256 cells: 2 to the power of the level
const uint kTreeTopLevel = 8u;
const uint kTreeNodes = 64u;  // of a block, with one to spare
const uint kTreeGroup = 8u;   // blocks that are built together

// Scale heights of air [Rayleigh] above which there is next to none: a camera above them sees a limb.
const float kAllOfAir = 5.0f;

const uint kUnwarpWidth = 4u;  // pixels of a block of unwarp.comp; they are 2 high

// What a dispatch of march_samples.comp does; the first three are those of CascadeProcessing.
const uint kAllCascades = 0u;
const uint kOneCascade = 1u;     // and adds it to what the one before has left
const uint kCascadesAside = 2u;  // one for each group along y
const uint kFinish = 3u;         // makes light of what the cascades have left
const uint kPixels = 4u;         // pixels, as the first

const uint kMarchGroup = 64u;  // invocations
// Groups of an indirect dispatch along an axis, at most: what every device takes. Longer lists go on along y. (A loop
// in the shaders would do, but CPU devices keep all that lives in a loop in memory: the trees took twice as long.)
const uint kMaxGroups = 65535u;

// The head of a list that is worked through indirectly: arguments of a dispatch, then the number of items.
struct WorkList {
  uint groups_x;
  uint groups_y;
  uint groups_z;
  uint count;
};

#endif
