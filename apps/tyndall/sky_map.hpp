// The sky as a map: the ray of each pixel, and the sun's disc. docs/sky.md describes the projections. A pixel stands
// for the direction of its centre.
#pragma once

#include "effect/shared.hpp"
#include "image/image.hpp"
#include "models/single_scattering.hpp"

namespace tyndall::cli {

enum class Projection { latlong, cube, fisheye };

// The direction of a pixel [rad], azimuth clockwise from north, and the solid angle that it covers [sr]: 0 outside the
// circle of a fish-eye map.
struct PixelDirection {
  double zenith, azimuth, solid_angle;
};

struct SkyMap {
  std::uint32_t width = 2048;
  std::uint32_t height = 1024;
  double altitude_m = 0.0;  // altitude of the eye
  double sun_elevation_rad = 0.0;
  double sun_azimuth_rad = 0.0;  // clockwise from north
  Projection projection = Projection::latlong;

  // Returns the solid angle of a pixel of this row of a latitude-longitude map [sr].
  [[nodiscard]] double pixel_solid_angle(std::uint32_t y) const;
  [[nodiscard]] PixelDirection direction(std::uint32_t x, std::uint32_t y) const;
  // Returns the ray of a pixel. Precondition: x < width, y < height.
  [[nodiscard]] RayQuery query(std::uint32_t x, std::uint32_t y) const;
};

struct SunFace {
  double angular_radius_rad = 0.0;
  std::array<double, 3> limb_exponent = {};            // see scene/sun_disc.hpp
  std::array<double, 3> irradiance = {1.0, 1.0, 1.0};  // above the atmosphere
};

// The irradiance of the sun's disc, attenuated by the atmosphere and cut off by the horizon: on a surface that faces
// the sun, and on a horizontal one.
struct Sunlight {
  std::array<double, 3> facing = {}, horizontal = {};
};
[[nodiscard]] Sunlight sunlight(const SkyMap& map, const SunFace& sun, const shared::Medium& medium);

// Adds the disc to a latitude-longitude map. Every pixel gets the mean over its area, so that the map contains the
// sun's full irradiance at any size.
void add_sun(image::Image& image, const SkyMap& map, const SunFace& sun, const shared::Medium& medium);

}  // namespace tyndall::cli
