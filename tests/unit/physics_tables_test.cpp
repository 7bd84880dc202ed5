// The mappings between rays and texels of the scattering tables (shaders/lib/table_mapping.glsl) are inverses of each
// other, and the texel values (shaders/lib/table_values.glsl) have the right limits.
#include <gtest/gtest.h>

#include "effect/medium.hpp"
#include "models/glsl_double.hpp"

namespace tyndall {
namespace {

glsl64::Medium earth() { return glsl64::widen(medium_from_params({})); }

glsl64::TableShape shape_of(std::uint32_t parameterization) { return {32, 128, 64, 16, parameterization, 4, 0, 0}; }

class TableMapping : public testing::TestWithParam<std::uint32_t> {};

TEST_P(TableMapping, TexelCentresMapToThemselves) {
  const glsl64::Medium m = earth();
  const glsl64::TableShape t = shape_of(GetParam());
  for (std::uint32_t i = 0; i < t.altitudes; ++i) {
    const double u = (i + 0.5) / t.altitudes;
    const double h = glsl64::altitude_from_u(t, m, u);
    EXPECT_NE(h, 0.0);
    EXPECT_GE(h, -500.0);
    EXPECT_LT(h, m.atmosphere_height_m);
    EXPECT_NEAR(glsl64::u_from_altitude(t, m, h), u, 1e-9);
    for (std::uint32_t j = 0; j < t.views; ++j) {
      const double v = (j + 0.5) / t.views;
      bool below = false;
      const double mu = glsl64::view_from_v(t, m, h, v, below);
      ASSERT_GE(mu, -1.0);
      ASSERT_LE(mu, 1.0);
      // Next to the horizon, the cosine is nearly constant (a fifth power), so the inverse loses precision.
      const bool grazing = std::abs(mu - glsl64::ground_horizon_cos(h, m.planet_radius_m)) < 1e-7;
      EXPECT_NEAR(glsl64::v_from_view(t, m, h, mu, below), v, grazing ? 0.02 : 2e-6) << i << " " << j;
      if (t.parameterization != 2) {
        EXPECT_EQ(below, v < 0.5);
      }
    }
  }
  for (std::uint32_t i = 0; i < t.suns; ++i) {
    const double w = (i + 0.5) / t.suns;
    // The published lowest sun lies slightly inside the first texel.
    EXPECT_NEAR(glsl64::w_from_sun(t, glsl64::sun_from_w(t, w)), w, i == 0 ? 1e-3 : 1e-6);
  }
  for (std::uint32_t i = 0; i < t.angles; ++i) {
    const double q = (i + 0.5) / t.angles;
    EXPECT_NEAR(glsl64::q_from_angle(t, glsl64::angle_from_q(t, q)), q, 1e-6);
  }
}

TEST_P(TableMapping, FilteringDoesNotCrossTheHorizon) {
  if (GetParam() == 2) GTEST_SKIP() << "the linear mapping is the one that does";
  const glsl64::Medium m = earth();
  const glsl64::TableShape t = shape_of(GetParam());
  const double half_texel = 0.5 / t.views;
  for (const double h : {-500.0, -100.0, 16.0, 1000.0, 30000.0, 79984.0}) {
    for (const double mu : {-1.0, -0.3, glsl64::ground_horizon_cos(h, m.planet_radius_m), 0.1, 1.0}) {
      const double below = glsl64::v_from_view(t, m, h, mu, true);
      const double above = glsl64::v_from_view(t, m, h, mu, false);
      EXPECT_GE(below, half_texel - 1e-12);
      EXPECT_LE(below, 0.5 - half_texel + 1e-12);
      EXPECT_GE(above, 0.5 + half_texel - 1e-12);
      EXPECT_LE(above, 1.0 - half_texel + 1e-12);
    }
  }
}

// Look-ups have no step at sea level, and are clamped at the limits of the tables.
TEST_P(TableMapping, AltitudesContinueBelowSeaLevel) {
  const glsl64::Medium m = earth();
  const glsl64::TableShape t = shape_of(GetParam());
  const double sea = glsl64::u_from_altitude(t, m, glsl64::table_altitude(m, 0.0));
  EXPECT_NEAR(glsl64::u_from_altitude(t, m, -1e-9), sea, 1e-9);
  double before = sea;
  for (const double h : {-1.0, -16.0, -100.0, -400.0, -499.0}) {
    const double u = glsl64::u_from_altitude(t, m, h);
    EXPECT_LT(u, before);
    before = u;
  }
  EXPECT_NEAR(glsl64::u_from_altitude(t, m, -500.0), 0.5 / t.altitudes, 1e-12);
  EXPECT_NEAR(glsl64::u_from_altitude(t, m, -11000.0), 0.5 / t.altitudes, 1e-12);
  EXPECT_EQ(glsl64::table_altitude(m, -11000.0), -500.0);
}

// u_for_lookup() may change the weights of two neighbouring texels, but it maps texel centres to themselves and
// preserves the order of altitudes.
TEST_P(TableMapping, LookUpsPreserveTexelsAndTheOrderOfAltitudes) {
  const glsl64::TableShape t = shape_of(GetParam());
  for (const float aerosol : {0.0F, 1.0F, 20.0F}) {
    Params params;
    params.atmosphere.aerosol_density = aerosol;
    const glsl64::Medium m = glsl64::widen(medium_from_params(params));
    for (const double mu_s : {1.0, 0.1, 0.0, -0.2}) {
      for (std::uint32_t i = 0; i < t.altitudes; ++i) {
        const double u = (i + 0.5) / t.altitudes;
        EXPECT_NEAR(glsl64::u_for_lookup(t, m, glsl64::altitude_from_u(t, m, u), mu_s), u, 1e-9);
      }
      const double sea = glsl64::u_for_lookup(t, m, glsl64::table_altitude(m, 0.0), mu_s);
      EXPECT_NEAR(glsl64::u_for_lookup(t, m, -1e-9, mu_s), sea, 1e-9);
      double before = -1.0;
      for (double h = -520.0; h < 81000.0; h += h < 4000.0 ? 7.0 : 300.0) {
        const double inside = h < 0.0 ? h : glsl64::table_altitude(m, h);
        const double u = glsl64::u_for_lookup(t, m, inside, mu_s);
        EXPECT_GE(u, before) << h;
        EXPECT_NEAR(u, glsl64::u_from_altitude(t, m, inside), 1.0 / t.altitudes) << h;
        before = u;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, TableMapping, testing::Values(0U, 1U, 2U));

TEST(TableValues, NormalisationIsExactForAMixedMediumUnderAFullSun) {
  glsl64::Medium m = earth();
  m.mie_extinction = m.mie_scattering = glsl64::vec3(0.0);
  m.ozone_absorption = glsl64::vec3(0.0);
  // For one species without absorption, the opacity equals the scattered fraction.
  const glsl64::vec3 column = glsl64::density_integral_to_top(m, 500.0, 0.1);
  const glsl64::NormalisationFactors factors = glsl64::normalisation_factors(m, column);
  const glsl64::vec3 expected = glsl64::vec3(1.0) - glsl64::transmittance(m, column);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(factors.high[c], expected[c], 1e-9);
  const glsl64::vec3 value(1e-12, 0.3, 1.0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(glsl64::value_from_texel(glsl64::texel_from_value(value))[c] / value[c], 1.0, 1e-12);
  }
}

TEST(TableValues, AngleShapeHasTheAureoleOfTheAerosol) {
  glsl64::Medium m = earth();
  const auto shape = [&](double nu) { return glsl64::angle_shape(glsl64::angle_shape_of(m), nu); };
  // Towards the sun, the shape is larger in a channel with less Rayleigh scattering.
  EXPECT_GT(shape(1.0).x, shape(1.0).y);
  EXPECT_GT(shape(1.0).y, shape(1.0).z);
  for (int i = -10; i <= 10; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_GE(shape(0.1 * i)[c], 1.0);
  }
  // The aureole narrows with the aerosol's phase function, and is absent without aerosol.
  const double wide = shape(1.0).y;
  m.mie_g = 0.85F;
  EXPECT_GT(shape(1.0).y, wide);
  m.mie_scattering = glsl64::vec3(0.0);
  for (const double nu : {-1.0, 0.0, 0.3, 1.0}) EXPECT_NEAR(shape(nu).y, 1.0 + 0.3 * nu * nu, 1e-12);
  m.rayleigh_scattering = glsl64::vec3(0.0);
  EXPECT_NEAR(shape(1.0).x, 1.3, 1e-12);
}

TEST(LightTables, AltitudesContinueBelowSeaLevel) {
  const double R = 6.36e6;
  const double top = 80000.0;
  for (const double h : {-1000.0, -730.0, -430.0, -1.0, 0.0, 3.0, 500.0, 30000.0}) {
    for (const double mu : {0.85, 0.3, 0.01, 0.0, -0.01, -0.2}) {
      const glsl64::vec2 point = glsl64::light_table_point(glsl64::light_table_uv(h, mu, R, top), R, top);
      EXPECT_NEAR(point.x, h, 1e-6);
      EXPECT_NEAR(point.y, mu, 1e-9);
    }
  }
  EXPECT_EQ(glsl64::light_table_uv(-11000.0, 0.5, R, top).x, glsl64::light_table_uv(-1000.0, 0.5, R, top).x);
}

TEST(TableValues, SunlightFollowsFromDensityIntegrals) {
  const glsl64::Medium m = earth();
  for (const double h : {-430.0, 0.0, 3000.0, 40000.0}) {
    for (const double mu : {1.0, 0.3, 0.02, -0.01, -0.05, -0.1}) {
      const double r = m.planet_radius_m + h;
      const glsl64::vec3 found = glsl64::sun_transmittance_at(m, h, r * mu);
      const glsl64::vec3 expected = glsl64::sun_visibility(h, mu, m.planet_radius_m) *
                                    glsl64::transmittance(m, glsl64::density_integral_to_top(m, h, mu));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-4) << h << " " << mu;
    }
  }
}

}  // namespace
}  // namespace tyndall
