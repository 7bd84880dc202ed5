// Coefficients, densities and phase functions against literature values and their defining integrals.
#include "effect/medium.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "air/coefficients.hpp"
#include "models/glsl_double.hpp"
#include "physics_float.hpp"
#include "physics_quadrature.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(physics_medium, rayleigh_coefficients_of_the_literature) {
  const shared::Medium m = medium_from_params({});
  EXPECT_NEAR(m.rayleigh_scattering.x, 5.8045e-6, 1.0e-10);
  EXPECT_NEAR(m.rayleigh_scattering.y, 1.35629e-5, 1.0e-10);
  EXPECT_NEAR(m.rayleigh_scattering.z, 3.31126e-5, 1.0e-10);
  EXPECT_NEAR(air::rayleigh_scattering_per_m(680.0) / air::rayleigh_scattering_per_m(340.0), 1.0 / 16.0, 1.0e-12);
}

TEST(physics_medium, derived_aerosol_follows_density_and_absorption) {
  Params params;
  params.atmosphere.aerosol_density = 3.0F;
  params.atmosphere.aerosol_absorption = 0.5F;
  params.atmosphere.mie_scattering = Vec3(1.0F);  // must be ignored
  const shared::Medium m = medium_from_params(params);
  EXPECT_FLOAT_EQ(m.mie_scattering.y, 6.0e-5F);
  EXPECT_FLOAT_EQ(m.mie_extinction.y, 9.0e-5F);
}

TEST(physics_medium, custom_coefficients_hold_as_given) {
  Params params;
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.aerosol_density = 2.0F;
  params.atmosphere.aerosol_absorption = 7.0F;  // must be ignored
  params.atmosphere.mie_scattering = {1.0e-5F, 2.0e-5F, 3.0e-5F};
  params.atmosphere.mie_absorption = {4.0e-6F, 5.0e-6F, 6.0e-6F};
  const shared::Medium m = medium_from_params(params);
  EXPECT_EQ(m.rayleigh_scattering, Vec3(5.8e-6F, 13.5e-6F, 33.1e-6F));
  EXPECT_FLOAT_EQ(m.mie_scattering.x, 2.0e-5F);
  EXPECT_FLOAT_EQ(m.mie_scattering.z, 6.0e-5F);
  EXPECT_FLOAT_EQ(m.mie_extinction.y, 5.0e-5F);
  EXPECT_EQ(m.ozone_absorption, params.atmosphere.ozone_absorption);
}

TEST(physics_medium, vertical_optical_depths_and_transmittances) {
  Params params;
  params.atmosphere.ozone_absorption = Vec3(0.0F);
  const glsl64::Medium m = glsl64::widen(medium_from_params(params));
  const glsl64::vec3 column = glsl64::density_integral_to_top(m, 0.0, 1.0);
  const glsl64::vec3 rayleigh = m.rayleigh_scattering * column.x;
  EXPECT_NEAR(rayleigh.x, 0.0464, 5.0e-5);
  EXPECT_NEAR(rayleigh.y, 0.1084, 5.0e-5);
  EXPECT_NEAR(rayleigh.z, 0.2647, 5.0e-5);
  EXPECT_NEAR(m.mie_extinction.x * column.y, 0.0264, 5.0e-5);
  const glsl64::vec3 through = glsl64::transmittance(m, column);
  EXPECT_NEAR(through.x, 0.930, 5.0e-4);
  EXPECT_NEAR(through.y, 0.874, 5.0e-4);
  EXPECT_NEAR(through.z, 0.747, 5.0e-4);
  // The default ozone layer, with a half width of 15 km, has the content of 15 km at its peak.
  const glsl64::Medium with_ozone = glsl64::widen(medium_from_params({}));
  EXPECT_NEAR(glsl64::density_integral_to_top(with_ozone, 0.0, 1.0).z, 15000.0, 0.1);
}

TEST(physics_medium, densities) {
  const glsl64::Medium m = glsl64::widen(medium_from_params({}));
  const glsl64::vec3 ground = glsl64::densities(m, 0.0);
  EXPECT_EQ(ground.x, 1.0);
  EXPECT_EQ(ground.y, 1.0);
  EXPECT_EQ(ground.z, 0.0);
  EXPECT_EQ(glsl64::densities(m, 25000.0).z, 1.0);
  EXPECT_NEAR(glsl64::densities(m, 32500.0).z, 0.5, 1.0e-12);
  EXPECT_NEAR(glsl64::densities(m, 7994.0).x, std::exp(-1.0), 1.0e-12);
  EXPECT_EQ(glsl64::densities(m, 80001.0).x, 0.0);
  // Far below sea level the densities are finite.
  EXPECT_TRUE(std::isfinite(glsl64::densities(m, -1.0e6).y));
}

double sphere_integral(const std::function<double(double)>& phase) {
  const auto f = [&](double nu) { return brute::Three{2.0 * kPi * phase(nu), 0.0, 0.0}; };
  return brute::integrate(f, -1.0, 0.9, 1.0e-12)[0] + brute::integrate(f, 0.9, 1.0, 1.0e-12)[0];
}

TEST(physics_medium, phase_functions_are_normalised) {
  EXPECT_NEAR(sphere_integral(glsl64::rayleigh_phase), 1.0, 1.0e-12);
  for (const double g : {-0.99, -0.5, 0.0, 0.3, 0.76, 0.99}) {
    EXPECT_NEAR(sphere_integral([g](double nu) { return glsl64::cornette_shanks_phase(nu, g); }), 1.0, 1.0e-8) << g;
    EXPECT_NEAR(sphere_integral([g](double nu) { return glsl64::henyey_greenstein_phase(nu, g); }), 1.0, 1.0e-8) << g;
  }
}

TEST(physics_medium, phase_functions_look_forward_for_positive_g) {
  EXPECT_GT(glsl64::cornette_shanks_phase(1.0, 0.76), 100.0 * glsl64::cornette_shanks_phase(-1.0, 0.76));
  EXPECT_GT(glsl64::henyey_greenstein_phase(-1.0, -0.76), glsl64::henyey_greenstein_phase(1.0, -0.76));
  EXPECT_NEAR(glsl64::cornette_shanks_phase(0.4, 0.0), glsl64::rayleigh_phase(0.4), 1.0e-12);
  const double mean_cosine = sphere_integral([](double nu) { return nu * glsl64::henyey_greenstein_phase(nu, 0.76); });
  EXPECT_NEAR(mean_cosine, 0.76, 1.0e-8);
}

TEST(physics_medium, aerosol_phase_has_its_peak_in_single_precision) {
  for (const MiePhase kind : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein}) {
    Params params;
    params.atmosphere.mie_g = 0.98F;
    params.atmosphere.mie_phase = kind;
    const shared::Medium m = medium_from_params(params);
    for (const double angle : {0.0, 0.001, 0.01, 0.1, 1.0, 3.14}) {
      const float nu = static_cast<float>(std::cos(angle));
      EXPECT_NEAR(glsl32::mie_phase(m, nu) / brute::mie_phase(m, nu), 1.0, 3.0e-6) << angle;
    }
  }
}

}  // namespace
}  // namespace tyndall
