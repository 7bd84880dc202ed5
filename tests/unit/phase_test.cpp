// The aerosol's phase functions that have no formula in the shaders: the fit for droplets, tables, their rows in the
// shaders, and their sampling in the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "air/phase.hpp"
#include "effect/medium.hpp"
#include "effect/phase_rows.hpp"
#include "models/glsl_double.hpp"
#include "reference/phase.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;

// The integrals of a phase function over the sphere, and of it times the cosine.
struct Moments {
  double total = 0.0, cosine = 0.0;
};
template <typename Function>
Moments moments(const Function& function) {
  Moments out;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    const double c = 1.0 - 2.0 * std::pow(x, 6.0);  // dense ahead
    const double part = 2.0 * kPi * 12.0 * std::pow(x, 5.0) / kSteps * function(c);
    out.total += part;
    out.cosine += part * c;
  }
  return out;
}

Params droplets(double diameter_um) {
  Params params;
  params.atmosphere.mie_phase = MiePhase::draine;
  params.atmosphere.droplet_diameter_um = static_cast<float>(diameter_um);
  return params;
}

double henyey_greenstein(double c, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * c, 1.5));
}

// A table of Henyey and Greenstein's function with g = 0.5 at 450 nm and 0.8 at 650 nm, every half degree.
Result<std::shared_ptr<const PhaseTable>> two_colors(double factor = 1.0) {
  std::vector<double> angles, values;
  for (int i = 0; i <= 360; ++i) {
    angles.push_back(0.5 * i);
    for (const double g : {0.5, 0.8}) {
      values.push_back(factor * henyey_greenstein(std::cos(angles.back() * kPi / 180.0), g));
    }
  }
  const double nm[] = {450.0, 650.0};
  return PhaseTable::create(angles, nm, values);
}

Params with_table() {
  Params params;
  params.atmosphere.mie_phase = MiePhase::table;
  params.phase_table = two_colors().value();
  return params;
}

std::string error_of(const std::vector<double>& angles, const std::vector<double>& values) {
  const double nm[] = {550.0};
  const Result<std::shared_ptr<const PhaseTable>> made = PhaseTable::create(angles, nm, values);
  return made ? "" : made.error().message;
}

TEST(Phase, DropletsAreNormalisedAndHaveTheirMeanCosine) {
  for (const double d : {0.05, 0.5, 2.0, 5.0, 10.0, 20.0}) {
    const Params params = droplets(d);
    const Moments m = moments([&](double c) { return air::phase(params, c, 550.0); });
    EXPECT_NEAR(m.total, 1.0, 1e-4) << d;
    EXPECT_NEAR(m.cosine, air::asymmetry(params, 550.0), 1e-4) << d;
  }
  // Mie theory gives 0.85 to 0.87 for the droplets of fog and clouds, and 0 for particles far smaller than the light.
  EXPECT_NEAR(air::asymmetry(droplets(10.0), 550.0), 0.86, 0.015);
  EXPECT_NEAR(air::asymmetry(droplets(0.02), 550.0), 0.0, 0.02);
  // The constants of a diameter between the two ranges of the fit agree, as far as the fit itself is continuous.
  EXPECT_NEAR(air::asymmetry(droplets(4.999), 550.0), air::asymmetry(droplets(5.001), 550.0), 0.02);
}

TEST(Phase, TablesAreNormalisedAndInterpolated) {
  const std::shared_ptr<const PhaseTable> table = two_colors(4.0 * kPi * 1.03).value();
  EXPECT_NEAR(table->deviation(), 0.03, 1e-3);
  for (const auto& [wavelength_nm, g] : {std::pair(450.0, 0.5), std::pair(650.0, 0.8), std::pair(300.0, 0.5)}) {
    const double nm = wavelength_nm;
    EXPECT_NEAR(moments([&](double c) { return (*table)(c, nm); }).total, 1.0, 1e-5) << nm;
    EXPECT_NEAR(table->asymmetry(nm), g, 1e-4);
    for (const double c : {1.0, 0.9, 0.0, -0.7, -1.0}) {
      EXPECT_NEAR((*table)(c, nm) / henyey_greenstein(c, g), 1.0, 1e-3) << c;
    }
  }
  EXPECT_NEAR((*table)(0.3, 500.0), 0.75 * (*table)(0.3, 450.0) + 0.25 * (*table)(0.3, 650.0), 1e-12);
}

