// The path tracer on a planet so large that its atmosphere is a plane-parallel layer with known solutions: the closed
// form of single scattering, the integral equation of isotropic scattering, reciprocity, and conservation of energy.
// Conservation of energy is also tested on a small planet.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "reference/path_tracer.hpp"

namespace {

using tyndall::MiePhase;
using tyndall::Params;
using tyndall::Vec3;
using namespace tyndall::reference;
using tyndall::RayQuery;

constexpr double kPi = std::numbers::pi;
constexpr float kHeight_m = 1000.0F, kScaleHeight_m = 200.0F;

// Returns a layer of aerosol only, with the given optical depths and single scattering albedos.
Params slab(const std::array<double, 3>& depth, const std::array<double, 3>& albedo, double g = 0.0,
            MiePhase phase = MiePhase::henyey_greenstein) {
  Params p;
  p.planet.radius_m = 1e8F;
  p.atmosphere.height_m = kHeight_m;
  p.atmosphere.mie_scale_height_m = kScaleHeight_m;
  p.atmosphere.custom_coefficients = true;
  p.atmosphere.rayleigh_scattering = Vec3(0.0F);
  p.atmosphere.ozone_absorption = Vec3(0.0F);
  p.atmosphere.mie_g = static_cast<float>(g);
  p.atmosphere.mie_phase = phase;
  const double column_m = kScaleHeight_m * -std::expm1(-kHeight_m / kScaleHeight_m);
  const auto coefficient = [&](std::size_t c, double share) { return static_cast<float>(depth[c] * share / column_m); };
  p.atmosphere.mie_scattering = {coefficient(0, albedo[0]), coefficient(1, albedo[1]), coefficient(2, albedo[2])};
  p.atmosphere.mie_absorption = {coefficient(0, 1.0 - albedo[0]), coefficient(1, 1.0 - albedo[1]),
                                 coefficient(2, 1.0 - albedo[2])};
  return p;
}

RayQuery up(double cosine, double sun_cosine, double azimuth = 0.0) {
  return {0.0, std::acos(cosine), std::acos(sun_cosine), azimuth, false};
}
RayQuery down(double cosine, double sun_cosine, double azimuth = 0.0) {
  return {kHeight_m, kPi - std::acos(cosine), std::acos(sun_cosine), azimuth, false};
}
RayQuery sky(double sun_cosine) { return {0.0, 0.0, std::acos(sun_cosine), 0.0, true}; }

std::vector<Estimate> run(const Params& p, const std::vector<RayQuery>& queries, std::uint64_t samples, int orders,
                          bool by_order = false) {
  Options options;
  options.samples = samples;
  options.orders = orders;
  options.by_order = by_order;
  options.threads = 2;
  const auto result = trace(p, queries, options);
  if (!result.ok()) {
    ADD_FAILURE() << result.error().message;
    return std::vector<Estimate>(queries.size());
  }
  return result.value();
}

// Isotropic scattering in a layer over a Lambertian ground, order by order (Chandrasekhar, Radiative
// Transfer, 1950, chapter 1): the source function is constant over each of many thin sublayers.
struct IsotropicSlab {
  double depth, albedo, ground, sun_cosine;
  std::vector<std::vector<double>> source;  // [order][sublayer]
  std::vector<double> glow;                 // [order]: radiance of the ground

  static double e1(double x) { return -std::expint(-x); }
  static double e2(double x) { return x > 0.0 ? std::exp(-x) - x * e1(x) : 1.0; }
  static double e3(double x) { return x > 0.0 ? 0.5 * (std::exp(-x) - x * e2(x)) : 0.5; }

  static constexpr std::size_t kLayers = 300;
  [[nodiscard]] double edge(std::size_t i) const { return depth * static_cast<double>(i) / kLayers; }

