// O'Neil's model against the equations of GPU Gems 2, chapter 16, implemented here with vectors and without
// shaders/lib; its scale function and its table against numerical integration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "effect/medium.hpp"
#include "models/oneil.hpp"
#include "models/oneil_fit.hpp"
#include "physics_quadrature.hpp"

namespace tyndall::models {
namespace {

using brute::Point;
using brute::Three;
constexpr double kPi = std::numbers::pi;

shared::Medium planet(double radius_m, double top_m, double rayleigh_m, double mie_m) {
  shared::Medium m = medium_from_params({});
  m.planet_radius_m = static_cast<float>(radius_m);
  m.atmosphere_height_m = static_cast<float>(top_m);
  m.rayleigh_scale_height_m = static_cast<float>(rayleigh_m);
  m.mie_scale_height_m = static_cast<float>(mie_m);
  m.ozone_absorption = {0.0F, 0.0F, 0.0F};
  return m;
}

// The planet of O'Neil's demo, with 636 km per unit.
shared::Medium demo() {
  shared::Medium m = planet(6360.0e3, 159.0e3, 39750.0, 39750.0);
  const double thickness = 159.0e3;
  const auto rayleigh = [&](double um) { return static_cast<float>(4.0 * kPi * 0.0025 / std::pow(um, 4) / thickness); };
  m.rayleigh_scattering = {rayleigh(0.650), rayleigh(0.570), rayleigh(0.475)};
  m.mie_scattering = Vec3(static_cast<float>(4.0 * kPi * 0.0010 / thickness));
  m.mie_extinction = m.mie_scattering;
  m.mie_g = 0.99F;
  return m;
}

struct Question {
  Ray ray;
  Point view, sun;  // in a frame whose y axis is the vertical
};

std::vector<Question> random_questions(int count, double top_m, double radius_m, double lowest_sun) {
  std::mt19937 engine(16);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Question> out;
  while (out.size() < static_cast<std::size_t>(count)) {
    const double altitude = (out.size() % 3 == 2 ? 1.0 + 9.0 * uniform(engine) : 0.95 * uniform(engine)) * top_m;
    // From space, choose rays that hit the planet's disc or the atmosphere around it.
    const double rim = altitude > top_m ? std::asin((radius_m + top_m) / (radius_m + altitude)) : kPi;
    const double view = kPi - rim * std::sqrt(uniform(engine));
    const double sun = std::acos(lowest_sun + (1.0 - lowest_sun) * uniform(engine));
    const double azimuth = 2.0 * kPi * uniform(engine);
    Question q;
    q.ray = ray_from_angles(altitude, view, sun, azimuth);
    q.view = {std::sin(view), std::cos(view), 0.0};
    q.sun = {std::sin(sun) * std::cos(azimuth), std::cos(sun), std::sin(sun) * std::sin(azimuth)};
    out.push_back(q);
  }
  return out;
}

double length(const Point& p) { return std::sqrt(brute::dot(p, p)); }

struct Segment {
  double start = 0.0, end = 0.0;
  bool on_ground = false;
};

Segment segment(const shared::Medium& m, const Point& origin, const Point& view) {
  const double b = brute::dot(origin, view);
  const double r2 = brute::dot(origin, origin);
  const double outer = static_cast<double>(m.planet_radius_m) + static_cast<double>(m.atmosphere_height_m);
  const double inner = m.planet_radius_m;
  const double at_top = b * b - r2 + outer * outer;
  const double at_ground = b * b - r2 + inner * inner;
  Segment out;
  if (at_top <= 0.0) return out;
  out.start = std::max(-b - std::sqrt(at_top), 0.0);
  out.end = std::max(-b + std::sqrt(at_top), 0.0);
  if (at_ground > 0.0 && b < 0.0) {
    out.end = -b - std::sqrt(at_ground);
    out.on_ground = true;
  }
  return out;
}

// Evaluates the published equations in units of the atmosphere's thickness and with the published constants. Rays that
// leave the atmosphere follow the listing for the sky, and rays to the ground the reversed look-ups that the text
// describes.
Answer printed(const shared::Medium& m, const Question& q, int samples) {
  const double inner = m.planet_radius_m;
  const double scale = 1.0 / static_cast<double>(m.atmosphere_height_m);
  const double depth[] = {static_cast<double>(m.rayleigh_scale_height_m) * scale,
                          static_cast<double>(m.mie_scale_height_m) * scale};
  const auto scale_function = [&](int s, double c) {
    const double x = 1.0 - c;
    return depth[s] * std::exp(-0.00287 + x * (0.459 + x * (3.83 + x * (-6.80 + x * 5.25))));
  };
  const Point origin = {0.0, inner + q.ray.altitude_m, 0.0};
  const Segment part = segment(m, origin, q.view);
  Answer out;
  out.transmittance = {1.0, 1.0, 1.0};
  if (part.end <= part.start) return out;
  const auto density = [&](int s, const Point& p) { return std::exp((inner - length(p)) * scale / depth[s]); };
  const auto column = [&](int s, const Point& p, const Point& d, double sign) {
    return density(s, p) * scale_function(s, sign * brute::dot(p, d) / length(p));
  };
  const Point a = brute::along(origin, q.view, part.start);
  const auto between = [&](int s, const Point& p) {
    return part.on_ground ? column(s, p, q.view, -1.0) - column(s, a, q.view, -1.0)
                          : column(s, a, q.view, 1.0) - column(s, p, q.view, 1.0);
  };
  const Three rayleigh = brute::of(m.rayleigh_scattering);
  const Three mie = brute::of(m.mie_scattering);
  const Three mie_out = brute::of(m.mie_extinction);
  const double thickness = 1.0 / scale;
  const double step = (part.end - part.start) / samples;
  for (int i = 0; i < samples; ++i) {
    const Point p = brute::along(origin, q.view, part.start + (i + 0.5) * step);
    double tau[2];
    for (int s = 0; s < 2; ++s) tau[s] = between(s, p) + column(s, p, q.sun, 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const double arrives = std::exp(-thickness * (rayleigh[c] * tau[0] + mie_out[c] * tau[1])) * step;
      out.radiance[c] += arrives * (rayleigh[c] * density(0, p) * brute::rayleigh_phase(q.ray.cos_view_sun) +
                                    mie[c] * density(1, p) * brute::mie_phase(m, q.ray.cos_view_sun));
    }
  }
  const Point b = brute::along(origin, q.view, part.end);
  for (std::size_t c = 0; c < 3; ++c) {
    out.transmittance[c] = std::exp(-thickness * (rayleigh[c] * between(0, b) + mie_out[c] * between(1, b)));
  }
  return out;
}

// Returns the largest difference of a channel, relative to the brightest channel.
double error_of(const std::array<double, 3>& value, const std::array<double, 3>& truth) {
  double worst = 0.0;
  for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(value[c] - truth[c]));
  const double brightest = std::max({truth[0], truth[1], truth[2]});
  return brightest > 1.0e-30 ? worst / brightest : worst;
}

TEST(Oneil, PrintedEquationsAreASpecialCase) {
  for (const shared::Medium& m :
       {demo(), planet(6360.0e3, 80.0e3, 7994.0, 1200.0), planet(1000.0e3, 25.0e3, 6250.0, 6250.0)}) {
    for (const int samples : {2, 5, 16}) {
      OneilSettings settings;
      settings.integral_method = OneilIntegralMethod::published;
      settings.samples = static_cast<std::uint32_t>(samples);
      const OneilModel model = make_oneil(m, settings);
      for (const Question& q : random_questions(700, m.atmosphere_height_m, m.planet_radius_m, -0.4)) {
        const Answer truth = printed(m, q, samples);
        // On other planets the polynomial amplifies some rays without bound.
        if (*std::max_element(truth.transmittance.begin(), truth.transmittance.end()) > 1.0e6) continue;
        const Answer answer = oneil(model, q.ray);
        EXPECT_LT(error_of(answer.radiance, truth.radiance), 0.001) << q.ray.altitude_m << " " << q.ray.cos_view_zenith;
        EXPECT_LT(error_of(answer.transmittance, truth.transmittance), 0.001);
      }
    }
  }
}

// The sums are compared with the same sums over numerical density integrals. They differ by the error of the fit, times
// the optical depth.
TEST(Oneil, FittedDensityIntegralsGiveTheSameSums) {
  const shared::Medium m = planet(6360.0e3, 120.0e3, 7994.0, 1200.0);
  OneilSettings settings;
  const OneilModel model = make_oneil(m, settings);
  shared::Medium open = m;  // integrals practically to infinity
  open.atmosphere_height_m = 400.0e3F;
  const double R = m.planet_radius_m;
  int compared = 0;
  for (const Question& q : random_questions(150, m.atmosphere_height_m, R, 0.02)) {
    const Point origin = {0.0, R + q.ray.altitude_m, 0.0};
    const Segment part = segment(m, origin, q.view);
    if (part.end <= part.start) continue;
    Three truth = {};
    bool lit = true;
    for (int i = 0; i < 5; ++i) {
      const double d = part.start + (i + 0.5) * (part.end - part.start) / 5;
      const Point p = brute::along(origin, q.view, d);
      const double h = length(p) - R;
      const double cos_sun = brute::dot(p, q.sun) / length(p);
      lit = lit && cos_sun > 0.0;
      const double from = length(brute::along(origin, q.view, part.start)) - R;
      const double mu = brute::dot(brute::along(origin, q.view, part.start), q.view) / (R + from);
      const Three eye = brute::column(open, from, mu, d - part.start, 1.0e-6);
      const Three sun = brute::column(open, h, cos_sun, brute::far_crossing(open, h, cos_sun, 400.0e3), 1.0e-6);
      const Three tau = brute::optical_depth(m, {eye[0] + sun[0], eye[1] + sun[1], 0.0});
      for (std::size_t c = 0; c < 3; ++c) {
        truth[c] +=
            std::exp(-tau[c]) * (part.end - part.start) / 5 *
            (brute::of(m.rayleigh_scattering)[c] * std::exp(-h / 7994.0) * brute::rayleigh_phase(q.ray.cos_view_sun) +
             brute::of(m.mie_scattering)[c] * std::exp(-h / 1200.0) * brute::mie_phase(m, q.ray.cos_view_sun));
      }
    }
    if (!lit) continue;  // the model spreads its points over the lit part only, so they differ from these
    EXPECT_LT(error_of(oneil(model, q.ray).radiance, truth), 0.001) << q.ray.altitude_m << " " << q.ray.cos_view_zenith;
    ++compared;
  }
  EXPECT_GT(compared, 80);
}

struct Planet {
  const char* name;
  double radius_m, top_m, height_m, worst_at_sea_level, worst;
};

// The bounds are the measured errors, rounded up.
TEST(Oneil, ScaleFunctionFitsAnyPlanet) {
  for (const Planet& p : {Planet{"demo", 6360.0e3, 159.0e3, 39750.0, 1.0e-4, 3.0e-4},
                          Planet{"Earth, air", 6360.0e3, 80.0e3, 7994.0, 1.5e-4, 1.5e-4},
                          Planet{"Earth, aerosol", 6360.0e3, 80.0e3, 1200.0, 1.5e-4, 1.5e-4},
                          Planet{"Mars", 3390.0e3, 120.0e3, 11100.0, 1.0e-4, 2.0e-4},
                          Planet{"Titan", 2575.0e3, 400.0e3, 40000.0, 1.0e-4, 1.0e-3},
                          Planet{"small", 100.0e3, 20.0e3, 5000.0, 1.0e-4, 8.0e-3},
                          Planet{"giant", 70000.0e3, 500.0e3, 27000.0, 1.5e-4, 1.5e-4}}) {
    const shared::Medium m = planet(p.radius_m, p.top_m, p.height_m, p.height_m);
    const OneilModel model = make_oneil(m, {});
    EXPECT_LT(model.rayleigh_at_sea_level.worst, p.worst_at_sea_level) << p.name;
    EXPECT_LT(model.rayleigh.worst, p.worst) << p.name;
    EXPECT_LE(model.rayleigh.rms, model.rayleigh.worst) << p.name;
    // Compare the errors that the model reports with an independent numerical integration.
    shared::Medium open = m;
    open.atmosphere_height_m = static_cast<float>(40.0 * p.height_m);
    const shared::OneilScale& s = model.constants.rayleigh;
    for (const double c : {0.0, 0.01, 0.03, 0.1, 0.3, 0.7, 1.0}) {
      const double truth = brute::column(open, 0.0, c, brute::far_crossing(open, 0.0, c, 40.0 * p.height_m), 1.0e-9)[0];
      const double b = 1.0 / (1.0 + static_cast<double>(s.bend) * c);
      const double x = (1.0 - c) * b;
      const double k[] = {s.k0, s.k1, s.k2, s.k3, s.k4};
      double sum = 0.0;
      for (int i = 4; i >= 0; --i) sum = sum * x + k[i];
      const double found =
          static_cast<double>(s.scale_height_m) * (1.0 + static_cast<double>(s.bend)) * b * std::exp(sum);
      EXPECT_NEAR(found / truth, 1.0, p.worst_at_sea_level + 1.0e-6) << p.name << " " << c;
    }
  }
}

// The known errors are +1.6 % at the zenith and within 2.5 % down to the horizontal, for integrals that end at the top.
TEST(Oneil, PrintedPolynomialFitsItsOwnPlanetOnly) {
  const shared::OneilScale s = published_scale(39750.0);
  const auto value = [&](double c) {
    const double x = 1.0 - c;
    return 39750.0 * std::exp(static_cast<double>(s.k0) +
                              x * (static_cast<double>(s.k1) +
                                   x * (static_cast<double>(s.k2) +
                                        x * (static_cast<double>(s.k3) + x * static_cast<double>(s.k4)))));
  };
  EXPECT_NEAR(value(1.0) / exponential_density_integral(39750.0, 6360.0e3, 0.0, 1.0, 159.0e3), 1.016, 0.001);
  for (int i = 0; i <= 100; ++i) {
    const double c = 0.01 * i;
    EXPECT_NEAR(value(c) / exponential_density_integral(39750.0, 6360.0e3, 0.0, c, 159.0e3), 1.0, 0.026) << c;
  }
  OneilSettings settings;
  settings.integral_method = OneilIntegralMethod::published;
  EXPECT_GT(make_oneil(planet(6360.0e3, 80.0e3, 7994.0, 1200.0), settings).rayleigh.worst, 0.5);
}

TEST(Oneil, TableConvergesToQuadrature) {
  const shared::Medium m = planet(6360.0e3, 80.0e3, 7994.0, 1200.0);
  IntegralError last = {1.0, 1.0};
  for (const std::uint32_t size : {32U, 64U, 128U, 256U}) {
    OneilSettings settings;
    settings.integral_method = OneilIntegralMethod::table;
    settings.table_size = size;
    const OneilModel model = make_oneil(m, settings);
    EXPECT_LT(model.mie.worst, 0.45 * last.worst) << size;  // second-order convergence would give 0.25
    EXPECT_LT(model.mie.rms, 0.45 * last.rms) << size;
    last = model.mie;
    if (size == 128) {
      EXPECT_LT(model.rayleigh.worst, 0.0015);
      EXPECT_LT(model.mie.worst, 0.006);
    }
  }
}

TEST(Oneil, ManyPointsGiveTheIntegral) {
  const shared::Medium m = planet(6360.0e3, 80.0e3, 7994.0, 1200.0);
  for (const OneilIntegralMethod method : {OneilIntegralMethod::computed, OneilIntegralMethod::table}) {
    for (const bool by_density : {false, true}) {
      OneilSettings settings;
      settings.integral_method = method;
      settings.samples = 600;
      settings.table_size = 256;
      settings.space_by_density = by_density;
      const OneilModel model = make_oneil(m, settings);
      for (const Question& q : random_questions(60, m.atmosphere_height_m, m.planet_radius_m, -0.1)) {
        const Answer truth = single_scattering(m, q.ray);
        EXPECT_LT(error_of(oneil(model, q.ray).radiance, truth.radiance), 0.005)
            << q.ray.altitude_m << " " << q.ray.cos_view_zenith;
      }
    }
  }
}

TEST(Oneil, FivePointsSpacedByDensityAreBetterThanFiveUniformOnes) {
  const shared::Medium m = planet(6360.0e3, 80.0e3, 7994.0, 1200.0);
  double sum[2] = {};
  for (const bool by_density : {false, true}) {
    OneilSettings settings;
    settings.space_by_density = by_density;
    const OneilModel model = make_oneil(m, settings);
    for (const Question& q : random_questions(300, m.atmosphere_height_m, m.planet_radius_m, 0.05)) {
      const Answer truth = single_scattering(m, q.ray);
      if (truth.radiance[2] > 0.0) sum[by_density ? 1 : 0] += error_of(oneil(model, q.ray).radiance, truth.radiance);
    }
  }
  EXPECT_LT(sum[1], 0.3 * sum[0]);
}

TEST(Oneil, NoJumpAcrossTheTop) {
  for (const OneilIntegralMethod method :
       {OneilIntegralMethod::computed, OneilIntegralMethod::published, OneilIntegralMethod::table}) {
    const shared::Medium m = demo();
    OneilSettings settings;
    settings.integral_method = method;
    const OneilModel model = make_oneil(m, settings);
    const double top = m.atmosphere_height_m;
    for (int i = 1; i < 60; ++i) {
      const double view = kPi / 2.0 + 0.01 + i * 0.025;  // downwards; upwards there is almost no medium
      const Answer below = oneil(model, ray_from_angles(top - 0.5, view, 1.0, 0.6));
      const Answer above = oneil(model, ray_from_angles(top + 0.5, view, 1.0, 0.6));
      EXPECT_LT(error_of(above.radiance, below.radiance), 0.002) << view;
      EXPECT_LT(error_of(above.transmittance, below.transmittance), 0.002) << view;
    }
  }
}

TEST(Oneil, TheAtmosphereContinuesBelowSeaLevel) {
  const shared::Medium m = planet(6360.0e3, 80.0e3, 7994.0, 1200.0);
  for (const OneilIntegralMethod method : {OneilIntegralMethod::computed, OneilIntegralMethod::table}) {
    OneilSettings settings;
    settings.integral_method = method;
    const OneilModel model = make_oneil(m, settings);
    for (const double altitude : {-430.0, -2000.0, -11000.0}) {
      // The density integral of a vertical ray is that of an exponential.
      const Answer up = oneil(model, ray_from_angles(altitude, 0.0, 0.8, 0.5));
      const auto integral = [&](double scale_height) {
        return scale_height * (std::exp(-altitude / scale_height) - std::exp(-80.0e3 / scale_height));
      };
      const Three expected = {static_cast<double>(m.rayleigh_scattering.x) * integral(7994.0) +
                                  static_cast<double>(m.mie_extinction.x) * integral(1200.0),
                              static_cast<double>(m.rayleigh_scattering.y) * integral(7994.0) +
                                  static_cast<double>(m.mie_extinction.y) * integral(1200.0),
                              static_cast<double>(m.rayleigh_scattering.z) * integral(7994.0) +
                                  static_cast<double>(m.mie_extinction.z) * integral(1200.0)};
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(-std::log(std::max(up.transmittance[c], 1e-300)), std::min(expected[c], 690.0), 0.01 * expected[c])
            << altitude;
      }
      // No direction is brighter than the sunlight that the phase function can send towards the eye.
      for (double zenith = 0.05; zenith < kPi; zenith += 0.1) {
        const Answer answer = oneil(model, ray_from_angles(altitude, zenith, 0.8, 0.5));
        for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(answer.radiance[c], 1.0) << altitude << " " << zenith;
      }
    }
  }
}

