// Single scattering: shaders/lib/single_scattering.glsl and sky_irradiance.glsl, in double and in single precision,
// against brute-force quadrature. Errors are relative to the ray's brightest channel.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "effect/medium.hpp"
#include "effect/phase_rows.hpp"
#include "models/glsl_double.hpp"
#include "models/single_scattering.hpp"
#include "physics_float.hpp"
#include "physics_quadrature.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;

struct Query {
  models::Ray ray;
  double azimuth;
};

// Returns rays from below sea level to 1.1e6 m: straight up and down, within 1e-6 of the horizon, with sun zenith
// angles to 100 degrees. Floats represent the cosines exactly, so that both precisions evaluate the same rays.
std::vector<Query> queries(const shared::Medium& m, int count) {
  std::mt19937 engine(7);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const double radius = m.planet_radius_m;
  const double top = m.atmosphere_height_m;
  std::vector<Query> out;
  for (int i = 0; i < count; ++i) {
    double h = 0.0;
    switch (i % 6) {
      case 0:
        // The eye is at sea level or below it.
        h = i % 12 == 0 ? 0.0 : -450.0 * uniform(0.0, 1.0);
        break;
      case 1: h = 3000.0 * std::pow(uniform(0.0, 1.0), 2.0); break;
      case 2: h = 12000.0 * uniform(0.0, 1.0); break;
      case 3: h = top + 1.0e6 * std::pow(uniform(0.0, 1.0), 2.0); break;
      default: h = 79000.0 * uniform(0.0, 1.0);
    }
    h = static_cast<float>(h);
    const double ground = 2.0 * std::min(h, 0.0);
    const double horizon = -std::sqrt((h - ground) * (2.0 * radius + h + ground)) / (radius + h);
    const double near_horizon = horizon + (i % 4 < 2 ? 1.0 : -1.0) * std::pow(10.0, uniform(-6.0, -2.0));
    double mu = 0.0;
    switch (i / 6 % 5) {
      case 0: mu = uniform(-1.0, 1.0); break;
      case 1: mu = near_horizon; break;
      case 2: mu = uniform(-0.3, 0.3); break;
      case 3: mu = i % 3 == 0 ? 1.0 : (i % 3 == 1 ? -1.0 : std::nextafter(static_cast<float>(horizon), 1.0F)); break;
      default: mu = uniform(0.0, 1.0);
    }
    if (h > top && i / 6 % 5 != 1) {
      const double limb = (radius + top) / (radius + h);
      mu = -std::sqrt(1.0 - limb * limb * uniform(0.0, 1.0));
    }
    mu = static_cast<float>(std::clamp(mu, -1.0, 1.0));
    const double sun_zenith = i / 30 % 2 == 0 ? uniform(0.0, 100.0) : uniform(85.0, 100.0);
    const double mu_s = static_cast<float>(std::cos(sun_zenith * kPi / 180.0));
    double azimuth = uniform(0.0, kPi);
    if (i % 7 == 0) {
      azimuth = 0.0;
    } else if (i % 11 == 0) {
      azimuth = kPi;
    }
    const double nu = mu * mu_s + std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s)) * std::cos(azimuth);
    out.push_back({{h, mu, mu_s, nu}, azimuth});
  }
  return out;
}

struct Errors {
  double sum = 0.0;
  double worst = 0.0;
  int count = 0;
  models::Ray at;

  void add(const brute::Three& expected, double r, double g, double b, const models::Ray& ray) {
    const double scale = std::max({expected[0], expected[1], expected[2]});
    if (scale < 1.0e-12) {
      return;  // night: 1e-12 of the sun's irradiance
    }
    const double error =
        std::max({std::abs(r - expected[0]), std::abs(g - expected[1]), std::abs(b - expected[2])}) / scale;
    sum += error;
    ++count;
    if (!(error <= worst)) {
      worst = error;
      at = ray;
    }
  }
  double mean() const { return sum / count; }
};

