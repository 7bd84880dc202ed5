#include "models/oneil.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "effect/medium.hpp"
#include "models/glsl_double.hpp"
#include "models/oneil_fit.hpp"

namespace tyndall::models {
namespace {

// Builds the table, one row per cosine: see oneil_table() in shaders/lib/oneil.glsl.
std::vector<std::array<float, 4>> make_table(const shared::Medium& m, std::uint32_t size) {
  std::vector<std::array<float, 4>> out;
  out.reserve(static_cast<std::size_t>(size) * size);
  const double top = m.atmosphere_height_m;
  for (std::uint32_t j = 0; j < size; ++j) {
    const double v = static_cast<double>(j) / (size - 1);
    for (std::uint32_t i = 0; i < size; ++i) {
      const double u = static_cast<double>(i) / (size - 1);
      std::array<float, 4> entry = {};
      const double heights[] = {m.rayleigh_scale_height_m, m.mie_scale_height_m};
      for (std::size_t s = 0; s < 2; ++s) {
        const double h = top * u * u;
        entry[2 * s] = static_cast<float>(std::exp(-h / heights[s]));
        entry[2 * s + 1] =
            static_cast<float>(exponential_density_integral(heights[s], m.planet_radius_m, h, v * v, top));
      }
      out.push_back(entry);
    }
  }
  return out;
}

// Measures the errors of the model's outward density integrals of one species, up to an altitude.
IntegralError measure(const OneilModel& model, const glsl64::Medium& m, const glsl64::Oneil& o, bool mie,
                      double highest_m, int altitudes) {
  constexpr int kCosines = 40;
  const bool table = model.constants.integral_method == static_cast<std::uint32_t>(OneilIntegralMethod::table);
  const double height = mie ? m.mie_scale_height_m : m.rayleigh_scale_height_m;
  const double top = table ? m.atmosphere_height_m : std::numeric_limits<double>::infinity();
  IntegralError out;
  double sum = 0.0;
  for (int i = 0; i < altitudes; ++i) {
    const double h = altitudes > 1 ? highest_m * i / (altitudes - 1) : 0.0;
    for (int j = 0; j <= kCosines; ++j) {
      // The cosines are squares of evenly spaced numbers, because the integral varies most near the horizontal, and are
      // offset so that they fall between the table's entries.
      const double root = j == kCosines ? 1.0 : (j + 0.37) / kCosines;
      const double c = j == 0 ? 0.0 : root * root;
      const glsl64::vec2 integral = glsl64::oneil_density_integral(m, o, model.table.data(), h, c);
      const double truth = exponential_density_integral(height, m.planet_radius_m, h, c, top);
      const double error = std::abs((mie ? integral.y : integral.x) / truth - 1.0);
      out.worst = std::max(out.worst, error);
      sum += error * error;
    }
  }
  out.rms = std::sqrt(sum / (altitudes * (kCosines + 1)));
  return out;
}

}  // namespace

shared::Medium oneil_medium(const Params& params) { return medium_from_params(params); }

OneilModel make_oneil(const shared::Medium& medium, const OneilSettings& settings) {
  OneilModel out = {};
  out.medium = medium;
  const double rayleigh_m = medium.rayleigh_scale_height_m;
  const double mie_m = medium.mie_scale_height_m;
  const double radius_m = medium.planet_radius_m;
  const double top_m = medium.atmosphere_height_m;
  shared::Oneil& o = out.constants;
  o.integral_method = static_cast<std::uint32_t>(settings.integral_method);
  o.samples = settings.samples;
  o.spacing = settings.space_by_density ? 1 : 0;
  o.table_size = settings.table_size;
  o.rayleigh_phase = settings.rayleigh_phase ? 1 : 0;
  if (settings.integral_method == OneilIntegralMethod::published) {
    o.rayleigh = published_scale(rayleigh_m);
    o.mie = published_scale(mie_m);
  } else {
    o.rayleigh = fit_scale(rayleigh_m, radius_m, top_m);
    o.mie = mie_m == rayleigh_m ? o.rayleigh : fit_scale(mie_m, radius_m, top_m);
  }
  if (settings.integral_method == OneilIntegralMethod::table) {
    out.table = make_table(medium, settings.table_size);
  } else {
    out.table.resize(1);
  }
  const glsl64::Medium m = glsl64::widen(medium);
  const glsl64::Oneil wide = glsl64::widen(o);
  out.rayleigh_at_sea_level = measure(out, m, wide, false, 0.0, 1);
  out.mie_at_sea_level = measure(out, m, wide, true, 0.0, 1);
  out.rayleigh = measure(out, m, wide, false, std::min(3.0 * rayleigh_m, 0.9 * top_m), 10);
  out.mie = measure(out, m, wide, true, std::min(3.0 * mie_m, 0.9 * top_m), 10);
  return out;
}

std::string describe_errors(const OneilModel& model) {
  const bool table = model.constants.integral_method == static_cast<std::uint32_t>(OneilIntegralMethod::table);
  char text[256];
  std::snprintf(text, sizeof text,
                "%s against quadrature: Rayleigh worst %.3g %%, rms %.3g %%; aerosol worst %.3g %%, rms %.3g %%",
                table ? "table" : "scale function", 100.0 * model.rayleigh.worst, 100.0 * model.rayleigh.rms,
                100.0 * model.mie.worst, 100.0 * model.mie.rms);
  return text;
}

Answer oneil(const OneilModel& model, const Ray& ray) {
  glsl64::OneilRay path;
  path.h0 = ray.altitude_m;
  path.mu = ray.cos_view_zenith;
  path.mu_s = ray.cos_sun_zenith;
  path.nu = ray.cos_view_sun;
  glsl64::vec3 transmittance;
  const glsl64::vec3 radiance = glsl64::oneil_to_end(glsl64::widen(model.medium), glsl64::widen(model.constants),
                                                     model.table.data(), path, transmittance);
  return {glsl64::to_array(radiance), glsl64::to_array(transmittance)};
}

std::array<double, 3> oneil_sky_irradiance(const OneilModel& model, double altitude_m, double cos_sun_zenith,
                                           int nodes) {
  // As in sky_irradiance_single() of shaders/lib, the zenith angle is split at the sun and the nodes are concentrated
  // around it.
  const double sun_zenith = std::acos(std::clamp(cos_sun_zenith, 0.0, 1.0));
  const double half_pi = 0.5 * std::numbers::pi;
  std::array<double, 3> sum = {};
  for (int side = 0; side < 2; ++side) {
    const double reach = side == 0 ? sun_zenith : half_pi - sun_zenith;
    if (reach <= 1.0e-6) continue;
    for (int i = 0; i < nodes; ++i) {
      const double u = (i + 0.5) / nodes;
      const double offset = side == 0 ? reach * u * u : reach * u * u * (3.0 - 2.0 * u);
      const double stretch = side == 0 ? 2.0 * reach * u : 6.0 * reach * u * (1.0 - u);
      const double zenith = side == 0 ? sun_zenith - offset : sun_zenith + offset;
      for (int j = 0; j < nodes; ++j) {
        const double v = (j + 0.5) / nodes;
        const double weight =
            stretch * std::sin(zenith) * std::cos(zenith) * 4.0 * std::numbers::pi * v / (nodes * nodes);
        const Ray ray = ray_from_angles(altitude_m, zenith, std::acos(std::clamp(cos_sun_zenith, -1.0, 1.0)),
                                        std::numbers::pi * v * v);
        const Answer answer = oneil(model, ray);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * answer.radiance[c];
      }
    }
  }
  return sum;
}

std::array<double, 3> oneil_sun_transmittance(const OneilModel& model, double altitude_m, double cos_sun_zenith) {
  const glsl64::Medium m = glsl64::widen(model.medium);
  if (glsl64::sun_visibility(altitude_m, cos_sun_zenith, m.planet_radius_m) == 0.0) return {};
  if (altitude_m > m.atmosphere_height_m) {
    return oneil(model, {altitude_m, cos_sun_zenith, cos_sun_zenith, 1.0}).transmittance;
  }
  return glsl64::to_array(
      glsl64::oneil_sunlight(m, glsl64::widen(model.constants), model.table.data(), altitude_m, cos_sun_zenith));
}

}  // namespace tyndall::models
