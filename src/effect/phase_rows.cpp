#include "effect/phase_rows.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "air/phase.hpp"
#include "effect/wavelengths.hpp"
#include "math/angles.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall {
namespace {

constexpr double kFloor = 1e-12;  // [1/sr], so that the logarithm exists
constexpr std::size_t kDegrees = 80;
constexpr std::size_t kSamples = 4000;

using Wavelengths = std::array<double, 4>;

Wavelengths wavelengths_nm(const Params& params, ColorMode color) {
  if (color == ColorMode::spectral) {
    const shared::vec4& nm = shared::kWavelengths_nm;
    return {nm.x, nm.y, nm.z, nm.w};
  }
  const double blue = air::channel_wavelength_nm(params, 2);
  return {air::channel_wavelength_nm(params, 0), air::channel_wavelength_nm(params, 1), blue, blue};
}

// The inverse of phase_coordinate() of shaders/lib/phase.glsl.
double cosine_of_node(std::size_t i) {
  const double x = static_cast<double>(i) / (shared::kPhaseNodes - 1);
  if (x <= 0.5) {
    const double s = 4.0 * x * x / std::numbers::sqrt2;
    return 1.0 - 2.0 * s * s;
  }
  const double c = 2.0 * (1.0 - x) / std::numbers::sqrt2;
  return 2.0 * c * c - 1.0;
}

template <typename Function>
void write_rows(const Function& function, PhaseRows& rows) {
  rows.resize(shared::kPhaseNodes);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double cosine = cosine_of_node(i);
    const auto value = [&](std::size_t channel) { return std::log(std::max(function(cosine, channel), kFloor)); };
    rows[i] = {value(0), value(1), value(2), value(3)};
  }
}

// Calls body(degree, value of the Legendre polynomial).
template <typename Body>
void for_each_degree(double cosine, const Body& body) {
  double before = 0.0;
  double now = 1.0;
  for (std::size_t l = 0; l < kDegrees; ++l) {
    body(l, now);
    const auto n = static_cast<double>(l);
    const double after = ((2.0 * n + 1.0) * cosine * now - n * before) / (n + 1.0);
    before = now;
    now = after;
  }
}

// Returns the coefficients of the Legendre series of the phase function at a wavelength, multiplied by the filter.
std::array<double, kDegrees> series(const Params& params, double wavelength_nm) {
  std::array<double, kDegrees> out = {};
  // The midpoint rule over the square root of the half angle's sine, whose nodes are dense in the forward peak.
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double x = (static_cast<double>(i) + 0.5) / kSamples;
    const double cosine = 1.0 - 2.0 * x * x * x * x;
    const double part = 8.0 * x * x * x / kSamples * air::phase(params, cosine, wavelength_nm);
    for_each_degree(cosine, [&](std::size_t l, double legendre) { out[l] += part * legendre; });
  }
  const double total = 2.0 * kPi * out[0];
  for (std::size_t l = 0; l < kDegrees; ++l) {
    const auto n = static_cast<double>(l);
    out[l] *= (n + 0.5) / total * std::exp(-std::pow(n * (n + 1.0) / 450.0, 1.5));
  }
  return out;
}

}  // namespace

PhaseRows phase_rows(const Params& params, ColorMode color) {
  PhaseRows rows;
  phase_rows(params, color, rows);
  return rows;
}

void phase_rows(const Params& params, ColorMode color, PhaseRows& rows) {
  rows.clear();
  if (!air::tabulated(params.atmosphere)) return;
  const Wavelengths nm = wavelengths_nm(params, color);
  write_rows([&](double cosine, std::size_t channel) { return air::phase(params, cosine, nm[channel]); }, rows);
}

PhaseRows resolved_phase_rows(const Params& params) {
  if (!air::tabulated(params.atmosphere)) return {};
  const Wavelengths nm = wavelengths_nm(params, params.scattering.color);
  std::array<std::array<double, kDegrees>, 4> moments;
  for (std::size_t c = 0; c < 4; ++c) moments[c] = series(params, nm[c]);
  PhaseRows rows;
  const auto function = [&](double cosine, std::size_t channel) {
    double sum = 0.0;
    for_each_degree(cosine, [&](std::size_t l, double legendre) { sum += moments[channel][l] * legendre; });
    return sum;
  };
  write_rows(function, rows);
  return rows;
}

bool same_phase(const Params& a, const Params& b) {
  if (a.atmosphere.mie_phase != b.atmosphere.mie_phase) return false;
  switch (a.atmosphere.mie_phase) {
    case MiePhase::draine: return a.atmosphere.droplet_diameter_um == b.atmosphere.droplet_diameter_um;
    case MiePhase::table:
      return a.phase_table == b.phase_table || (a.phase_table && b.phase_table && *a.phase_table == *b.phase_table);
    default: return true;
  }
}

}  // namespace tyndall
