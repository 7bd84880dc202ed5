#include "models/table_axes.hpp"

#include <algorithm>

#include "effect/frame_constants.hpp"
#include "effect/medium.hpp"
#include "models/glsl_double.hpp"

namespace tyndall::models {
namespace {

glsl64::TableShape wide_shape(const Params& params) {
  const shared::TableShape s = table_shape(params);
  return {s.altitudes, s.views, s.suns, s.angles, s.parameterization, s.orders, 0, 0};
}

double centre(std::uint32_t texel, std::uint32_t texels) { return (texel + 0.5) / texels; }

// Returns the length of a ray of the tables, as shaders/precompute/ray_nodes.comp computes it.
double distance_to_end(const glsl64::Medium& m, double h, double mu, bool below) {
  const double R = m.planet_radius_m;
  return below ? glsl64::distance_to_ground(h, mu, R) : glsl64::distance_to_top(h, mu, m.atmosphere_height_m, R);
}

}  // namespace

TableAxes table_axes(const Params& params) {
  const glsl64::Medium m = glsl64::widen(medium_from_params(params));
  const glsl64::TableShape shape = wide_shape(params);
  TableAxes axes;
  for (std::uint32_t i = 0; i < shape.altitudes; ++i) {
    const double h = glsl64::altitude_from_u(shape, m, centre(i, shape.altitudes));
    axes.altitude_m.push_back(h);
    for (std::uint32_t k = 0; k < shape.views; ++k) {
      bool below = false;
      axes.cos_view_zenith.push_back(glsl64::view_from_v(shape, m, h, centre(k, shape.views), below));
      axes.ends_on_ground.push_back(below);
      const double mu = axes.cos_view_zenith.back();
      const double end = distance_to_end(m, h, mu, below);
      axes.mean_distance_m.push_back(
          glsl64::density_weighted_mean_distance(m, h, mu, end, glsl64::density_integral_along(m, h, mu, end)));
    }
  }
  for (std::uint32_t i = 0; i < shape.suns; ++i)
    axes.cos_sun_zenith.push_back(glsl64::sun_from_w(shape, centre(i, shape.suns)));
  for (std::uint32_t i = 0; i < shape.angles; ++i)
    axes.cos_view_sun.push_back(glsl64::angle_from_q(shape, centre(i, shape.angles)));
  return axes;
}

LightTableAxes light_table_axes(const Params& params, std::uint32_t altitudes, std::uint32_t suns) {
  const double R = params.planet.radius_m;
  const double top = params.atmosphere.height_m;
  LightTableAxes axes;
  for (std::uint32_t i = 0; i < altitudes; ++i) {
    const double h = glsl64::light_table_point({centre(i, altitudes), 0.5}, R, top).x;
    axes.altitude_m.push_back(h);
    axes.cos_horizon.push_back(glsl64::light_table_point({centre(i, altitudes), 0.5}, R, top).y);
  }
  // At and below sea level the horizon's cosine is 0.
  for (std::uint32_t i = 0; i < suns; ++i)
    axes.cos_sun_from_horizon.push_back(glsl64::light_table_point({0.0, centre(i, suns)}, R, top).y);
  return axes;
}

std::vector<TableFactors> table_factors(const Params& params, const TableAxes& axes) {
  const glsl64::Medium m = glsl64::widen(medium_from_params(params));
  const std::size_t views = axes.cos_view_zenith.size() / axes.altitude_m.size();
  std::vector<TableFactors> out;
  out.reserve(axes.cos_view_zenith.size());
  for (std::size_t i = 0; i < axes.cos_view_zenith.size(); ++i) {
    const double h = axes.altitude_m[i / views];
    const double mu = axes.cos_view_zenith[i];
    const double end = distance_to_end(m, h, mu, axes.ends_on_ground[i]);
    const glsl64::NormalisationFactors factors =
        glsl64::normalisation_factors(m, glsl64::density_integral_along(m, h, mu, end));
    out.push_back({glsl64::to_array(m.rayleigh_scattering * factors.rayleigh),
                   glsl64::to_array(m.mie_scattering * factors.mie), glsl64::to_array(factors.high)});
  }
  return out;
}

std::vector<std::array<double, 3>> angle_shapes(const Params& params, const TableAxes& axes) {
  const glsl64::AngleShape shape = glsl64::angle_shape_of(glsl64::widen(medium_from_params(params)));
  std::vector<std::array<double, 3>> out;
  out.reserve(axes.cos_view_sun.size());
  for (const double nu : axes.cos_view_sun) out.push_back(glsl64::to_array(glsl64::angle_shape(shape, nu)));
  return out;
}

}  // namespace tyndall::models
