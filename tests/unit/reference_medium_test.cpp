// The path tracer's medium: coefficients, density integrals, phase functions and their sampling, lines.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/atmosphere.hpp"
#include "reference/glow.hpp"
#include "reference/line.hpp"
#include "reference/random.hpp"
#include "reference_oracle.hpp"

namespace {

using tyndall::MiePhase;
using tyndall::Params;
using tyndall::Vec3;
using namespace tyndall::reference;

TEST(ReferenceMedium, DerivesCoefficients) {
  Params p;
  const Atmosphere air(p);
  // Known values. The sea-level zenith transmittance is (0.925, 0.861, 0.747) with another ozone profile, (0.930,
  // 0.874, 0.747) without ozone.
  EXPECT_NEAR(air.rayleigh_scattering[0], 5.8045e-6, 1e-10);
  EXPECT_NEAR(air.rayleigh_scattering[1], 1.35629e-5, 1e-10);
  EXPECT_NEAR(air.rayleigh_scattering[2], 3.31126e-5, 1e-10);
  EXPECT_DOUBLE_EQ(air.mie_scattering[1], 2e-5);
  EXPECT_NEAR(air.mie_extinction[1], 2.2e-5, 1e-12);
  p.atmosphere.ozone_absorption = Vec3(0.0F);
  const Atmosphere dry(p);
  const double zenith[3] = {0.930, 0.874, 0.747};
  for (std::size_t c = 0; c < 3; ++c) {
    const Amounts columns =
        dry.density_integrals_to_top(0.0, dry.radius_m, dry.top_radius_m, dry.density(dry.radius_m));
    EXPECT_NEAR(dry.transmittance(columns, c), zenith[c], 6e-4);
  }
}

TEST(ReferenceMedium, TakesCustomCoefficients) {
  Params p;
  p.atmosphere.custom_coefficients = true;
  p.atmosphere.aerosol_density = 2.0F;
  p.atmosphere.aerosol_absorption = 7.0F;  // must be ignored
  p.atmosphere.mie_scattering = Vec3(1e-5F, 2e-5F, 4e-5F);
  p.atmosphere.mie_absorption = Vec3(1e-6F, 0.0F, 3e-6F);
  const Atmosphere air(p);
  EXPECT_NEAR(air.rayleigh_scattering[2], 33.1e-6, 1e-11);
  EXPECT_NEAR(air.mie_scattering[0], 2e-5, 1e-11);
  EXPECT_NEAR(air.mie_extinction[0], 2.2e-5, 1e-11);
  EXPECT_NEAR(air.mie_extinction[2], 8.6e-5, 1e-11);
}

// Compares the density integrals of one species at a time with quadrature of the definition.
void expect_columns(const Params& params, double tolerance) {
  const Atmosphere air(params);
  const oracle::Air rayleigh = oracle::air_of(params, 1.0, 0.0, 0.0, 0.0);
  const oracle::Air mie = oracle::air_of(params, 0.0, 0.0, 1.0, 0.0);
  const oracle::Air ozone = oracle::air_of(params, 0.0, 0.0, 0.0, 1.0);
  const double vertical[3] = {rayleigh.rayleigh_height, mie.mie_height, ozone.ozone_half_width};
  Generator random(3);
  for (int i = 0; i < 60; ++i) {
    const double u = random.uniform(), v = random.uniform();
    const double h = air.height_m * u * u * u, cosine = i % 2 == 0 ? v : v * v * v * v;
    const double r = air.radius_m + h, s = r * cosine, tangent2 = r * r - s * s;
    const double s_top = std::sqrt(air.top_radius_m * air.top_radius_m - tangent2);
    const Amounts columns = air.density_integrals_to_top(tangent2, s, s_top, air.density(r));
    const oracle::Point from = {0.0, 0.0, r}, towards = {std::sqrt(1.0 - cosine * cosine), 0.0, cosine};
    // Errors are relative to the integral, or to the vertical integral where the former is small.
    const auto error = [&](double got, const oracle::Air& of, double scale) {
      const double expected = of.depth(from, towards, s_top - s, 4000);
      return std::abs(got - expected) / std::max(expected, 0.1 * scale);
    };
    EXPECT_LT(error(columns.rayleigh, rayleigh, vertical[0]), tolerance) << h << " m, cosine " << cosine;
    EXPECT_LT(error(columns.mie, mie, vertical[1]), tolerance) << h << " m, cosine " << cosine;
    // The kinks of the ozone profile limit the accuracy of the quadrature.
    EXPECT_LT(error(columns.ozone, ozone, vertical[2]), 1e-5) << h << " m, cosine " << cosine;
  }
}

TEST(ReferenceMedium, DensityIntegralsMatchQuadrature) { expect_columns(Params{}, 1e-6); }

TEST(ReferenceMedium, DensityIntegralsMatchQuadratureInOtherMedia) {
  Params p;
  p.planet.radius_m = 1e6F;
  p.atmosphere.height_m = 50000.0F;
  p.atmosphere.rayleigh_scale_height_m = 30000.0F;
  p.atmosphere.mie_scale_height_m = 300.0F;
  p.atmosphere.ozone_centre_m = 5000.0F;       // the ground cuts the layer
  p.atmosphere.ozone_half_width_m = 90000.0F;  // and so does the top
  expect_columns(p, 5e-6);
}

TEST(ReferenceMedium, PhaseFunctionsAreNormalised) {
  for (const MiePhase kind : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein}) {
    for (const double g : {-0.5, 0.0, 0.3, 0.76, 0.95}) {
      const MiePhaseFunction phase(kind, g);
      double norm = 0.0, mean = 0.0;
      oracle::integrate(-1.0, 1.0, 4000, [&](double c, double dc) {
        norm += 2.0 * oracle::kPi * phase(c) * dc;
        mean += 2.0 * oracle::kPi * phase(c) * c * dc;
      });
      EXPECT_NEAR(norm, 1.0, 1e-9);
      const double expected = kind == MiePhase::henyey_greenstein ? g : 3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g));
      EXPECT_NEAR(mean, expected, 1e-9);  // Cornette and Shanks (1992), equation 9
    }
  }
}