TEST(Oneil, NightIsDarkAndNothingIsUndefined) {
  const shared::Medium media[] = {demo(), planet(6360.0e3, 80.0e3, 7994.0, 1200.0),
                                  planet(2575.0e3, 400.0e3, 40000.0, 25000.0), planet(1000.0, 1000.0, 10.0, 1.0e6),
                                  planet(1.0e8, 1.0e7, 1.0e6, 10.0)};
  for (const shared::Medium& m : media) {
    for (const OneilIntegralMethod method :
         {OneilIntegralMethod::computed, OneilIntegralMethod::published, OneilIntegralMethod::table}) {
      for (const bool by_density : {false, true}) {
        OneilSettings settings;
        settings.integral_method = method;
        settings.space_by_density = by_density;
        settings.table_size = 32;
        const OneilModel model = make_oneil(m, settings);
        for (const Question& q : random_questions(200, m.atmosphere_height_m, m.planet_radius_m, -1.0)) {
          const Answer answer = oneil(model, q.ray);
          for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(answer.radiance[c]) && answer.radiance[c] >= 0.0);
            EXPECT_TRUE(std::isfinite(answer.transmittance[c]) && answer.transmittance[c] >= 0.0);
            // The ray goes down and away from the sun, so the planet hides the sun from all of it.
            if (method != OneilIntegralMethod::published && q.ray.cos_sun_zenith < -0.999 &&
                q.ray.cos_view_zenith < -0.99) {
              EXPECT_EQ(answer.radiance[c], 0.0);
            }
          }
        }
        const Answer night =
            oneil(model, ray_from_angles(0.1 * static_cast<double>(m.atmosphere_height_m), 3.0, 3.1, 0.5));
        EXPECT_LT(night.radiance[0], 1.0e-12);
      }
    }
  }
}

}  // namespace
}  // namespace tyndall::models
