// Hoffman and Preetham's model against their published equations (2002), evaluated here independently in double
// precision. The published Henyey-Greenstein function has (1 - g)^2 where the normalised one has 1 - g^2, and its g has
// the opposite sign; we compare with 1 - g^2 and -g.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "models/homogeneous.hpp"

namespace tyndall {
namespace {

using Rgb = std::array<double, 3>;
constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-3;  // the promised tolerance; the inputs are floats

double at(const Vec3& v, std::size_t c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }

// Returns the optical length of a layer by equation 5.
double printed_length(double zenith_m, double theta_deg) {
  return zenith_m / (std::cos(theta_deg * kPi / 180.0) + 0.15 * std::pow(93.885 - theta_deg, -1.253));
}

struct Printed {
  double air, haze, haze_ex, g;  // one channel; g with the publication's sign
  double f_air(double cos_theta) const { return 3.0 / (16.0 * kPi) * (1.0 + cos_theta * cos_theta); }
  double f_haze(double cos_theta) const {
    return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g + 2.0 * g * cos_theta, 1.5));
  }
  double sun(double air_m, double haze_m) const { return std::exp(-(air * air_m + haze_ex * haze_m)); }
  // Returns the in-scattering over the distance s by equation 4.
  double near_ground(double e_sun, double s, double cos_theta) const {
    const double ex = air + haze_ex;
    return e_sun * (air * f_air(cos_theta) + haze * f_haze(cos_theta)) / ex * (1.0 - std::exp(-ex * s));
  }
  // Returns the radiance of the sky by the equation for two shells.
  double sky(double e_sun, double air_m, double haze_m, double cos_theta) const {
    const double ex = air + haze_ex;
    return near_ground(e_sun, haze_m, cos_theta) +
           e_sun * air * f_air(cos_theta) / air * (1.0 - std::exp(-air * (air_m - haze_m))) * std::exp(-ex * haze_m);
  }
};

struct Case {
  Params params;
  models::HomogeneousLengths lengths;
};

Case random_case(std::mt19937& engine) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Case out;
  AtmosphereParams& air = out.params.atmosphere;
  air.custom_coefficients = true;
  const auto coefficient = [&] { return static_cast<float>(std::pow(10.0, uniform(-6.5, -2.5))); };
  air.rayleigh_scattering = {coefficient(), coefficient(), coefficient()};
  air.mie_scattering = {coefficient(), coefficient(), coefficient()};
  air.mie_absorption = {coefficient(), coefficient(), coefficient()};
  air.mie_g = static_cast<float>(uniform(-0.9, 0.98));
  out.lengths.air_m = static_cast<float>(uniform(1000.0, 20000.0));
  out.lengths.haze_m = static_cast<float>(uniform(0.05, 1.0) * out.lengths.air_m);
  return out;
}

Printed printed(const Case& c, std::size_t channel) {
  const AtmosphereParams& air = c.params.atmosphere;
  const double haze = at(air.mie_scattering, channel);
  return {at(air.rayleigh_scattering, channel), haze, haze + at(air.mie_absorption, channel),
          -static_cast<double>(air.mie_g)};
}

// Compares relative to the true value, with an absolute limit for nearly black values.
void expect_close(double value, double truth, const char* what, int i) {
  EXPECT_NEAR(value, truth, kTolerance * std::abs(truth) + 1e-30) << what << ", input " << i;
}

