#include "sky_light.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "effect/spectral_medium.hpp"
#include "math/angles.hpp"
#include "models/spectral.hpp"
#include "scene/sky/sun_disc.hpp"

namespace tyndall::cli {
namespace {

struct Node {
  double at, weight;
};

// Returns the nodes of a quadrature from `from` to `to`, which are dense at both ends: Gauss nodes of u, where the
// integrand is a function of (1 - cos(pi u)) / 2.
std::vector<Node> dense_at_ends(double from, double to, int panels) {
  std::vector<Node> out;
  for (int i = 0; i < 2 * panels; ++i) {
    const double gauss = (i % 2 == 0 ? -0.5 : 0.5) / std::numbers::sqrt3;
    const double angle = std::numbers::pi * (i / 2 + 0.5 + gauss) / panels;
    const double weight = (to - from) * std::numbers::pi / (4.0 * panels) * std::sin(angle);
    out.push_back({from + 0.5 * (to - from) * (1.0 - std::cos(angle)), weight});
  }
  return out;
}

}  // namespace

SkyQuadrature sky_quadrature(double altitude_m, double sun_zenith_rad) {
  constexpr double kHorizontal = 0.5 * std::numbers::pi;
  constexpr int kZenithPanels = 32, kAzimuthPanels = 32;
  // The radiance is largest at the sun and at the horizon.
  std::vector<Node> zeniths = dense_at_ends(0.0, std::min(sun_zenith_rad, kHorizontal), kZenithPanels);
  if (sun_zenith_rad < kHorizontal) {
    const std::vector<Node> below = dense_at_ends(sun_zenith_rad, kHorizontal, kZenithPanels);
    zeniths.insert(zeniths.end(), below.begin(), below.end());
  }
  const std::vector<Node> azimuths = dense_at_ends(0.0, std::numbers::pi, kAzimuthPanels);
  SkyQuadrature out;
  for (const Node& zenith : zeniths) {
    for (const Node& azimuth : azimuths) {
      out.queries.push_back({altitude_m, zenith.at, sun_zenith_rad, azimuth.at});
      // Both sides of the sun's plane are equal.
      out.weights.push_back(2.0 * zenith.weight * azimuth.weight * std::cos(zenith.at) * std::sin(zenith.at));
    }
  }
  return out;
}

SunFaces sun_faces(double radius_rad, const std::array<double, 3>& irradiance, const Params& params) {
  const Vec3& nm = params.atmosphere.wavelengths_nm;
  if (params.scattering.color == ColorMode::rgb) {
    const SunFace face = {
        radius_rad, {scene::limb_exponent(nm.x), scene::limb_exponent(nm.y), scene::limb_exponent(nm.z)}, irradiance};
    return {face, face, irradiance};
  }
  const FourChannels wavelengths_nm = spectral_wavelengths_nm();
  const auto exponent = [&](std::size_t i) { return scene::limb_exponent(static_cast<float>(wavelengths_nm[i])); };
  return {{radius_rad, {exponent(0), exponent(1), exponent(2)}},
          {radius_rad, {exponent(3), exponent(3), exponent(3)}},
          irradiance};
}

void draw_sun(image::Image& image, const SkyMap& map, const SunFaces& faces, const Params& params) {
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  if (params.scattering.color == ColorMode::rgb) {
    add_sun(image, map, faces.first, medium);
    return;
  }
  image::Image first(map.width, map.height);
  image::Image fourth(map.width, map.height);
  add_sun(first, map, faces.first, medium);
  add_sun(fourth, map, faces.fourth, models::medium_at_fourth(medium));
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    if (first.rgb[i] == 0.0F && fourth.rgb[i] == 0.0F) continue;
    const std::array<double, 3> color =
        color_of_light({first.rgb[i], first.rgb[i + 1], first.rgb[i + 2], fourth.rgb[i]});
    for (std::size_t c = 0; c < 3; ++c) image.rgb[i + c] += static_cast<float>(faces.irradiance[c] * color[c]);
  }
}

Sunlight sunlight_of(const SkyMap& map, const SunFaces& faces, const Params& params) {
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  const Sunlight first = sunlight(map, faces.first, medium);
  if (params.scattering.color == ColorMode::rgb) return first;
  const Sunlight fourth = sunlight(map, faces.fourth, models::medium_at_fourth(medium));
  const auto color = [&](const std::array<double, 3>& a, double b) {
    std::array<double, 3> out = color_of_light({a[0], a[1], a[2], b});
    for (std::size_t c = 0; c < 3; ++c) out[c] *= faces.irradiance[c];
    return out;
  };
  return {color(first.facing, fourth.facing[0]), color(first.horizontal, fourth.horizontal[0])};
}

nlohmann::ordered_json sun_json(const SkyMap& map, const SunFace& face, const Sunlight& light, const Illuminance* lux) {
  const double across = std::cos(map.sun_elevation_rad);
  nlohmann::ordered_json out;
  out["direction"] = {across * std::sin(map.sun_azimuth_rad), std::sin(map.sun_elevation_rad),
                      -across * std::cos(map.sun_azimuth_rad)};
  out["elevation_deg"] = map.sun_elevation_rad / kRadPerDeg;
  out["azimuth_deg"] = map.sun_azimuth_rad / kRadPerDeg;
  out["angular_radius_deg"] = face.angular_radius_rad / kRadPerDeg;
  out["irradiance"] = light.facing;
  out["horizontal_irradiance"] = light.horizontal;
  if (lux != nullptr) {
    out["illuminance_lux"] = lux->sun_lux;
    out["horizontal_illuminance_lux"] = lux->sun_horizontal_lux;
  }
  return out;
}

}  // namespace tyndall::cli