// Returns Pearson's chi-square of sampled cosines in 40 bins of equal width against the integral of the phase function.
template <typename Phase, typename Sample>
double chi_square(Phase&& phase, Sample&& sample) {
  constexpr int kBins = 40, kCount = 200000;
  std::vector<int> hits(kBins);
  for (int i = 0; i < kCount; ++i) {
    const double c = sample();
    EXPECT_LE(std::abs(c), 1.0);
    ++hits[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>((c + 1.0) * 0.5 * kBins)))];
  }
  double chi2 = 0.0;
  for (int b = 0; b < kBins; ++b) {
    double expected = 0.0;
    oracle::integrate(-1.0 + 2.0 * b / kBins, -1.0 + 2.0 * (b + 1) / kBins, 20,
                      [&](double c, double dc) { expected += 2.0 * oracle::kPi * kCount * phase(c) * dc; });
    const double miss = hits[static_cast<std::size_t>(b)] - expected;
    chi2 += miss * miss / expected;
  }
  return chi2;
}

TEST(ReferenceMedium, SamplesFollowThePhaseFunctions) {
  Generator random(11);
  const auto uniform = [&] { return random.uniform(); };
  constexpr double kLimit = 78.0;  // 39 degrees of freedom: exceeded once in 4000 runs
  EXPECT_LT(chi_square(rayleigh_phase, [&] { return sample_rayleigh(uniform()); }), kLimit);
  for (const MiePhase kind : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein}) {
    for (const double g : {-0.4, 0.0, 0.76, 0.9}) {
      const MiePhaseFunction phase(kind, g);
      EXPECT_LT(chi_square(phase, [&] { return phase.sample(uniform(), uniform); }), kLimit) << g;
    }
  }
}

TEST(ReferenceMedium, SamplesFollowTheGlow) {
  Generator random(13);
  const Vec up = normalized({0.3, -0.2, 0.9}), sun = normalized({0.9, 0.1, -0.5});
  const Glow glow(up, sun);
  ASSERT_GT(glow.fraction, 0.0);
  EXPECT_EQ(Glow(up, up).fraction, 0.0);
  // Compare the moments of the direction that follow from the density with those of samples.
  constexpr int kCount = 400000;
  double norm = 0.0, expected[3] = {}, sampled[3] = {};
  for (int i = 0; i < kCount; ++i) {
    const double turn = 2.0 * oracle::kPi * random.uniform();
    // Directions are uniform around the glow's axis, in even steps of the cosine.
    const Vec w = around(glow.axis, 2.0 * (i + random.uniform()) / kCount - 1.0, std::cos(turn), std::sin(turn));
    const double weight = 4.0 * oracle::kPi * glow.density(w) / kCount;
    const Vec v = glow.sample(random.uniform(), turn, [&] { return random.uniform(); });
    EXPECT_GE(dot(v, up), -1e-12);
    norm += weight;
    expected[0] += weight * dot(w, up);
    expected[1] += weight * dot(w, glow.axis);
    expected[2] += weight * dot(w, up) * dot(w, up);
    sampled[0] += dot(v, up) / kCount;
    sampled[1] += dot(v, glow.axis) / kCount;
    sampled[2] += dot(v, up) * dot(v, up) / kCount;
  }
  EXPECT_NEAR(norm, 1.0, 0.01);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k], expected[k], 0.01 * expected[k] + 1e-3);
}

