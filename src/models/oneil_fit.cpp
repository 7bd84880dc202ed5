#include "models/oneil_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tyndall::models {
namespace {

constexpr int kTerms = 5;
constexpr int kNodes = 64;

// The positive nodes of the eight-point Gauss-Legendre rule on [-1; 1], and their weights.
constexpr double kNode[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double kWeight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

// Returns the density integral over `distance` along a ray that starts at radius rho with zenith cosine c. All lengths
// are in scale heights. c may slightly exceed 1, because the altitude along the ray, sqrt(rho^2 + 2 rho c d + d^2) -
// rho, is still smooth there.
double integral_to(double rho, double c, double distance) {
  constexpr int kPanels = 24;
  const double panel = 1.0 / kPanels;
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double x = (j < 4 ? -1.0 : 1.0) * kNode[j % 4];
      const double u = (i + 0.5 + 0.5 * x) * panel;
      const double d = distance * u * u;  // concentrates the nodes where the density is high
      const double rise = d * (2.0 * rho * c + d);
      const double climb = rise / (std::sqrt(rho * rho + rise) + rho);
      sum += 0.5 * panel * kWeight[j % 4] * 2.0 * distance * u * std::exp(-climb);
    }
  }
  return sum;
}

// Returns the distance at which a ray has gained the altitude `climb`. All lengths are in scale heights.
double distance_of_climb(double rho, double c, double climb) {
  const double rise = climb * (2.0 * rho + climb);
  return rise / (rho * c + std::sqrt(rho * rho * c * c + rise));
}

struct Fit {
  std::array<double, kTerms> k = {};
  double worst = std::numeric_limits<double>::infinity();
};

// Fits a polynomial to the points (x, y) by least squares and returns its coefficients as powers of x. It is solved in
// the Chebyshev basis on [low; high], in which the normal equations are well conditioned.
std::array<double, kTerms> least_squares(const std::array<double, kNodes>& x, const std::array<double, kNodes>& y,
                                         double low, double high) {
  std::array<std::array<double, kTerms + 1>, kTerms> a = {};
  for (int i = 0; i < kNodes; ++i) {
    const double t = (2.0 * x[static_cast<std::size_t>(i)] - low - high) / (high - low);
    std::array<double, kTerms> basis = {1.0, t};
    for (std::size_t n = 2; n < kTerms; ++n) basis[n] = 2.0 * t * basis[n - 1] - basis[n - 2];
    for (std::size_t r = 0; r < kTerms; ++r) {
      for (std::size_t s = 0; s < kTerms; ++s) a[r][s] += basis[r] * basis[s];
      a[r][kTerms] += basis[r] * y[static_cast<std::size_t>(i)];
    }
  }
  for (std::size_t p = 0; p < kTerms; ++p) {
    for (std::size_t r = 0; r < kTerms; ++r) {
      if (r == p) continue;
      const double factor = a[r][p] / a[p][p];
      for (std::size_t s = p; s <= kTerms; ++s) a[r][s] -= factor * a[p][s];
    }
  }
  // Convert to powers of t in [-1; 1], then substitute t = slope x + offset.
  std::array<double, kTerms> of_t = {};
  std::array<std::array<double, kTerms>, kTerms> chebyshev = {};
  chebyshev[0][0] = 1.0;
  chebyshev[1][1] = 1.0;
  for (std::size_t n = 2; n < kTerms; ++n) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      chebyshev[n][i] = (i > 0 ? 2.0 * chebyshev[n - 1][i - 1] : 0.0) - chebyshev[n - 2][i];
    }
  }
  for (std::size_t n = 0; n < kTerms; ++n) {
    for (std::size_t i = 0; i < kTerms; ++i) of_t[i] += a[n][kTerms] / a[n][n] * chebyshev[n][i];
  }
  const double slope = 2.0 / (high - low);
  const double offset = -(low + high) / (high - low);
  std::array<double, kTerms> out = {};
  for (std::size_t i = kTerms; i-- > 0;) {  // Horner's rule over polynomials
    std::array<double, kTerms> next = {};
    for (std::size_t j = 0; j < kTerms; ++j) {
      next[j] += out[j] * offset;
      if (j + 1 < kTerms) next[j + 1] += out[j] * slope;
    }
    next[0] += of_t[i];
    out = next;
  }
  return out;
}

Fit fit_with_bend(double rho, double largest_c, double bend) {
  const auto x_of = [&](double c) { return (1.0 - c) / (1.0 + bend * c); };
  const double low = x_of(largest_c);
  const double high = 1.0;
  std::array<double, kNodes> x = {};
  std::array<double, kNodes> y = {};
  for (int i = 0; i < kNodes; ++i) {
    const double t = std::cos(std::numbers::pi * (i + 0.5) / kNodes);
    const double at = 0.5 * (low + high) + 0.5 * (high - low) * t;
    const double c = (1.0 - at) / (1.0 + bend * at);  // the map is its own inverse
    const double integral = integral_to(rho, c, distance_of_climb(rho, c, 42.0));
    x[static_cast<std::size_t>(i)] = at;
    y[static_cast<std::size_t>(i)] = std::log(integral * (1.0 + bend * c) / (1.0 + bend));
  }
  Fit out;
  out.k = least_squares(x, y, low, high);
  out.worst = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    double value = 0.0;
    for (std::size_t n = kTerms; n-- > 0;) value = value * x[i] + out.k[n];
    out.worst = std::max(out.worst, std::abs(value - y[i]));
  }
  return out;
}

}  // namespace

double exponential_density_integral(double scale_height_m, double radius_m, double altitude_m, double cosine,
                                    double top_m) {
  const double rho = (radius_m + altitude_m) / scale_height_m;
  const double climb = std::min((top_m - altitude_m) / scale_height_m, 42.0);
  if (climb <= 0.0) return 0.0;
  return scale_height_m * std::exp(-altitude_m / scale_height_m) *
         integral_to(rho, cosine, distance_of_climb(rho, cosine, climb));
}

shared::OneilScale published_scale(double scale_height_m) {
  return {static_cast<float>(scale_height_m), 0.0F, -0.00287F, 0.459F, 3.83F, -6.80F, 5.25F, 0.0F};
}

shared::OneilScale fit_scale(double scale_height_m, double radius_m, double top_m) {
  const double rho = radius_m / scale_height_m;
  const double largest_c = std::sqrt(1.0 + top_m / radius_m);  // see oneil_outward
  // This is about the ratio of the density integral of a horizontal ray to that of a vertical one. The best bend is
  // within a factor of 8 of it.
  const double steepness = integral_to(rho, 0.0, distance_of_climb(rho, 0.0, 42.0));
  double best_bend = steepness;
  Fit best;
  constexpr int kTried = 48;
  for (int i = 0; i <= kTried; ++i) {
    const double bend = steepness * std::exp2(-3.0 + 6.0 * i / kTried);
    const Fit fit = fit_with_bend(rho, largest_c, bend);
    if (fit.worst < best.worst) {
      best = fit;
      best_bend = bend;
    }
  }
  return {static_cast<float>(scale_height_m), static_cast<float>(best_bend),
          static_cast<float>(best.k[0]),      static_cast<float>(best.k[1]),
          static_cast<float>(best.k[2]),      static_cast<float>(best.k[3]),
          static_cast<float>(best.k[4]),      0.0F};
}

}  // namespace tyndall::models