TEST(Homogeneous, TheSkyIsThePrintedTwoShells) {
  std::mt19937 engine(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (int i = 0; i < 5000; ++i) {
    const Case c = random_case(engine);
    const shared::Homogeneous medium = models::homogeneous_from_params(c.params, c.lengths);
    const double view_deg = uniform(0.0, 90.0);
    const double sun_deg = uniform(0.0, 90.0);
    const double azimuth = uniform(0.0, 2.0 * kPi);
    const double altitude_m = i % 2 == 0 ? 0.0 : uniform(0.0, 70000.0);  // the eye's altitude does not matter
    const models::Ray ray = models::ray_from_angles(altitude_m, view_deg * kPi / 180.0, sun_deg * kPi / 180.0, azimuth);
    const models::Answer answer = models::homogeneous_light(medium, ray);
    const double cos_theta = std::sin(view_deg * kPi / 180.0) * std::sin(sun_deg * kPi / 180.0) * std::cos(azimuth) +
                             std::cos(view_deg * kPi / 180.0) * std::cos(sun_deg * kPi / 180.0);
    const double air_m = printed_length(c.lengths.air_m, view_deg);
    const double haze_m = printed_length(c.lengths.haze_m, view_deg);
    for (std::size_t k = 0; k < 3; ++k) {
      const Printed p = printed(c, k);
      const double e_sun = p.sun(printed_length(c.lengths.air_m, sun_deg), printed_length(c.lengths.haze_m, sun_deg));
      expect_close(answer.radiance[k], p.sky(e_sun, air_m, haze_m, cos_theta), "sky", i);
      expect_close(answer.transmittance[k], p.sun(air_m, haze_m), "extinction of the sky", i);
      expect_close(models::homogeneous_sun(medium, 0.0, std::cos(sun_deg * kPi / 180.0))[k], e_sun, "sun", i);
    }
  }
}

TEST(Homogeneous, TheGroundIsSeenThroughEquations3And4) {
  std::mt19937 engine(4);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (int i = 0; i < 5000; ++i) {
    const Case c = random_case(engine);
    const shared::Homogeneous medium = models::homogeneous_from_params(c.params, c.lengths);
    const double altitude_m = uniform(1.0, 20000.0);
    const double view = kPi - uniform(0.0, 80.0) * kPi / 180.0;
    const double sun_deg = uniform(0.0, 90.0);
    const double azimuth = uniform(0.0, 2.0 * kPi);
    const models::Answer answer =
        models::homogeneous_light(medium, models::ray_from_angles(altitude_m, view, sun_deg * kPi / 180.0, azimuth));
    // Distance to the sphere by the law of cosines.
    const double radius = medium.planet_radius_m;
    const double r = radius + altitude_m;
    const double s = -r * std::cos(view) - std::sqrt(radius * radius - r * r * std::sin(view) * std::sin(view));
    const double cos_theta = std::sin(view) * std::sin(sun_deg * kPi / 180.0) * std::cos(azimuth) +
                             std::cos(view) * std::cos(sun_deg * kPi / 180.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const Printed p = printed(c, k);
      const double e_sun = p.sun(printed_length(c.lengths.air_m, sun_deg), printed_length(c.lengths.haze_m, sun_deg));
      expect_close(answer.radiance[k], p.near_ground(e_sun, s, cos_theta), "ground", i);
      expect_close(answer.transmittance[k], p.sun(s, s), "extinction of the ground", i);
    }
  }
}

TEST(Homogeneous, LimitsOfDistanceAndDensity) {
  Params params;
  const models::HomogeneousLengths lengths;
  // An eye on the ground looks down, so the distance is 0.
  models::Answer answer = models::homogeneous_light(models::homogeneous_from_params(params, lengths),
                                                    models::ray_from_angles(0.0, kPi, 0.5, 0.0));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(answer.radiance[k], 0.0);
    EXPECT_EQ(answer.transmittance[k], 1.0);
  }
  // The ray is so long and the medium so dense that nothing is transmitted, as along an infinite ray.
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.rayleigh_scattering = {0.5F, 0.5F, 0.5F};
  params.atmosphere.mie_scattering = params.atmosphere.mie_absorption = {0.0F, 0.0F, 0.0F};
  models::HomogeneousLengths thin = {10.0, 1.0, false};
  answer = models::homogeneous_light(models::homogeneous_from_params(params, thin),
                                     models::ray_from_angles(70000.0, kPi, 0.0, 0.0));
  for (std::size_t k = 0; k < 3; ++k) {
    const double e_sun = std::exp(-0.5 * printed_length(10.0, 0.0));
    EXPECT_NEAR(answer.radiance[k] / (e_sun * 3.0 / (16.0 * kPi) * 2.0), 1.0, 1e-6);
    EXPECT_EQ(answer.transmittance[k], 0.0);
  }
  // The light goes to 0 with the coefficient, and is 0 without a medium.
  for (const float beta : {1e-9F, 1e-12F, 1e-30F, 0.0F}) {
    params.atmosphere.rayleigh_scattering = {beta, beta, beta};
    for (const double view : {0.0, 1.5, 1.6, kPi}) {
      answer = models::homogeneous_light(models::homogeneous_from_params(params, lengths),
                                         models::ray_from_angles(1000.0, view, 0.5, 1.0));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GE(answer.radiance[k], 0.0);
        EXPECT_LE(answer.radiance[k], beta * 1e6);
        EXPECT_NEAR(answer.transmittance[k], 1.0, beta * 1e6 + 1e-15);
      }
    }
  }
}