void expect_scattering(const shared::Medium& m, int count, int steps, double mean, double worst) {
  Errors in_double;
  Errors in_float;
  for (const Query& q : queries(m, count)) {
    const models::Ray& ray = q.ray;
    const brute::Three expected =
        brute::single_scattering(m, ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, q.azimuth, 1.0e-6);
    const models::Answer a = models::single_scattering(m, ray, steps);
    in_double.add(expected, a.radiance[0], a.radiance[1], a.radiance[2], ray);
    const shared::ProbeRay p = models::prepare_probe_ray(m, ray);
    const glsl32::Column b = glsl32::single_scattering(m, p.altitude_m, p.cos_view_zenith, p.cos_sun_zenith,
                                                       p.cos_view_sun, 0.0F, p.end_m, steps);
    in_float.add(expected, b[0], b[1], b[2], ray);
  }
  EXPECT_GT(in_double.count, count * 3 / 4);
  for (const Errors* e : {&in_double, &in_float}) {
    const char* name = e == &in_double ? "double" : "float";
    EXPECT_LE(e->mean(), mean) << name;
    EXPECT_LE(e->worst, worst) << name << " h " << e->at.altitude_m << " mu " << e->at.cos_view_zenith << " mu_s "
                               << e->at.cos_sun_zenith << " nu " << e->at.cos_view_sun;
  }
}

TEST(physics_scattering, probe_quality) { expect_scattering(medium_from_params({}), 1500, 16, 1.0e-5, 2.0e-4); }

TEST(physics_scattering, renderer_quality) { expect_scattering(medium_from_params({}), 600, 4, 2.0e-4, 5.0e-3); }

TEST(physics_scattering, hazy_air) {
  Params params;
  params.atmosphere.aerosol_density = 10.0F;
  expect_scattering(medium_from_params(params), 600, 16, 2.0e-5, 1.0e-3);
}

TEST(physics_scattering, fog) {
  Params params;
  params.atmosphere.aerosol_density = 50.0F;
  params.atmosphere.mie_phase = MiePhase::henyey_greenstein;
  expect_scattering(medium_from_params(params), 600, 24, 2.0e-3, 1.0e-2);
}

TEST(physics_scattering, another_planet) {
  Params params;
  params.planet.radius_m = 3.39e6F;
  params.atmosphere.height_m = 110000.0F;
  params.atmosphere.rayleigh_scale_height_m = 11100.0F;
  params.atmosphere.mie_scale_height_m = 11100.0F;
  params.atmosphere.mie_g = 0.9F;
  expect_scattering(medium_from_params(params), 600, 16, 1.0e-4, 2.0e-3);
}

// Deep below sea level, the atmosphere is so dense that little light is transmitted.
TEST(physics_scattering, deep_below_sea_level) {
  const shared::Medium m = medium_from_params({});
  Errors in_float;
  for (const double h : {-800.0, -2000.0, -4000.0}) {
    for (const double mu : {1.0, 0.25, 0.0, -0.015625, -0.25, -1.0}) {
      const models::Ray ray = {h, mu, 0.75, mu * 0.75};
      const brute::Three expected = brute::single_scattering(m, h, mu, 0.75, 0.5 * kPi, 1.0e-6);
      const shared::ProbeRay p = models::prepare_probe_ray(m, ray);
      EXPECT_GT(p.end_m, 0.0F);
      const glsl32::Column b = glsl32::single_scattering(m, p.altitude_m, p.cos_view_zenith, p.cos_sun_zenith,
                                                         p.cos_view_sun, 0.0F, p.end_m, 16);
      in_float.add(expected, b[0], b[1], b[2], ray);
    }
  }
  EXPECT_LE(in_float.mean(), 2.0e-4);
  EXPECT_LE(in_float.worst, 2.0e-3) << in_float.at.altitude_m << " " << in_float.at.cos_view_zenith;
}

