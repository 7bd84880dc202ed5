#include "sky_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/angles.hpp"

namespace tyndall::cli {
namespace {

constexpr double kSamplesPerRadius = 24.0;  // samples per radius of the disc; error 0.05 % for a pixel inside the disc

// The part of the disc within one pixel.
struct Piece {
  std::uint32_t x, y;
  std::array<double, 3> flux;  // attenuated by the atmosphere, in the unit of Splitter::total()
};

class Splitter {
 public:
  Splitter(const SkyMap& map, const SunFace& sun, const shared::Medium& medium)
      : map_(map), sun_(sun), medium_(medium), sun_zenith_(0.5 * kPi - map.sun_elevation_rad) {}

  void split() {
    const double row = kPi / map_.height;
    const double top = std::max(sun_zenith_ - sun_.angular_radius_rad, 0.0);
    const double bottom = std::min(sun_zenith_ + sun_.angular_radius_rad, kPi);
    const auto first = static_cast<std::uint32_t>(top / row);
    for (std::uint32_t y = first; y < map_.height && y * row < bottom; ++y) {
      const double start = std::max(top, y * row);
      const double end = std::min(bottom, (y + 1) * row);
      const int count = pieces_along(end - start);
      const double step = (end - start) / count;
      for (int i = 0; i < count; ++i) split_chord(y, start + (i + 0.5) * step, step);
    }
  }

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  // Returns the flux of the whole disc without atmosphere and horizon.
  [[nodiscard]] const std::array<double, 3>& total() const { return total_; }
  // Returns the attenuated flux on a horizontal surface.
  [[nodiscard]] const std::array<double, 3>& horizontal() const { return horizontal_; }

 private:
  [[nodiscard]] int pieces_along(double length_rad) const {
    return std::max(1, static_cast<int>(std::ceil(length_rad * kSamplesPerRadius / sun_.angular_radius_rad)));
  }

  // Adds the part of the disc that lies in row y of the map: a ring around the zenith at the zenith angle `zenith`
  // [rad], `height_rad` high.
  void split_chord(std::uint32_t y, double zenith, double height_rad) {
    const double across = std::sin(zenith) * std::sin(sun_zenith_);
    const double along = std::cos(sun_.angular_radius_rad) - std::cos(zenith) * std::cos(sun_zenith_);
    if (along > across) return;
    const double reach = along <= -across ? kPi : std::acos(along / across);
    const std::array<double, 3> passed =
        models::sun_transmittance(medium_, map_.altitude_m, std::clamp(std::cos(zenith), -1.0, 1.0));
    const double column = 2.0 * kPi / map_.width;
    const double from = map_.sun_azimuth_rad - reach;
    const double to = map_.sun_azimuth_rad + reach;
    for (auto x = static_cast<std::int64_t>(std::floor(from / column)); static_cast<double>(x) * column < to; ++x) {
      const double start = std::max(from, static_cast<double>(x) * column);
      const double end = std::min(to, static_cast<double>(x + 1) * column);
      if (end <= start) continue;
      const int count = pieces_along((end - start) * std::sin(zenith));
      const double step = (end - start) / count;
      Piece piece = {wrapped(x), y, {}};
      for (int i = 0; i < count; ++i) {
        const double azimuth = start + (i + 0.5) * step - map_.sun_azimuth_rad;
        // Use half angles, which are precise for small distances.
        const double half_height = std::sin(0.5 * (zenith - sun_zenith_));
        const double half_width = std::sin(0.5 * azimuth);
        const double angle =
            2.0 * std::asin(std::min(std::sqrt(half_height * half_height + across * half_width * half_width), 1.0));
        const double fraction = std::min(angle / sun_.angular_radius_rad, 1.0);
        const double mu = std::sqrt(std::max(1.0 - fraction * fraction, 0.0));
        const double area = std::sin(zenith) * height_rad * step;
        for (std::size_t c = 0; c < 3; ++c) {
          const double flux = area * std::pow(mu, sun_.limb_exponent[c]);
          total_[c] += flux;
          piece.flux[c] += flux * passed[c];
          horizontal_[c] += flux * passed[c] * std::max(std::cos(zenith), 0.0);
        }
      }
      pieces_.push_back(piece);
    }
  }

