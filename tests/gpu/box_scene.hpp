// Buildings of a kilometre's size on a round planet, under a sun anywhere: depth buffer and shadow cascades of the
// same solids, in closed form, and the comparison of two pictures of it.
#pragma once

#include <string>
#include <vector>

#include "effect_frame.hpp"

namespace tyndall {

// Corners in metres; x east, y up from the ground, z south of the camera.
struct Box {
  glm::dvec3 low, high;
};

// The sun, in the sky or, when `in_view`, at a place of the picture: (-1, -1) is the upper left corner, (1, 1) the
// lower right one, of its border and not of the outermost pixels' middles.
struct BoxSun {
  bool in_view = false;
  double x = 0.0, y = 0.0;
  bool behind = false;  // opposite to that place
  double elevation_deg = 9.0, azimuth_deg = 12.0;
};

struct BoxScene {
  std::string name;
  VkExtent2D extent = {160, 90};
  double altitude_m = 1200.0, yaw_deg = 0.0, pitch_deg = 3.0;
  double tan_half_height = 0.42;  // width by the picture's shape
  BoxSun sun;
  bool buildings = true;
  std::vector<Box> own_buildings;  // in place of the usual ones, unless empty
  double building_size = 1.0;      // times theirs, distances included
  bool ground = true;              // drawn; the planet is there in any case
  double ground_altitude_m = 0.0;  // of what is drawn, with the buildings on it
  bool ground_casts = true;
  std::uint32_t cascades = 3, first_marched = 0;
  std::uint32_t shadow_resolution = 256;
  double far_m = 40000.0;
  DepthConvention convention = DepthConvention::reversed_infinite;
  bool shadow_depth_reversed = false;
  double panes_m = 0.0;  // > 0: all sunlight comes through coloured panes of that size
};

// A scene with the sun at a place of the picture, or opposite to it.
[[nodiscard]] BoxScene sun_at(const std::string& name, double x, double y, double pitch_deg, bool behind = false);

[[nodiscard]] TestFrame frame_of(const BoxScene& scene);

// How far a picture is from the reference, as `tyndall compare` says it of two PNGs: the exposure is that at which
// the reference's mean luminance becomes middle grey, the curve 1 - exp(-x), then sRGB in 8 bits.
struct Likeness {
  double psnr_db = 0.0;               // infinite when equal
  double mean_relative_error = 0.0;   // of linear radiance
  double worst_relative_error = 0.0;  // of a channel, relative to it or a hundredth of the reference's mean
};
[[nodiscard]] Likeness compare(const std::vector<glm::dvec3>& picture, const std::vector<glm::dvec3>& reference,
                               VkExtent2D extent);

}  // namespace tyndall