TEST(ReferenceMedium, DirectionsAroundAnAxis) {
  Generator random(5);
  for (int i = 0; i < 200; ++i) {
    const double z = i == 0 ? -1.0 : 2.0 * random.uniform() - 1.0;
    const Vec axis = normalized({std::sqrt(1.0 - z * z) * 0.6, std::sqrt(1.0 - z * z) * 0.8, z});
    const double c = 2.0 * random.uniform() - 1.0, turn = 6.0 * random.uniform();
    const Vec w = around(axis, c, std::cos(turn), std::sin(turn));
    const Vec opposite = around(axis, c, -std::cos(turn), -std::sin(turn));
    EXPECT_NEAR(dot(w, axis), c, 1e-12);
    EXPECT_NEAR(length(w + opposite * 1.0 + axis * (-2.0 * c)), 0.0, 1e-12);
  }
}

TEST(ReferenceMedium, InvertsOpticalDepth) {
  const Params params;
  const Atmosphere air(params);
  Generator random(8);
  for (int i = 0; i < 3000; ++i) {
    const double u = random.uniform(), z = 2.0 * random.uniform() - 1.0;
    const double cosine = i % 3 == 0 ? z : 0.1 * z;
    const Line line(air, {0.0, 0.0, air.radius_m + air.height_m * u * u},
                    {std::sqrt(1.0 - cosine * cosine), 0.0, cosine});
    const std::size_t channel = static_cast<std::size_t>(i) % 3;
    const double total = air.exponential_depth(line.total(), channel);
    const double wanted = total * random.uniform();
    const LinePoint p = line.invert(channel, wanted);
    EXPECT_GE(p.s, line.start());
    EXPECT_LE(p.s, line.end());
    EXPECT_NEAR(air.exponential_depth(line.travelled(p), channel), wanted, 1e-7 * total)
        << "altitude " << air.height_m * u * u << " cosine " << cosine;
  }
}

TEST(ReferenceMedium, ShadowHidesTheSun) {
  const Params params;
  const Atmosphere air(params);
  Generator random(9);
  int shadowed = 0;
  for (int i = 0; i < 400; ++i) {
    const double cosine = 2.0 * random.uniform() - 1.0, sun_cosine = 0.6 * random.uniform() - 0.5;
    const double turn = 6.3 * random.uniform();
    const Line line(air, {0.0, 0.0, air.radius_m + 79000.0 * random.uniform()},
                    {std::sqrt(1.0 - cosine * cosine), 0.0, cosine});
    const Vec sun = around({0.0, 0.0, 1.0}, sun_cosine, std::cos(turn), std::sin(turn));
    const Interval shadow = line.shadow(sun, air.radius_m);
    for (int k = 0; k < 20; ++k) {
      const double s = line.start() + (line.end() - line.start()) * random.uniform();
      const LinePoint p = line.point(s);
      Amounts through;
      const bool lit = sunward_integrals(air, line.position(s), p.r, p.density, sun, through);
      EXPECT_EQ(lit, !(s > shadow.from && s < shadow.to));
      shadowed += lit ? 0 : 1;
    }
  }
  EXPECT_GT(shadowed, 500);
}

TEST(ReferenceMedium, SobolPointsAreStratified) {
  Generator random(2);
  constexpr int kLog2 = 8, kCount = 1 << kLog2;
  const SobolBlock block(kLog2, random);
  std::vector<std::vector<double>> x(SobolBlock::kDimensions);
  for (int d = 0; d < SobolBlock::kDimensions; ++d) {
    std::vector<int> strata(kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      x[static_cast<std::size_t>(d)].push_back(block(d, i, random));
      ++strata[static_cast<std::size_t>(x[static_cast<std::size_t>(d)].back() * kCount)];
    }
    for (const int n : strata) EXPECT_EQ(n, 1) << "dimension " << d;
  }
  // The first two dimensions form a (0, 8, 2) net: one point in every elementary interval of area 1/256.
  for (int split = 0; split <= kLog2; ++split) {
    std::vector<int> cells(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      const int a = static_cast<int>(x[0][i] * (1 << split)), b = static_cast<int>(x[1][i] * (kCount >> split));
      ++cells[static_cast<std::size_t>(a) * (kCount >> split) + static_cast<std::size_t>(b)];
    }
    for (const int n : cells) EXPECT_EQ(n, 1) << "split " << split;
  }
}

}  // namespace
