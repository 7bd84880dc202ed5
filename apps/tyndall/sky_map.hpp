// The sky as a latitude-longitude map: which ray each pixel looks along, and the sun's disc in it.
// The top row looks to the zenith and the bottom row to the nadir; the left edge is north, and the azimuth
// grows clockwise (east, south, west) to the right. A pixel stands for the direction of its centre.
#pragma once

#include "effect/shared.hpp"
#include "image/image.hpp"
#include "models/single_scattering.hpp"

namespace tyndall::cli {

struct SkyMap {
  std::uint32_t width = 2048;
  std::uint32_t height = 1024;
  double altitude_m = 0.0;  // of the eye
  double sun_elevation_rad = 0.0;
  double sun_azimuth_rad = 0.0;  // clockwise from north

  // Of pixels of this row [sr].
  [[nodiscard]] double pixel_solid_angle(std::uint32_t y) const;
  // Precondition: x < width, y < height.
  [[nodiscard]] RayQuery query(std::uint32_t x, std::uint32_t y) const;
};

struct SunFace {
  double angular_radius_rad = 0.0;
  std::array<double, 3> limb_exponent = {};            // see scene/sun_disc.hpp
  std::array<double, 3> irradiance = {1.0, 1.0, 1.0};  // above the atmosphere
};

// Adds the sun's disc as the air and the horizon let it through. Every pixel gets its mean over the pixel, so
// that the map holds the sun's whole irradiance at any size.
void add_sun(image::Image& image, const SkyMap& map, const SunFace& sun, const shared::Medium& medium);

}  // namespace tyndall::cli