// The publication does not define these cases. A sun that has set gives no light, the atmosphere ends in space, and no
// ray gives NaN.
TEST(Homogeneous, NightSpaceAndEveryRayAreDefined) {
  std::mt19937 engine(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (int i = 0; i < 20000; ++i) {
    Case c = random_case(engine);
    c.lengths.falloff = i % 2 == 1;
    const shared::Homogeneous medium = models::homogeneous_from_params(c.params, c.lengths);
    const double altitude = i % 3 == 0 ? uniform(-500.0, 90000.0) : std::pow(10.0, uniform(0.0, 9.0));
    const double sun = uniform(0.0, kPi);
    const models::Ray ray = models::ray_from_angles(altitude, uniform(0.0, kPi), sun, uniform(0.0, 2.0 * kPi));
    const models::Answer answer = models::homogeneous_light(medium, ray);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_TRUE(std::isfinite(answer.radiance[k]) && answer.radiance[k] >= 0.0) << i;
      ASSERT_TRUE(answer.transmittance[k] >= 0.0 && answer.transmittance[k] <= 1.0) << i;
      const bool dark = altitude <= 80000.0 && sun > 0.5 * kPi;
      ASSERT_TRUE(!dark || answer.radiance[k] == 0.0) << i;
    }
  }
  const shared::Homogeneous medium = models::homogeneous_from_params({}, {});
  for (const double up : {0.0, 1.0}) {
    const models::Answer space = models::homogeneous_light(medium, models::ray_from_angles(200000.0, up, 0.3, 0.0));
    EXPECT_EQ(space.radiance, (Rgb{0.0, 0.0, 0.0}));
    EXPECT_EQ(space.transmittance, (Rgb{1.0, 1.0, 1.0}));
  }
  EXPECT_EQ(models::homogeneous_sky_irradiance(medium, 0.0, -0.001), (Rgb{0.0, 0.0, 0.0}));
  EXPECT_EQ(models::homogeneous_sun(medium, 0.0, -0.001), (Rgb{0.0, 0.0, 0.0}));
}

// With densities that fall with altitude, results at the ground are the published ones, space is transparent, and a
// view down from space crosses the whole layer.
TEST(Homogeneous, FalloffAgreesAtTheGroundAndThinsOut) {
  models::HomogeneousLengths lengths;
  const shared::Homogeneous published = models::homogeneous_from_params({}, lengths);
  lengths.falloff = true;
  const shared::Homogeneous falling = models::homogeneous_from_params({}, lengths);
  for (const double view : {0.0, 0.7, 1.4, 0.5 * kPi}) {
    const models::Ray ray = models::ray_from_angles(0.0, view, 0.6, 1.0);
    const models::Answer a = models::homogeneous_light(published, ray);
    const models::Answer b = models::homogeneous_light(falling, ray);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(b.radiance[k], a.radiance[k], 1e-12);
  }
  double last = 1.0;
  for (const double altitude : {0.0, 1000.0, 5000.0, 20000.0, 79000.0}) {
    const double sky = models::homogeneous_light(falling, models::ray_from_angles(altitude, 1.0, 0.6, 1.0)).radiance[2];
    EXPECT_LT(sky, last);
    last = sky;
  }
  EXPECT_LT(last, 1e-4);
  // Straight down from orbit, the optical lengths are the vertical ones.
  const models::Answer down = models::homogeneous_light(falling, models::ray_from_angles(400000.0, kPi, 0.6, 1.0));
  for (std::size_t k = 0; k < 3; ++k) {
    const double tau = at(falling.air_scattering, k) * 8400.0 + at(falling.haze_extinction, k) * 1250.0;
    EXPECT_NEAR(down.transmittance[k], std::exp(-tau), 0.01 * std::exp(-tau));
  }
}