  [[nodiscard]] std::uint32_t wrapped(std::int64_t x) const {
    const std::int64_t width = map_.width;
    return static_cast<std::uint32_t>(((x % width) + width) % width);
  }

  const SkyMap& map_;
  const SunFace& sun_;
  const shared::Medium& medium_;
  double sun_zenith_;
  std::vector<Piece> pieces_;
  std::array<double, 3> total_ = {}, horizontal_ = {};
};

}  // namespace

double SkyMap::pixel_solid_angle(std::uint32_t y) const {
  const double top = kPi * y / height;
  const double bottom = kPi * (y + 1.0) / height;
  // cos(top) - cos(bottom) in a form that does not cancel.
  return 2.0 * kPi / width * 2.0 * std::sin(0.5 * (top + bottom)) * std::sin(0.5 * (bottom - top));
}

PixelDirection SkyMap::direction(std::uint32_t x, std::uint32_t y) const {
  if (projection == Projection::latlong) {
    return {kPi * (y + 0.5) / height, 2.0 * kPi * (x + 0.5) / width, pixel_solid_angle(y)};
  }
  // Coordinates of the centre within the picture or face, -1 to 1, to the right and down.
  const std::uint32_t size = width;
  const double a = 2.0 * (x + 0.5) / size - 1.0;
  const double b = 2.0 * (y % size + 0.5) / size - 1.0;
  if (projection == Projection::fisheye) {
    const double area = 4.0 / (static_cast<double>(size) * size);
    const double radius = std::hypot(a, b);
    if (radius > 1.0) return {0.0, 0.0, 0.0};
    const double zenith = 0.5 * kPi * radius;
    const double stretch = radius > 1.0e-9 ? std::sin(zenith) / radius : 0.5 * kPi;
    return {zenith, std::atan2(-a, -b), 0.5 * kPi * stretch * area};
  }
  // World coordinates: x east, y up, z south.
  struct Vector {
    double x, y, z;
  };
  const Vector faces[] = {{1.0, -b, -a}, {-1.0, -b, a}, {a, 1.0, b}, {a, -1.0, -b}, {a, -b, 1.0}, {-a, -b, -1.0}};
  const Vector& v = faces[y / size];
  const double length2 = 1.0 + a * a + b * b;
  // The solid angle of the rectangle between the middle of the face and a corner, exactly.
  const auto corner = [](double u, double w) { return std::atan2(u * w, std::sqrt(1.0 + u * u + w * w)); };
  const double half = 1.0 / size;
  const double solid_angle =
      corner(a + half, b + half) - corner(a - half, b + half) - corner(a + half, b - half) + corner(a - half, b - half);
  return {std::acos(v.y / std::sqrt(length2)), std::atan2(v.x, -v.z), solid_angle};
}

RayQuery SkyMap::query(std::uint32_t x, std::uint32_t y) const {
  const auto [zenith, azimuth, solid_angle] = direction(x, y);
  return {altitude_m, zenith, 0.5 * kPi - sun_elevation_rad, azimuth - sun_azimuth_rad, false};
}

Sunlight sunlight(const SkyMap& map, const SunFace& sun, const shared::Medium& medium) {
  SkyMap fine = map;  // the pieces of the disc are those of a map
  fine.projection = Projection::latlong;
  fine.width = 2048;
  fine.height = 1024;
  Splitter splitter(fine, sun, medium);
  splitter.split();
  Sunlight out;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const Piece& piece : splitter.pieces()) out.facing[c] += piece.flux[c];
    out.facing[c] *= sun.irradiance[c] / splitter.total()[c];
    out.horizontal[c] = splitter.horizontal()[c] * sun.irradiance[c] / splitter.total()[c];
  }
  return out;
}

void add_sun(image::Image& image, const SkyMap& map, const SunFace& sun, const shared::Medium& medium) {
  Splitter splitter(map, sun, medium);
  splitter.split();
  for (const Piece& piece : splitter.pieces()) {
    const double solid_angle = map.pixel_solid_angle(piece.y);
    float* const pixel = image.pixel(piece.x, piece.y);
    for (std::size_t c = 0; c < 3; ++c) {
      pixel[c] += static_cast<float>(sun.irradiance[c] * piece.flux[c] / (splitter.total()[c] * solid_angle));
    }
  }
}

}  // namespace tyndall::cli
