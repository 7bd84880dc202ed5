#include "effect/epipolar_constants.hpp"

#include <algorithm>
#include <cmath>

#include "effect/frame_constants.hpp"
#include "effect/modes.hpp"
#include "effect/resources.hpp"

namespace tyndall {
namespace {

// Pixels with a smaller sum of weights are marched. A sum below the default means that no sample has a similar depth.
// With correct_depth_breaks, similar samples must also have a considerable weight, and a depth within a twentieth. At
// half or a quarter of the resolution a difference of a sixth is accepted, which halves the number of marched pixels.
constexpr float kMinWeight = 1e-2F;
constexpr float kMinWeightCorrected = 0.1F;
constexpr float kMinWeightDownscaled = 1e-3F;
// In twilight, the sky becomes darker from pixel to pixel towards the ground. A pixel of the sky is therefore marched
// unless nearly all of its weight is from samples in the sky.
constexpr float kMinWeightTwilight = 0.9F;
// By day the light in front of neighbouring ridges differs too little.
constexpr float kToleratedTwilight = 0.03F;
constexpr float kToleratedByDay = 1e9F;
// In twilight, the light in front of distant ridges changes considerably with their depth.
constexpr float kTwilightDepthTolerance = 0.5F;  // in units of the tolerance by day
// In twilight, samples on both sides of every depth discontinuity are marched, because unshadowed in-scattering does
// not contain the planet's shadow.
constexpr float kTwilightDiscontinuityRatio = 0.8F;
// In twilight and with clouds, the initial step is divided by this, because refinement compares unshadowed
// in-scattering, which contains neither the planet's shadow nor those of clouds.
constexpr std::uint32_t kStepDivisor = 4;

// Returns whether the sun is a degree or more below the horizontal plane of the camera.
bool sun_is_down(const FrameInputs& inputs, const Params& params) {
  constexpr double kSine = -0.0174;
  if (is_homogeneous(params.scattering)) return false;
  const Vec3& s = inputs.sun.direction_to_sun;
  const float* at = inputs.camera.world_from_view.m + 12;
  const double up[3] = {static_cast<double>(at[0]),
                        static_cast<double>(at[1]) + static_cast<double>(params.planet.radius_m),
                        static_cast<double>(at[2])};
  const double along =
      up[0] * static_cast<double>(s.x) + up[1] * static_cast<double>(s.y) + up[2] * static_cast<double>(s.z);
  return along < kSine * std::hypot(up[0], up[1], up[2]) *
                     std::hypot(static_cast<double>(s.x), static_cast<double>(s.y), static_cast<double>(s.z));
}

// Computes the epipole: the direction to the sun, projected in double precision.
void set_epipole(shared::EpipolarConstants& out, const FrameInputs& inputs) {
  const auto row_of = [](const Mat4& m, int row, const double* v) {
    double sum = 0.0;
    for (int col = 0; col < 4; ++col) sum += static_cast<double>(m.m[4 * col + row]) * v[col];
    return sum;
  };
  const Vec3& s = inputs.sun.direction_to_sun;
  const double length =
      std::sqrt(static_cast<double>(s.x) * s.x + static_cast<double>(s.y) * s.y + static_cast<double>(s.z) * s.z);
  const double world[3] = {s.x / length, s.y / length, s.z / length};
  double view[4] = {};
  for (int i = 0; i < 3; ++i) {
    // world_from_view is rigid, so its transpose transforms directions from world to view space.
    for (int k = 0; k < 3; ++k) view[i] += static_cast<double>(inputs.camera.world_from_view.m[4 * i + k]) * world[k];
  }
  const double clip_x = row_of(inputs.camera.clip_from_view, 0, view);
  const double clip_y = row_of(inputs.camera.clip_from_view, 1, view);
  const double clip_w = row_of(inputs.camera.clip_from_view, 3, view);
  const double width = inputs.extent.width;
  const double height = inputs.extent.height;
  double x = 0.5 * (clip_x + clip_w) * width;
  double y = 0.5 * (clip_y + clip_w) * height;
  double w = clip_w;
  if (w < 0.0) {
    x = -x;
    y = -y;
    w = -w;
  }
  const double size = std::max({std::abs(x), std::abs(y), w * std::max(width, height), 1e-300});
  x /= size;
  y /= size;
  w /= size;
  if (w < 1e-12) w = 0.0;  // the slices are parallel
  out.sun_x = static_cast<float>(x);
  out.sun_y = static_cast<float>(y);
  out.sun_w = static_cast<float>(w);
}

// Determines the sides of the border on which lines from the epipole leave the picture, in the order of
// shared/epipolar.h, and where each begins along the perimeter. It uses the epipole in single precision, as the shaders
// do.
void set_border(shared::EpipolarConstants& out, const FrameInputs& inputs) {
  const double width = inputs.extent.width;
  const double height = inputs.extent.height;
  const double px = static_cast<double>(out.sun_x);
  const double py = static_cast<double>(out.sun_y);
  const double pw = static_cast<double>(out.sun_w);
  const bool ends[4] = {px - 0.5 * pw > 0.0, (height - 0.5) * pw - py > 0.0, (width - 0.5) * pw - px > 0.0,
                        py - 0.5 * pw > 0.0};
  const double lengths[4] = {height - 1.0, width - 1.0, height - 1.0, width - 1.0};
  const bool closed = ends[0] && ends[1] && ends[2] && ends[3];
  out.closed = closed ? 1 : 0;
  out.sun_in_picture = closed ? 1 : 0;
  int first = 0;
  if (!closed) {
    while (first < 3 && !(ends[first] && !ends[(first + 3) % 4])) ++first;
  }
  double along = 0.0;
  float* const starts[4] = {&out.left_start, &out.bottom_start, &out.right_start, &out.top_start};
  for (int i = 0; i < 4; ++i) {
    const int side = (first + i) % 4;
    *starts[side] = ends[side] ? static_cast<float>(along) : -1.0F;
    if (ends[side]) along += lengths[side];
  }
  out.perimeter = static_cast<float>(std::max(along, 1e-3));
  // The direction away from an epipole on the border points into the picture.
  const double to_x = 0.5 * width * pw - px;
  const double to_y = 0.5 * height * pw - py;
  const double to = std::hypot(to_x, to_y);
  out.fallback_x = to > 1e-12 ? static_cast<float>(to_x / to) : 1.0F;
  out.fallback_y = to > 1e-12 ? static_cast<float>(to_y / to) : 0.0F;
}

}  // namespace

shared::EpipolarConstants epipolar_constants(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  shared::EpipolarConstants out = {};
  const EpipolarParams& p = params.epipolar;
  out.slices = downscaled_count(p.slices, params);
  out.samples = downscaled_count(p.samples, params);
  out.downscale = params.scattering.downscale;
  const VkExtent2D downscaled = downscaled_extent(inputs.extent, params);
  out.downscaled_width = downscaled.width;
  out.downscaled_height = downscaled.height;
  const bool fine = sun_is_down(inputs, params) || has_clouds(inputs);
  out.initial_step = fine ? std::max(p.initial_step / kStepDivisor, 1U) : p.initial_step;
  out.epipole_density = p.epipole_density;
  out.threshold = p.refinement_threshold;
  out.optimize_locations = p.optimize_locations.value;
  out.min_weight = is_downscaled(params)                             ? kMinWeightDownscaled
                   : params.epipolar.correct_depth_breaks.value != 0 ? kMinWeightCorrected
                                                                     : kMinWeight;
  out.correction_capacity = correction_capacity(desc, params);
  const bool twilight = sun_is_down(inputs, params) && !is_downscaled(params);
  out.min_weight_sky = twilight ? std::max(out.min_weight, kMinWeightTwilight) : out.min_weight;
  out.tolerated_difference = twilight ? kToleratedTwilight : kToleratedByDay;
  out.depth_tolerance = p.refinement_threshold * (twilight ? kTwilightDepthTolerance : 1.0F);
  out.discontinuity_ratio = twilight ? kTwilightDiscontinuityRatio : 0.0F;
  out.show_depth_breaks = p.show_depth_breaks.value;
  out.tree_cells = p.min_max_tree.value != 0 ? tree_cells(desc) : 0;
  out.tree_format = static_cast<std::uint32_t>(p.min_max_format);
  out.cascades = params.scattering.light_shafts ? static_cast<std::uint32_t>(inputs.cascades.size()) : 0;
  out.first_cascade = std::min(inputs.first_marched_cascade, out.cascades);

  set_epipole(out, inputs);
  set_border(out, inputs);
  return out;
}

}  // namespace tyndall
