// The coefficients of the atmosphere against published cross-sections and optical depths, and against the definitions
// of the parameters.
#include "air/coefficients.hpp"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "air/cross_sections.hpp"

namespace tyndall::air {
namespace {

// Integrates over the altitudes of the atmosphere by the midpoint rule.
double column(const Params& params, const std::function<double(double)>& density) {
  constexpr int kSteps = 200000;
  const double step = params.atmosphere.height_m / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += density((i + 0.5) * step) * step;
  return sum;
}

double exponential(const Params& params, double scale_height_m) {
  return column(params, [&](double h) { return std::exp(-h / scale_height_m); });
}

double tent(const Params& params) {
  const AtmosphereParams& a = params.atmosphere;
  return column(params, [&](double h) {
    return std::max(0.0, 1.0 - std::abs(h - a.ozone_centre_m) / static_cast<double>(a.ozone_half_width_m));
  });
}

std::string problem(const Params& params) {
  const Result<void> checked = check_params(params);
  return checked ? "" : checked.error().message;
}

TEST(Air, RayleighCrossSectionsAreBodhaines) {
  // Bodhaine et al. (1999), equation 29: their own fit to the formulas, for 360 ppm of CO2, in 1e-28 cm^2.
  for (double nm = 260.0; nm < 850.0; nm += 10.0) {
    const double l2 = nm * nm * 1.0e-6;
    const double fit = (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) / (1.0 + 0.0027059889 / l2 - 85.968563 * l2);
    EXPECT_NEAR(rayleigh_cross_section_m2(nm) / (fit * 1.0e-32), 1.0, 1.0e-4) << nm;
  }
}

TEST(Air, RayleighOpticalDepthsAreThoseOfTheLiterature) {
  for (double nm = 380.0; nm < 780.0; nm += 20.0) {
    const double l2 = nm * nm * 1.0e-6, l4 = l2 * l2;
    const double depth = rayleigh_cross_section_m2(nm) * molecules_per_m2(1013.25);
    // Hansen and Travis (1974), equation 2.30; with an older refractive index.
    EXPECT_NEAR(depth / (0.008569 / l4 * (1.0 + 0.0113 / l2 + 0.00013 / l4)), 1.0, 0.006) << nm;
    // Bodhaine et al. (1999), equation 30; with the gravity at the height of the mean molecule, which is 0.18 % less.
    const double fit =
        0.0021520 * (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) / (1.0 + 0.0027059889 / l2 - 85.968563 * l2);
    EXPECT_NEAR(depth / fit, 1.0, 0.0025) << nm;
  }
}

TEST(Air, OzoneAbsorbsAsInLeckner) {
  // Leckner, "The spectral distribution of solar radiation at the earth's surface" (1978): absorption per cm of ozone.
  constexpr double kPerCm = 1000.0 * kMoleculesPerDobsonUnit;
  EXPECT_NEAR(ozone_cross_section_m2(500.0) * kPerCm, 0.030, 0.0030);
  EXPECT_NEAR(ozone_cross_section_m2(550.0) * kPerCm, 0.085, 0.0085);
  EXPECT_NEAR(ozone_cross_section_m2(600.0) * kPerCm, 0.125, 0.0125);
  EXPECT_NEAR(kMoleculesPerDobsonUnit, 1.0e-5 * 101325.0 / (1.380649e-23 * 273.15), 1.0e17);
  EXPECT_GT(ozone_cross_section_m2(kOzoneRange.from), 0.0);
  EXPECT_GT(ozone_cross_section_m2(kOzoneRange.to), 0.0);
}

TEST(Air, OpticalDepthIsThatOfTheColumn) {
  Params params;
  params.atmosphere.aerosol_optical_depth = 0.3F;
  params.atmosphere.angstrom_exponent = 1.4F;
  params.atmosphere.aerosol_density = 7.0F;  // has no effect
  for (const float height : {500.0F, 1200.0F, 60000.0F}) {
    params.atmosphere.mie_scale_height_m = height;
    const double reach = exponential(params, static_cast<double>(height));
    EXPECT_NEAR(at_wavelength(params, 550.0).mie_extinction * reach, 0.3, 1.0e-5);
    EXPECT_NEAR(at_wavelength(params, 440.0).mie_extinction * reach, 0.3 * std::pow(550.0 / 440.0, 1.4), 1.0e-5);
  }
  // Without an albedo, the ratio of scattering and absorption is that of aerosol_absorption.
  const Coefficients blue = at_wavelength(params, 440.0);
  EXPECT_NEAR(blue.mie_extinction / blue.mie_scattering, 1.1, 1.0e-6);
}

TEST(Air, VisibilityIsKoschmieders) {
  Params params;
  params.atmosphere.visibility_m = 20000.0F;
  const Coefficients air = at_wavelength(params, 550.0);
  EXPECT_NEAR(std::exp(-20000.0 * (air.mie_extinction + air.rayleigh_scattering)), 0.02, 1.0e-5);
  params.atmosphere.visibility_m = 290000.0F;
  EXPECT_EQ(
      problem(params).find("atmosphere.visibility_m is 290000; expected at most the visibility without aerosol, "), 0U)
      << problem(params);
  params.atmosphere.visibility_m = 288000.0F;
  EXPECT_EQ(problem(params), "");
}

TEST(Air, OzoneAndPressureAreColumns) {
  Params params;
  params.atmosphere.ozone_du = 300.0F;
  params.atmosphere.pressure_hpa = 1013.25F;
  params.atmosphere.custom_coefficients = true;
  for (const float centre : {25000.0F, 8000.0F, 75000.0F}) {  // the layer is cut off by the ground, and by the top
    params.atmosphere.ozone_centre_m = centre;
    EXPECT_NEAR(at_wavelength(params, 600.0).ozone_absorption * tent(params), 300.0 * 2.6867e20 * 4.86e-25, 1.0e-6);
  }
  const double reach = exponential(params, params.atmosphere.rayleigh_scale_height_m);
  EXPECT_NEAR(at_wavelength(params, 550.0).rayleigh_scattering * reach, 0.0969, 1.0e-4);
  params.atmosphere.pressure_hpa = 500.0F;
  EXPECT_NEAR(at_wavelength(params, 550.0).rayleigh_scattering * reach, 0.0969 * 500.0 / 1013.25, 1.0e-4);
}

TEST(Air, AlbedoHoldsWhereItIsSet) {
  Params params;
  params.atmosphere.single_scattering_albedo = Vec3(0.9F, 0.8F, 0.7F);
  EXPECT_NEAR(in_channel(params, 0).mie_scattering, 0.9 * 2.2e-5, 1.0e-11);
  EXPECT_NEAR(in_channel(params, 2).mie_scattering, 0.7 * 2.2e-5, 1.0e-11);
  EXPECT_NEAR(in_channel(params, 2).mie_extinction, 2.2e-5, 1.0e-11);
  EXPECT_NEAR(at_wavelength(params, 615.0).mie_scattering, 0.85 * 2.2e-5, 1.0e-11);
  EXPECT_NEAR(at_wavelength(params, 380.0).mie_scattering, 0.7 * 2.2e-5, 1.0e-11);
}

TEST(Air, AngstromExponentReplacesTheSpectrumOfCoefficients) {
  Params params;
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.mie_scattering = Vec3(1.0e-5F, 4.0e-5F, 9.0e-5F);
  params.atmosphere.mie_absorption = Vec3(0.0F);
  params.atmosphere.angstrom_exponent = 2.0F;
  EXPECT_NEAR(in_channel(params, 2).mie_extinction, 4.0e-5 * 1.25 * 1.25, 1.0e-10);
}

TEST(Air, ChannelsHaveTheirValuesAndPowersContinue) {
  Params params;
  params.atmosphere.custom_coefficients = true;
  params.planet.ground_albedo = Vec3(0.3F, 0.2F, 0.1F);
  const Vec3& nm = params.atmosphere.wavelengths_nm;
  for (std::size_t c = 0; c < 3; ++c) {
    const Coefficients a = in_channel(params, c);
    const Coefficients b = at_wavelength(params, static_cast<double>(c == 0 ? nm.x : c == 1 ? nm.y : nm.z));
    EXPECT_EQ(a.rayleigh_scattering, b.rayleigh_scattering);
    EXPECT_EQ(a.mie_extinction, b.mie_extinction);
    EXPECT_EQ(a.ozone_absorption, b.ozone_absorption);
    EXPECT_EQ(a.ground_albedo, b.ground_albedo);
  }
  // Rayleigh coefficients in the ratio of the fourth power continue with it, in any order of the channels.
  const auto power = [](double x) { return static_cast<float>(1.0e-5 * std::pow(550.0 / x, 4.0)); };
  params.atmosphere.rayleigh_scattering = Vec3(power(440.0), power(680.0), power(550.0));
  params.atmosphere.wavelengths_nm = Vec3(440.0F, 680.0F, 550.0F);
  for (const double at : {380.0, 500.0, 620.0, 780.0}) {
    EXPECT_NEAR(at_wavelength(params, at).rayleigh_scattering, static_cast<double>(power(at)), 1.0e-10) << at;
  }
  EXPECT_NEAR(at_wavelength(params, 495.0).ground_albedo, 0.2, 1.0e-7);
  // Channels of the same wavelength have their own values, and a channel of 0 stays finite.
  params.atmosphere.wavelengths_nm = Vec3(550.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(in_channel(params, 1).rayleigh_scattering), power(680.0));
  EXPECT_TRUE(std::isfinite(at_wavelength(params, 440.0).rayleigh_scattering));
  params.atmosphere.wavelengths_nm = Vec3(680.0F, 550.0F, 550.0F);
  EXPECT_TRUE(std::isfinite(at_wavelength(params, 440.0).rayleigh_scattering));
}

// Between channels a few nanometres apart a power is steep. It does not continue beyond them.
TEST(Air, ChannelsCloseTogetherContinueWithALimitedPower) {
  Params params;
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.wavelengths_nm = Vec3(552.0F, 551.0F, 550.0F);
  const auto check = [&](const Vec3& rayleigh) {
    params.atmosphere.rayleigh_scattering = rayleigh;
    for (const double at : {445.0, 525.0, 575.0, 635.0, 775.0}) {
      const double end_nm = at < 551.0 ? 550.0 : 552.0;
      const double end = static_cast<double>(at < 551.0 ? rayleigh.z : rayleigh.x);
      const double limit = std::pow(std::max(at / end_nm, end_nm / at), 8.0) * (1.0 + 1e-12);
      const double value = at_wavelength(params, at).rayleigh_scattering;
      EXPECT_LE(value, end * limit) << at;
      EXPECT_GE(value, end / limit) << at;
    }
  };
  check({2.0e-5F, 1.0e-5F, 2.0e-5F});
  check({1.0e-5F, 2.0e-5F, 1.0e-5F});
  check({1.0e-5F, 0.0F, 1.0e-5F});
  check({0.0F, 1.0e-5F, 0.0F});
}

TEST(Air, ContradictionsAreRefused) {
  Params params;
  params.atmosphere.aerosol_optical_depth = 0.1F;
  params.atmosphere.visibility_m = 10000.0F;
  EXPECT_EQ(
      problem(params),
      "atmosphere.aerosol_optical_depth and atmosphere.visibility_m are both set; expected one of them, and 0 for "
      "the other");
  params = {};
  params.atmosphere.ozone_du = 300.0F;
  params.atmosphere.wavelengths_nm.z = 340.0F;
  EXPECT_EQ(
      problem(params),
      "atmosphere.ozone_du is set, and atmosphere.wavelengths_nm contains 340 nm; expected wavelengths from 360 to "
      "840 nm");
  params.atmosphere.wavelengths_nm.z = 440.0F;
  params.atmosphere.height_m = 9000.0F;
  EXPECT_NE(problem(params).find("the ozone layer is above the atmosphere"), std::string::npos);
  params = {};
  params.atmosphere.pressure_hpa = 900.0F;
  params.atmosphere.wavelengths_nm.x = 2000.0F;
  EXPECT_NE(problem(params).find("expected wavelengths from 230 to 1690 nm"), std::string::npos);
}

}  // namespace
}  // namespace tyndall::air
