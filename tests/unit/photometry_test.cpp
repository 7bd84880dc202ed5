// Photometric units, cameras, primaries, and the illuminance of the direct sun.
#include <gtest/gtest.h>

#include <cmath>

#include "effect/spectral_medium.hpp"
#include "image/primaries.hpp"
#include "models/spectral.hpp"
#include "scene/description/camera_exposure.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall {
namespace {

TEST(Photometry, TheSunHasTheIlluminanceOfItsSpectrum) {
  EXPECT_NEAR(kSunIlluminance_lux, kLuminousEfficacy * sun_luminous_irradiance(), 0.01);
  Params params;
  params.scattering.color = ColorMode::spectral;
  EXPECT_NEAR(luminance(sun_color(params)), 1.0, 1e-5);
  // The sun's irradiance of 10 and the scale of 0.5: white is a fifth of the sun's illuminance.
  const Vec3 color = sun_color(params);
  EXPECT_NEAR(white_luminance({5.0F * color.x, 5.0F * color.y, 5.0F * color.z}), kSunIlluminance_lux / 5.0, 1.0);
  EXPECT_EQ(white_luminance(Vec3(0.0F)), 0.0);
}

// The direct spectrum of ASTM G173-03 is that of the sun at an air mass of 1.5 through a clear atmosphere with an
// aerosol optical depth of 0.084 at 500 nm and 343.8 DU of ozone.
TEST(Photometry, TheDirectSunIsThatOfTheStandard) {
  struct Bin {
    double nm, xyz[3];
  };
  constexpr Bin kBins[] = {
#include "reference/bins.inl"
  };
  // Direct irradiance divided by extraterrestrial irradiance, both from the standard, at 385, 395, ... 715 nm.
  constexpr double kTransmittance[] = {0.45027, 0.48270, 0.51224, 0.54030, 0.56588, 0.58923, 0.61028, 0.63243, 0.65045,
                                       0.66130, 0.67999, 0.69420, 0.69834, 0.71387, 0.71883, 0.72301, 0.72876, 0.73494,
                                       0.73310, 0.72110, 0.74820, 0.72385, 0.75680, 0.77418, 0.77050, 0.79086, 0.80947,
                                       0.80236, 0.82138, 0.84316, 0.85010, 0.80404, 0.83664, 0.84639};
  double standard_lux = 0.0;
  for (std::size_t i = 0; i < std::size(kTransmittance); ++i) {
    ASSERT_EQ(kBins[i].nm, 385.0 + 10.0 * static_cast<double>(i));
    standard_lux += kLuminousEfficacy * kBins[i].xyz[1] * kTransmittance[i];
  }
  Params params;
  params.scattering.color = ColorMode::spectral;
  params.atmosphere.angstrom_exponent = 1.14F;  // rural aerosol
  params.atmosphere.aerosol_optical_depth = static_cast<float>(0.084 * std::pow(550.0 / 500.0, -1.14));
  params.atmosphere.ozone_du = 343.8F;
  params.atmosphere.pressure_hpa = 1013.25F;
  const std::array<double, 3> color = models::sunlight_color(params, 0.0, 1.0 / 1.5);
  const double found_lux = kSunIlluminance_lux * luminance({static_cast<float>(color[0]), static_cast<float>(color[1]),
                                                            static_cast<float>(color[2])});
  RecordProperty("standard_lux", std::to_string(standard_lux));
  RecordProperty("found_lux", std::to_string(found_lux));
  std::printf("direct sun: %.0f lx, standard: %.0f lx (%+.2f %%)\n", found_lux, standard_lux,
              100.0 * (found_lux / standard_lux - 1.0));
  EXPECT_NEAR(found_lux, standard_lux, 0.03 * standard_lux);
}

TEST(Photometry, ExposureValuesAreThoseOfCameras) {
  EXPECT_NEAR(ev100_of_camera(16.0, 1.0 / 100.0, 100.0), std::log2(25600.0), 1e-12);
  EXPECT_NEAR(ev100_of_camera(16.0, 1.0 / 100.0, 400.0), std::log2(25600.0) - 2.0, 1e-12);
  // A meter sets a luminance of 4096 cd/m^2 to 15 (K = 12.5), and the factor maps it to middle grey.
  const double white = 20000.0;
  const double factor = exposure_of_ev100(15.0, 0.18, white);
  EXPECT_NEAR(4096.0 / white * factor, 0.18, 1e-12);
  EXPECT_NEAR(ev100_of_exposure(factor, 0.18, white), 15.0, 1e-12);
}

TEST(Photometry, TheExposureIsGivenOnce) {
  scene::TonemapParams tonemap;
  EXPECT_FALSE(scene::camera_ev100(tonemap).has_value());
  EXPECT_TRUE(scene::is_auto_exposed(tonemap));
  tonemap.aperture = 8.0F;
  EXPECT_FALSE(scene::check_camera_exposure(tonemap).ok());
  EXPECT_FALSE(scene::camera_ev100(tonemap).has_value());
  tonemap.shutter_s = 0.01F;
  EXPECT_TRUE(scene::check_camera_exposure(tonemap).ok());
  EXPECT_NEAR(scene::camera_ev100(tonemap).value_or(0.0), std::log2(6400.0), 1e-5);
  EXPECT_FALSE(scene::is_auto_exposed(tonemap));
  tonemap.exposure_ev100 = 0.0F;
  const Result<void> both = scene::check_camera_exposure(tonemap);
  ASSERT_FALSE(both.ok());
  EXPECT_NE(both.error().message.find("tonemap.exposure_ev100"), std::string::npos);
  tonemap.aperture = tonemap.shutter_s = 0.0F;
  EXPECT_TRUE(scene::check_camera_exposure(tonemap).ok());
  EXPECT_EQ(scene::camera_ev100(tonemap).value_or(-1.0), 0.0);
}

// The matrices of ITU-R BT.2087 and of the ACES project, and IEC 61966-2-1.
TEST(Primaries, MatricesAreThePublishedOnes) {
  using image::Primaries;
  const auto expect = [](Primaries primaries, const double(&rows)[3][3], double tolerance) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> unit = {};
      unit[k] = 1.0;
      const std::array<double, 3> column = image::in_primaries(unit, primaries);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(column[i], rows[i][k], tolerance) << i << ' ' << k;
    }
  };
  expect(Primaries::rec2020, {{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}}, 1e-4);
  expect(Primaries::xyz, {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}, 2e-4);
  expect(Primaries::acescg,
         {{0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452}, {0.020616, 0.109570, 0.869815}}, 1e-4);
  for (const auto primaries : {Primaries::rec2020, Primaries::acescg}) {
    for (const double value : image::in_primaries({1.0, 1.0, 1.0}, primaries)) EXPECT_NEAR(value, 1.0, 1e-6);
  }
  image::Image picture(2, 1);
  picture.rgb = {1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 2.0F};
  image::convert_to(Primaries::xyz, picture);
  EXPECT_NEAR(picture.rgb[1], 0.2126F, 1e-4F);
  EXPECT_NEAR(picture.rgb[5], 2.0F * 0.9505F, 1e-3F);
  EXPECT_EQ(image::primaries_of_name("rec2020"), Primaries::rec2020);
  EXPECT_FALSE(image::primaries_of_name("p3").has_value());
}

}  // namespace
}  // namespace tyndall