TEST(Phase, BadTablesAreRefused) {
  const double p = 0.25 / kPi;
  EXPECT_EQ(error_of({0, 90, 180}, {p, p, p}), "");
  EXPECT_EQ(error_of({0, 180}, {p, p}), "phase table: 2 angles; expected 3 to 10000");
  EXPECT_EQ(error_of({1, 90, 180}, {p, p, p}), "phase table: the first angle is 1 degrees; expected 0");
  EXPECT_EQ(error_of({0, 90, 179.5}, {p, p, p}), "phase table: the last angle is 179.5 degrees; expected 180");
  EXPECT_EQ(error_of({0, 90, 90, 180}, {p, p, p, p}), "phase table: angle 90 follows 90; expected increasing values");
  EXPECT_EQ(error_of({0, 90, 180}, {p, -p, p}),
            "phase table: invalid value -0.079577 at 90 degrees and 550 nm; expected 0 or more");
  EXPECT_NE(error_of({0, 90, 180}, {p, std::nan(""), p}), "");
  EXPECT_EQ(error_of({0, 90, 180}, {1.0 / kPi, 1.0 / kPi, 1.0 / kPi}),
            "phase table: the integral over the sphere is 4 at 550 nm; expected 1 or 12.566371 (4 pi) within 10 %");
  EXPECT_EQ(error_of({0, 90, 180}, {0, 0, 0}),
            "phase table: the integral over the sphere is 0 at 550 nm; expected 1 or 12.566371 (4 pi) within 10 %");
  Params params;
  params.atmosphere.mie_phase = MiePhase::table;
  EXPECT_FALSE(check_params(params).ok());
  params.phase_table = two_colors().value();
  EXPECT_TRUE(check_params(params).ok());
}

// The rows that shaders read, as the shaders' own code evaluates them.
TEST(Phase, ShadersEvaluateTheRows) {
  for (const Params& params : {droplets(0.1), droplets(2.0), droplets(10.0), droplets(20.0), with_table()}) {
    const PhaseRows rows = phase_rows(params, ColorMode::rgb);
    const glsl64::Medium medium = glsl64::widen(medium_from_params(params), rows.data());
    double sum = 0.0;
    int count = 0;
    for (double degrees = 0.0; degrees <= 180.0; degrees += degrees < 2.0 ? 0.013 : 0.37) {
      const double c = std::cos(degrees * kPi / 180.0);
      const glsl64::vec3 found = glsl64::mie_scattering_towards(medium, c);
      for (int i = 0; i < 3; ++i) {
        const double expected = air::phase(params, c, air::channel_wavelength_nm(params, static_cast<std::size_t>(i)));
        const double error = std::abs(found[i] / (medium.mie_scattering[i] * expected) - 1.0);
        EXPECT_LT(error, 3e-3) << degrees;
        sum += error;
        ++count;
      }
    }
    EXPECT_LT(sum / count, 2e-4);
  }
}

// The rows for the higher orders have the same mean and the same mean cosine, but no peak that the grid cannot resolve.
TEST(Phase, ResolvedRowsConserveEnergy) {
  for (const Params& params : {droplets(2.0), droplets(20.0), with_table()}) {
    const PhaseRows rows = resolved_phase_rows(params);
    const glsl64::Medium medium = glsl64::widen(medium_from_params(params), rows.data());
    const auto at = [&](double c) { return glsl64::mie_scattering_towards(medium, c).x / medium.mie_scattering.x; };
    const Moments m = moments(at);
    EXPECT_NEAR(m.total, 1.0, 0.01);
    EXPECT_NEAR(m.cosine / m.total, air::asymmetry(params, air::channel_wavelength_nm(params, 0)), 0.005);
    EXPECT_LT(at(1.0), 60.0);
  }
}

TEST(Phase, TheReferenceSamplesItsDensity) {
  const double nm[] = {680.0, 550.0, 440.0};
  for (const Params& params : {droplets(2.0), droplets(20.0), with_table()}) {
    const reference::TabulatedPhase phase(params, nm);
    // Importance sampling of 1 and of the cosine under the function at each wavelength.
    double total[3] = {}, cosine[3] = {};
    constexpr int kSamples = 200000;
    for (int i = 0; i < kSamples; ++i) {
      const double c = phase.sample((i + 0.5) / kSamples);
      double values[3];
      phase.values(c, values);
      for (int k = 0; k < 3; ++k) {
        const double weight = values[k] / phase.density(c) / kSamples;
        total[k] += weight;
        cosine[k] += weight * c;
      }
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(total[k], 1.0, 1e-3);
      EXPECT_NEAR(cosine[k], moments([&](double c) { return air::phase(params, c, nm[k]); }).cosine, 1e-3);
    }
    EXPECT_NEAR(moments([&](double c) { return phase.density(c); }).total, 1.0, 1e-3);
  }
}

}  // namespace
}  // namespace tyndall