// Compares the sky's irradiance with a plain sum over many directions.
TEST(Homogeneous, TheSkysIrradianceIsTheSumOfTheSky) {
  const shared::Homogeneous medium = models::homogeneous_from_params({}, {});
  for (const double sun : {0.0, 0.8, 1.3, 1.55}) {
    Rgb sum = {};
    constexpr int kZeniths = 900;
    constexpr int kAzimuths = 720;
    for (int i = 0; i < kZeniths; ++i) {
      const double view = 0.5 * kPi * (i + 0.5) / kZeniths;
      for (int k = 0; k < kAzimuths; ++k) {
        const models::Answer answer = models::homogeneous_light(
            medium, models::ray_from_angles(0.0, view, sun, 2.0 * kPi * (k + 0.5) / kAzimuths));
        const double weight = std::cos(view) * std::sin(view) * 0.5 * kPi / kZeniths * 2.0 * kPi / kAzimuths;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += answer.radiance[c] * weight;
      }
    }
    const Rgb found = models::homogeneous_sky_irradiance(medium, 0.0, std::cos(sun));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], sum[c], 2e-3 * sum[c]) << sun;
  }
}

// The irradiance and the sunlight of an eye at an altitude agree with the rays that it sees there.
TEST(Homogeneous, IrradianceAndSunlightFollowTheAltitude) {
  models::HomogeneousLengths lengths;
  const shared::Homogeneous constant = models::homogeneous_from_params({}, lengths);
  lengths.falloff = true;
  const shared::Homogeneous falling = models::homogeneous_from_params({}, lengths);
  constexpr double kSun = 0.7;
  const double cos_sun = std::cos(kSun);
  double last = 1.0;
  for (const double altitude : {0.0, 1000.0, 20000.0, 50000.0}) {
    const models::Answer to_sun =
        models::homogeneous_light(falling, models::ray_from_angles(altitude, kSun, kSun, 0.0));
    const Rgb sun = models::homogeneous_sun(falling, altitude, cos_sun);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sun[k], to_sun.transmittance[k], 1e-9) << altitude;
    // The sky's radiance falls with the density, and so does its irradiance.
    const double sky = models::homogeneous_sky_irradiance(falling, altitude, cos_sun)[1];
    EXPECT_LT(sky, last);
    EXPECT_GT(sky, 0.0);
    last = sky;
    EXPECT_EQ(models::homogeneous_sky_irradiance(constant, altitude, cos_sun),
              models::homogeneous_sky_irradiance(constant, 0.0, cos_sun));
    EXPECT_EQ(models::homogeneous_sun(constant, altitude, cos_sun), models::homogeneous_sun(constant, 0.0, cos_sun));
  }
  // At the ground, a disc that has partly set shines as it does without falloff.
  shared::Homogeneous constant_disc = constant, falling_disc = falling;
  constant_disc.sun_radius_rad = falling_disc.sun_radius_rad = 0.01F;
  for (const double up : {-0.02, -0.005, -0.001, 0.0, 0.001, 0.005}) {
    const Rgb expected = models::homogeneous_sun(constant_disc, 0.0, up),
              found = models::homogeneous_sun(falling_disc, 0.0, up);
    EXPECT_EQ(found, expected) << up;
    EXPECT_LE(found[0], 0.3) << up;
    EXPECT_EQ(found[0] > 0.0, up > -0.01) << up;
  }
  EXPECT_LT(last, 0.01 * models::homogeneous_sky_irradiance(falling, 0.0, cos_sun)[1]);
  for (const shared::Homogeneous& medium : {constant, falling}) {
    EXPECT_EQ(models::homogeneous_sky_irradiance(medium, 1e7, cos_sun), Rgb{});
    // From 10 000 km, the planet reaches 23 degrees from the nadir.
    EXPECT_EQ(models::homogeneous_sun(medium, 1e7, std::cos(100.0 * kPi / 180.0)), (Rgb{1.0, 1.0, 1.0}));
    EXPECT_EQ(models::homogeneous_sun(medium, 1e7, std::cos(170.0 * kPi / 180.0)), Rgb{});
  }
}

}  // namespace
}  // namespace tyndall