  void solve(int orders) {
    for (int n = 0; n < orders; ++n) {
      std::vector<double> s(kLayers);
      for (std::size_t i = 0; i < kLayers; ++i) {
        const double t = 0.5 * (edge(i) + edge(i + 1));
        if (n == 0) {
          s[i] = albedo / (4.0 * kPi) * std::exp(-t / sun_cosine);
          continue;
        }
        double sum = e2(depth - t) * glow.back();
        for (std::size_t j = 0; j < kLayers; ++j) {
          const double a = std::abs(t - edge(j)), b = std::abs(t - edge(j + 1));
          sum += source.back()[j] * (i == j ? 2.0 - e2(a) - e2(b) : std::abs(e2(a) - e2(b)));
        }
        s[i] = 0.5 * albedo * sum;
      }
      const double lit = n == 0 ? sun_cosine * std::exp(-depth / sun_cosine) : sky_irradiance(n - 1);
      glow.push_back(ground / kPi * lit);
      source.push_back(s);
    }
  }
  [[nodiscard]] double sky_irradiance(int n) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < kLayers; ++j) {
      sum += 2.0 * kPi * source[static_cast<std::size_t>(n)][j] * (e3(depth - edge(j + 1)) - e3(depth - edge(j)));
    }
    return sum;
  }
  [[nodiscard]] double looking_up(int n, double mu) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < kLayers; ++j) {
      sum += source[static_cast<std::size_t>(n)][j] *
             (std::exp((edge(j + 1) - depth) / mu) - std::exp((edge(j) - depth) / mu));
    }
    return sum;
  }
  [[nodiscard]] double looking_down(int n, double mu) const {
    double sum = glow[static_cast<std::size_t>(n)] * std::exp(-depth / mu);
    for (std::size_t j = 0; j < kLayers; ++j) {
      sum += source[static_cast<std::size_t>(n)][j] * (std::exp(-edge(j) / mu) - std::exp(-edge(j + 1) / mu));
    }
    return sum;
  }
};

TEST(ReferenceSlab, SingleScatteringClosedForm) {
  const std::array<double, 3> depth = {0.03, 0.8, 12.0}, albedo = {1.0, 0.7, 0.9};
  const double mu = 0.4, mu0 = 0.75, g = 0.76;
  const auto estimates = run(slab(depth, albedo, g), {up(mu, mu0, 0.7), down(mu, mu0, 0.7)}, 65536, 1);
  const double sines = std::sqrt((1.0 - mu * mu) * (1.0 - mu0 * mu0)) * std::cos(0.7);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto phase = [&](double x) { return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * x, 1.5)); };
    const double through =
        albedo[c] * phase(mu * mu0 + sines) * mu0 / (mu0 - mu) * (std::exp(-depth[c] / mu0) - std::exp(-depth[c] / mu));
    const double back =
        albedo[c] * phase(-mu * mu0 + sines) * mu0 / (mu0 + mu) * -std::expm1(-depth[c] * (1.0 / mu0 + 1.0 / mu));
    EXPECT_NEAR(estimates[0].radiance[c] / through, 1.0, 1e-3);
    EXPECT_NEAR(estimates[1].radiance[c] / back, 1.0, 1e-3);
    EXPECT_LT(estimates[0].standard_error[c], 5e-4 * through);
    EXPECT_NEAR(estimates[0].transmittance[c], std::exp(-depth[c] / mu), 2e-5);
  }
}

