// A scene of kilometre-sized buildings on a spherical planet under an arbitrary sun. Depth buffer and shadow cascades
// are computed in closed form. Also compares two pictures of the scene.
#pragma once

#include <string>
#include <vector>

#include "effect_frame.hpp"

namespace tyndall {

// A box, given by two corners in metres: x east, y up from the ground, z south of the camera.
struct Box {
  glm::dvec3 low, high;
};

// The sun. With `in_view` it is at a position of the picture: (-1, -1) is its upper left corner and (1, 1) its lower
// right one. Otherwise it is given by angles.
struct BoxSun {
  bool in_view = false;
  double x = 0.0, y = 0.0;
  bool behind = false;  // the sun is opposite to that position
  double elevation_deg = 9.0, azimuth_deg = 12.0;
};

struct BoxScene {
  std::string name;
  VkExtent2D extent = {160, 90};
  double altitude_m = 1200.0, yaw_deg = 0.0, pitch_deg = 3.0;
  double tan_half_height = 0.42;  // of the vertical field of view; the horizontal one follows from the picture's shape
  BoxSun sun;
  bool buildings = true;
  std::vector<Box> own_buildings;  // used instead of the default buildings, if there are any
  double building_size = 1.0;      // factor on the sizes and distances of all buildings
  bool ground = true;              // draw the ground; the planet exists in any case
  double ground_altitude_m = 0.0;  // altitude of the drawn ground and of the buildings on it
  bool ground_casts = true;
  std::uint32_t cascades = 3, first_marched = 0;
  std::uint32_t shadow_resolution = 256;
  double far_m = 40000.0;
  DepthConvention convention = DepthConvention::reversed_infinite;
  bool shadow_depth_reversed = false;
  double panes_m = 0.0;  // > 0: all sunlight comes through coloured panes of that size
};

// Returns a scene with the sun at a position of the picture, or opposite to it.
[[nodiscard]] BoxScene sun_at(const std::string& name, double x, double y, double pitch_deg, bool behind = false);

[[nodiscard]] TestFrame frame_of(const BoxScene& scene, const glm::dvec2& jitter_px = {0, 0});

// The difference of a picture from the reference, computed as by `tyndall compare` for two PNGs. The exposure maps the
// mean luminance of the reference to middle grey, followed by the curve 1 - exp(-x) and sRGB in 8 bits.
struct Likeness {
  double psnr_db = 0.0;               // infinite if equal
  double mean_relative_error = 0.0;   // mean error of linear radiance
  double worst_relative_error = 0.0;  // largest error of a channel, relative to the larger of it and 1 % of the mean
};
[[nodiscard]] Likeness compare(const std::vector<glm::dvec3>& picture, const std::vector<glm::dvec3>& reference,
                               VkExtent2D extent);

}  // namespace tyndall