TEST(physics_scattering, transmittance_of_the_answer) {
  const shared::Medium m = medium_from_params({});
  const models::Answer up = models::single_scattering(m, {0.0, 1.0, 0.5, 0.5});
  const brute::Three tau = brute::optical_depth(m, brute::column(m, 0.0, 1.0, m.atmosphere_height_m));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(up.transmittance[c], std::exp(-tau[c]), 1.0e-5);
  }
  const models::Answer missed = models::single_scattering(m, {1.0e6, 0.3, 0.5, 0.1});
  EXPECT_EQ(missed.radiance[0], 0.0);
  EXPECT_EQ(missed.transmittance[2], 1.0);
}

// Parameters are at the ends of their ranges, in all combinations. However odd the planet, results must be finite.
TEST(physics_scattering, extreme_parameters_stay_finite) {
  std::mt19937 engine(11);
  const auto pick = [&engine](std::initializer_list<double> values) {
    return static_cast<float>(values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(engine)]);
  };
  for (int i = 0; i < 400; ++i) {
    Params params;
    params.planet.radius_m = pick({1000.0, 1.0e6, 6.36e6, 1.0e8});
    params.atmosphere.height_m = pick({1000.0, 80000.0, 1.0e7});
    params.atmosphere.rayleigh_scale_height_m = pick({10.0, 7994.0, 1.0e6});
    params.atmosphere.mie_scale_height_m = pick({10.0, 1200.0, 1.0e6});
    params.atmosphere.aerosol_density = pick({0.0, 1.0, 100.0});
    params.atmosphere.mie_g = pick({-0.99, 0.0, 0.99});
    params.atmosphere.ozone_absorption = Vec3(pick({0.0, 1.0e-6, 1.0}));
    params.atmosphere.ozone_centre_m = pick({0.0, 25000.0, 1.0e7});
    params.atmosphere.ozone_half_width_m = pick({1.0, 15000.0, 1.0e7});
    const shared::Medium m = medium_from_params(params);
    for (const float h :
         {std::max(-11000.0F, -0.25F * params.planet.radius_m), -100.0F, 0.0F, 500.0F, 50000.0F, 2.0e7F}) {
      for (const float mu : {-1.0F, -0.3F, -1.0e-4F, 0.0F, 0.02F, 1.0F}) {
        for (const float mu_s : {-1.0F, -0.05F, 0.0F, 0.5F, 1.0F}) {
          const float nu = mu * mu_s + std::sqrt((1.0F - mu * mu) * (1.0F - mu_s * mu_s));
          for (const float value : glsl32::single_scattering_to_end(m, h, mu, mu_s, nu, 4)) {
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0F)
                << value << ": radius " << m.planet_radius_m << " top " << m.atmosphere_height_m << " H "
                << m.rayleigh_scale_height_m << ' ' << m.mie_scale_height_m << " ozone " << m.ozone_centre_m << " +- "
                << m.ozone_half_width_m << " h " << h << " mu " << mu << " mu_s " << mu_s;
          }
        }
      }
    }
  }
}

TEST(physics_scattering, nothing_is_lit_deep_in_the_shadow) {
  const shared::Medium m = medium_from_params({});
  const models::Answer night = models::single_scattering(m, {0.0, 1.0, -1.0, -1.0});
  EXPECT_EQ(night.radiance[2], 0.0);
}

// The angle between view and sun follows from the zenith angles and the azimuth by the spherical law of cosines.
TEST(physics_scattering, ray_from_angles) {
  const models::Ray towards = models::ray_from_angles(10.0, 1.0, 1.0, 0.0);
  EXPECT_NEAR(towards.cos_view_sun, 1.0, 1.0e-15);
  const models::Ray away = models::ray_from_angles(10.0, 1.0, 0.5, kPi);
  EXPECT_NEAR(away.cos_view_sun, std::cos(1.5), 1.0e-15);
}

