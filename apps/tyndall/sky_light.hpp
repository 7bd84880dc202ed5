// The light of a sky map, with three channels or four wavelengths: the sun's disc, and the irradiance of sun and sky.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "sky_map.hpp"
#include "tyndall/params.hpp"

namespace tyndall::cli {

// The sun's disc in the channels of the medium. With four wavelengths, `first` has the first three, and `fourth` has
// the fourth, for an irradiance of 1.
struct SunFaces {
  SunFace first, fourth;
  std::array<double, 3> irradiance;  // above the atmosphere
};
[[nodiscard]] SunFaces sun_faces(double radius_rad, const std::array<double, 3>& irradiance, const Params& params);

// Adds the sun's disc in all channels.
void draw_sun(image::Image& image, const SkyMap& map, const SunFaces& faces, const Params& params);

// Returns the light of the disc in the channels of the image.
[[nodiscard]] Sunlight sunlight_of(const SkyMap& map, const SunFaces& faces, const Params& params);

// A quadrature of the irradiance that the sky gives to a horizontal surface facing up: rays, and the weights of their
// radiance [sr]. It does not depend on the size and projection of a map.
struct SkyQuadrature {
  std::vector<RayQuery> queries;
  std::vector<double> weights;
};
[[nodiscard]] SkyQuadrature sky_quadrature(double altitude_m, double sun_zenith_rad);

// The illuminance of the sun's disc on a surface that faces it, and that of sun and sky on a horizontal one [lx].
struct Illuminance {
  double sun_lux = 0.0, sun_horizontal_lux = 0.0, sky_lux = 0.0;
};

// Returns the sun as a light of its own, for --sun split. `light` is in the units of the map; `lux` is nullptr with
// three channels.
[[nodiscard]] nlohmann::ordered_json sun_json(const SkyMap& map, const SunFace& face, const Sunlight& light,
                                              const Illuminance* lux);

}  // namespace tyndall::cli