// Compares every order of a layer, thin to thick, over black and bright ground.
void expect_isotropic(const std::array<double, 3>& depth, const std::array<double, 3>& albedo, double ground,
                      int orders, std::uint64_t samples) {
  Params p = slab(depth, albedo);
  p.planet.ground_albedo = tyndall::Vec3(static_cast<float>(ground));
  const double mu0 = 0.6, mu = 0.35;
  const auto estimates = run(p, {up(mu, mu0), down(mu, mu0), sky(mu0)}, samples, orders, true);
  for (std::size_t c = 0; c < 3; ++c) {
    IsotropicSlab exact{depth[c], albedo[c], static_cast<double>(p.planet.ground_albedo.x), mu0, {}, {}};
    exact.solve(orders);
    for (int which = 0; which < 3; ++which) {
      const Estimate& e = estimates[static_cast<std::size_t>(which)];
      double total = 0.0;
      std::vector<double> expected;
      for (int n = 0; n < orders; ++n) {
        expected.push_back(which == 0   ? exact.looking_up(n, mu)
                           : which == 1 ? exact.looking_down(n, mu)
                                        : exact.sky_irradiance(n));
        total += expected.back();
      }
      for (int n = 0; n < orders; ++n) {
        // The last term allows for the smallest orders, whose errors are not normally distributed.
        const auto at = static_cast<std::size_t>(n);
        EXPECT_NEAR(e.order_radiance[at][c], expected[at],
                    4.5 * e.order_standard_error[at][c] + 1e-3 * expected[at] + 2e-5 * total)
            << "channel " << c << " query " << which << " order " << n + 1;
      }
      EXPECT_NEAR(e.radiance[c], total, 4.0 * e.standard_error[c] + 3e-4 * total)
          << "channel " << c << " query " << which;
      EXPECT_LT(e.standard_error[c], 4e-2 * total);
    }
  }
}

TEST(ReferenceSlab, IsotropicOrdersOverBlackGround) {
  expect_isotropic({0.1, 1.0, 3.0}, {1.0, 0.9, 1.0}, 0.0, 8, 65536);
}
TEST(ReferenceSlab, IsotropicOrdersOverBrightGround) {
  expect_isotropic({0.05, 0.6, 2.0}, {0.95, 1.0, 0.5}, 0.8, 8, 65536);
}
TEST(ReferenceSlab, IsotropicThickLayer) { expect_isotropic({6.0, 6.0, 6.0}, {1.0, 0.99, 0.8}, 0.0, 24, 16384); }

// Helmholtz reciprocity: the radiance divided by the cosine of the sun's zenith angle does not change when sun and eye
// are exchanged.
TEST(ReferenceSlab, Reciprocity) {
  for (const MiePhase phase : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein}) {
    Params p = slab({0.3, 1.0, 3.0}, {0.9, 1.0, 0.8}, 0.76, phase);
    p.planet.ground_albedo = tyndall::Vec3(0.3F);
    p.atmosphere.rayleigh_scattering = Vec3(1e-3F, 2e-3F, 3e-3F);
    p.atmosphere.rayleigh_scale_height_m = 400.0F;
    const double a = 0.9, b = 0.3;
    const auto e = run(p, {down(a, b, 1.0), down(b, a, 1.0)}, 65536, 10);
    for (std::size_t c = 0; c < 3; ++c) {
      const double left = e[0].radiance[c] / b, right = e[1].radiance[c] / a;
      const double sigma = std::hypot(e[0].standard_error[c] / b, e[1].standard_error[c] / a);
      EXPECT_NEAR(left, right, 4.0 * sigma + 1e-5 * left);
      EXPECT_LT(sigma, 1e-2 * left);
    }
  }
}

// Without absorption, the sunlight leaves upwards or reaches the ground.
TEST(ReferenceSlab, ConservesEnergy) {
  const std::array<double, 3> depth = {0.2, 0.7, 1.5};
  const double mu0 = 0.55;
  for (const MiePhase phase : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein}) {
    const Params p = slab(depth, {1.0, 1.0, 1.0}, 0.6, phase);
    // Gauss-Legendre in the cosine (8 nodes) times 12 equal steps of azimuth (symmetric, so half of the circle).
    const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    const double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    std::vector<RayQuery> queries;
    std::vector<double> weights;
    for (int i = 0; i < 8; ++i) {
      const double mu = 0.5 * (1.0 + (i < 4 ? node[i] : -node[i - 4]));
      for (int k = 0; k < 12; ++k) {
        queries.push_back(down(mu, mu0, kPi * (k + 0.5) / 12.0));
        weights.push_back(0.5 * weight[i % 4] * mu * 2.0 * kPi / 12.0);
      }
    }
    const auto estimates = run(p, queries, 512, 30);
    const auto below = run(p, {sky(mu0)}, 32768, 30);
    for (std::size_t c = 0; c < 3; ++c) {
      double out = mu0 * std::exp(-depth[c] / mu0) + below[0].radiance[c];
      double variance = std::pow(below[0].standard_error[c], 2);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        out += weights[i] * estimates[i].radiance[c];
        variance += std::pow(weights[i] * estimates[i].standard_error[c], 2);
      }
      EXPECT_NEAR(out / mu0, 1.0, 4.0 * std::sqrt(variance) / mu0 + 1e-3) << "channel " << c;
      EXPECT_LT(std::sqrt(variance), 6e-3 * mu0);
    }
  }
}