// Compares the fixed quadrature of the sky with an adaptive one of the same radiance.
TEST(physics_scattering, sky_irradiance) {
  const shared::Medium m = medium_from_params({});
  const glsl64::Medium wide = glsl64::widen(m);
  for (const double h : {0.0, 30000.0}) {
    for (const double elevation_deg : {90.0, 60.0, 10.0, 0.0, -6.0}) {
      const double mu_s = std::sin(elevation_deg * kPi / 180.0);
      const auto ring = [&](double zenith) -> brute::Three {
        const double mu = std::cos(zenith);
        const auto radiance = [&](double azimuth) -> brute::Three {
          const double nu = mu * mu_s + std::sin(zenith) * std::sqrt(1.0 - mu_s * mu_s) * std::cos(azimuth);
          glsl64::vec3 through;
          const glsl64::vec3 l = glsl64::single_scattering_to_end(wide, h, mu, mu_s, nu, 8, through);
          return {l.x, l.y, l.z};
        };
        brute::Three sum = brute::integrate(radiance, 0.0, kPi, 1.0e-5);
        for (double& value : sum) {
          value *= 2.0 * mu * std::sin(zenith);
        }
        return sum;
      };
      const double sun_zenith = std::clamp(kPi / 2.0 - elevation_deg * kPi / 180.0, 0.0, kPi / 2.0);
      const brute::Three above = brute::integrate(ring, 0.0, sun_zenith, 1.0e-4);
      const brute::Three below = brute::integrate(ring, sun_zenith, kPi / 2.0, 1.0e-4);
      const std::array<double, 3> fine = models::single_sky_irradiance(m, h, mu_s);
      const glsl32::Column coarse =
          glsl32::sky_irradiance_single(m, static_cast<float>(h), static_cast<float>(mu_s), 2, 3);
      const double scale = std::max({above[0] + below[0], above[1] + below[1], above[2] + below[2]});
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(fine[c], above[c] + below[c], 1.0e-3 * scale) << h << ' ' << elevation_deg;
        EXPECT_NEAR(coarse[c], above[c] + below[c], 5.0e-3 * scale) << h << ' ' << elevation_deg;
      }
    }
  }
}

// Fog scatters much of its light within a few degrees of the sun. The other quadrature has polar coordinates about the
// sun.
TEST(physics_scattering, sky_irradiance_of_a_narrow_peak) {
  constexpr int kRings = 200;
  constexpr int kSpokes = 80;
  Params params;
  params.atmosphere.mie_phase = MiePhase::draine;
  params.atmosphere.droplet_diameter_um = 20.0F;
  params.atmosphere.aerosol_density = 6.0F;
  const PhaseRows rows = phase_rows(params, ColorMode::rgb);
  const shared::Medium m = medium_from_params(params);
  const glsl64::Medium wide = glsl64::widen(m, rows.data());
  for (const double sun_zenith : {0.26, 0.79, 1.22}) {
    double expected = 0.0;
    for (int i = 0; i < kRings; ++i) {
      const double u = (i + 0.5) / kRings;
      const double angle = kPi * u * u * u;
      const double ring = std::sin(angle) * 3.0 * kPi * u * u / kRings * 2.0 * kPi / kSpokes;
      for (int k = 0; k < kSpokes; ++k) {
        const double spoke = kPi * (k + 0.5) / kSpokes;
        const double mu =
            std::cos(angle) * std::cos(sun_zenith) + std::sin(angle) * std::sin(sun_zenith) * std::cos(spoke);
        if (mu <= 0.0) continue;
        glsl64::vec3 through;
        expected +=
            ring * mu *
            glsl64::single_scattering_to_end(wide, 0.0, mu, std::cos(sun_zenith), std::cos(angle), 8, through).y;
      }
    }
    EXPECT_NEAR(models::single_sky_irradiance(m, 0.0, std::cos(sun_zenith), rows)[1] / expected, 1.0, 3.0e-3)
        << sun_zenith;
  }
}

}  // namespace
}  // namespace tyndall