// A small spherical planet with white ground and a medium that does not absorb: all sunlight that enters its disc must
// come out, integrated over all directions and positions. Covers the night side with its importance sampling.
TEST(ReferenceSlab, WhiteFurnaceOfAWholePlanet) {
  Params p = slab({0.1, 0.4, 1.0}, {1.0, 1.0, 1.0}, 0.4, MiePhase::cornette_shanks);
  p.planet.radius_m = 10000.0F;
  p.planet.ground_albedo = tyndall::Vec3(1.0F);
  p.atmosphere.height_m = 8000.0F;
  p.atmosphere.mie_scale_height_m = 2000.0F;
  for (float* v : {&p.atmosphere.mie_scattering.x, &p.atmosphere.mie_scattering.y, &p.atmosphere.mie_scattering.z}) {
    *v *= 0.1F;
  }
  p.atmosphere.rayleigh_scattering = Vec3(1e-5F, 3e-5F, 1e-4F);
  p.atmosphere.rayleigh_scale_height_m = 3000.0F;
  const double radius = p.planet.radius_m, top = radius + p.atmosphere.height_m;
  const auto height_m = static_cast<double>(p.atmosphere.height_m);

  // The rays are uniform over all directions and, for each direction, over the planet's disc.
  constexpr int kBatches = 16, kRays = 250;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<RayQuery> queries;
  for (int batch = 0; batch < kBatches; ++batch) {
    const double shift[3] = {uniform(random), uniform(random), uniform(random)};
    for (int i = 0; i < kRays; ++i) {  // Roberts' additive recurrence in three dimensions
      const auto at = [&](int k, double step) { return std::fmod(shift[k] + i * step, 1.0); };
      const double disc = at(0, 0.8191725133961645), sun = at(1, 0.6710436067037893), turn = at(2, 0.5497004779019703);
      queries.push_back(
          {height_m, kPi - std::asin(std::sqrt(disc)), std::acos(1.0 - 2.0 * sun), 2.0 * kPi * turn, false});
    }
  }
  const auto estimates = run(p, queries, 32, 50);

  for (std::size_t c = 0; c < 3; ++c) {
    // Sunlight may also pass the planet without being scattered. It is given by the transmittance of the rays that do
    // not hit the ground, whose impact parameter exceeds the radius.
    double mean = 0.0, square = 0.0;
    for (int batch = 0; batch < kBatches; ++batch) {
      double sum = 0.0;
      for (int i = 0; i < kRays; ++i) {
        const auto at = static_cast<std::size_t>(batch) * kRays + static_cast<std::size_t>(i);
        const bool through = top * std::sin(queries[at].view_zenith_rad) > radius;
        sum += 4.0 * kPi * estimates[at].radiance[c] + (through ? estimates[at].transmittance[c] : 0.0);
      }
      sum /= kRays;
      mean += sum / kBatches;
      square += sum * sum / kBatches;
    }
    const double sigma = std::sqrt((square - mean * mean) / (kBatches - 1));
    EXPECT_NEAR(mean, 1.0, 4.0 * sigma + 1e-3) << "channel " << c;
    EXPECT_LT(sigma, 5e-3);
  }
}

}  // namespace
