#include "reference/atmosphere.hpp"

#include <algorithm>
#include <numbers>

#include "air/coefficients.hpp"
#include "air/phase.hpp"

namespace tyndall::reference {
namespace {

// Gauss-Legendre nodes and weights on [0; 1], by Newton's method on Legendre's polynomial.
template <std::size_t N>
struct GaussLegendre {
  std::array<double, N> node, weight;
  GaussLegendre() {
    for (std::size_t i = 0; i < N; ++i) {
      double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (static_cast<double>(N) + 0.5));
      double slope = 1.0;
      for (int iteration = 0; iteration < 100; ++iteration) {
        double p0 = 1.0, p1 = x;
        for (std::size_t k = 2; k <= N; ++k) {
          const double kk = static_cast<double>(k);
          const double p2 = ((2.0 * kk - 1.0) * x * p1 - (kk - 1.0) * p0) / kk;
          p0 = p1;
          p1 = p2;
        }
        slope = static_cast<double>(N) * (x * p1 - p0) / (x * x - 1.0);
        const double step = p1 / slope;
        x -= step;
        if (std::abs(step) < 1e-15) break;
      }
      node[i] = 0.5 * (1.0 - x);
      weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

// Returns (1/d) * integral of exp(-(h(u) - h(0)) / scale_height) du along an upward path of length d that starts at
// position s >= 0 of a line. The quadrature panels end where the exponent reaches one of kExponents.
double mean_relative_density(const GaussLegendre<10>& rule, double r, double s, double d, double scale_height) {
  constexpr std::array<double, 8> kExponents = {0.25, 1.0, 2.5, 5.0, 10.0, 18.0, 28.0, 42.0};
  double sum = 0.0, from = 0.0;
  for (const double exponent : kExponents) {
    const double rise = exponent * scale_height;
    const double reach = rise * (2.0 * r + rise);
    const double to = std::min(d, reach / (s + std::sqrt(s * s + reach)));
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double u = from + (to - from) * rule.node[i];
      const double gained = u * (2.0 * s + u);  // r(u)^2 - r^2
      const double climb = gained / (r + std::sqrt(r * r + gained));
      sum += (to - from) * rule.weight[i] * std::exp(-climb / scale_height);
    }
    if (to >= d) break;
    from = to;
  }
  return sum / d;
}

// Returns the integral of (r - base) ds between two positions of a line, where r is the distance to the centre.
double integrate_radius(double tangent2, double r0, double s0, double r1, double s1, double base) {
  const double turned = tangent2 > 0.0 ? tangent2 * std::log((s1 + r1) / (s0 + r0)) : 0.0;
  return 0.5 * (s1 * r1 - s0 * r0 + turned) - base * (s1 - s0);
}

}  // namespace

Atmosphere::Atmosphere(const Params& params, double lowest_m, std::span<const double> wavelengths_nm) {
  const AtmosphereParams& a = params.atmosphere;
  radius_m = params.planet.radius_m;
  height_m = a.height_m;
  top_radius_m = radius_m + height_m;
  base_radius_m_ = radius_m + std::min(lowest_m, 0.0);
  rayleigh_scale_height_m = a.rayleigh_scale_height_m;
  mie_scale_height_m = a.mie_scale_height_m;
  if (!wavelengths_nm.empty()) channels = wavelengths_nm.size();
  if (air::tabulated(a)) {
    std::vector<double> nm(wavelengths_nm.begin(), wavelengths_nm.end());
    for (std::size_t c = nm.size(); c < channels; ++c) nm.push_back(air::channel_wavelength_nm(params, c));
    mie_phase = MiePhaseFunction(std::make_shared<const TabulatedPhase>(params, nm));
  } else {
    mie_phase = MiePhaseFunction(a.mie_phase, a.mie_g);
  }
  for (std::size_t c = 0; c < channels; ++c) {
    const air::Coefficients channel =
        wavelengths_nm.empty() ? air::in_channel(params, c) : air::at_wavelength(params, wavelengths_nm[c]);
    rayleigh_scattering[c] = channel.rayleigh_scattering;
    mie_scattering[c] = channel.mie_scattering;
    mie_extinction[c] = channel.mie_extinction;
    ozone_absorption[c] = channel.ozone_absorption;
    ground_albedo[c] = channel.ground_albedo;
  }

  ozone_half_width_m_ = a.ozone_half_width_m;
  ozone_centre_m_ = radius_m + a.ozone_centre_m;
  ozone_low_m_ = ozone_centre_m_ - ozone_half_width_m_;
  ozone_high_m_ = ozone_centre_m_ + ozone_half_width_m_;
  has_ozone_ = *std::max_element(ozone_absorption.begin(), ozone_absorption.end()) > 0.0;
  build_table();
  opaque_radius_m = find_opaque_radius();
}

double Atmosphere::find_opaque_radius() const {
  constexpr double kDepth = 1.5;  // optical depth of the middle channel along the whole grazing ray
  double low = radius_m, high = top_radius_m;
  for (int i = 0; i < 40; ++i) {
    const double r = 0.5 * (low + high);
    const double s_top = std::sqrt((top_radius_m - r) * (top_radius_m + r));
    PerChannel depth{};
    const Amounts integrals = exponential_density_integrals(r * r, 0.0, s_top, density(r));
    for (std::size_t c = 0; c < channels; ++c) depth[c] = 2.0 * exponential_depth(integrals, c);
    std::sort(depth.begin(), depth.begin() + static_cast<std::ptrdiff_t>(channels));
    (depth[channels / 2] > kDepth ? low : high) = r;
  }
  return low;
}

double Atmosphere::ozone_density_integral(double tangent2, double s, double s_top) const {
  const double r = std::sqrt(tangent2 + s * s);
  if (!has_ozone_ || r >= ozone_high_m_) return 0.0;
  const auto position = [&](double radius) { return std::sqrt(std::max(0.0, s * s + (radius - r) * (radius + r))); };
  double integral = 0.0, r0 = r, s0 = s;
  if (r0 < ozone_low_m_) {
    if (ozone_low_m_ >= top_radius_m) return 0.0;
    s0 = position(ozone_low_m_);
    r0 = ozone_low_m_;
  }
  if (r0 < ozone_centre_m_) {
    const bool cut = ozone_centre_m_ >= top_radius_m;
    const double r1 = cut ? top_radius_m : ozone_centre_m_;
    const double s1 = cut ? s_top : position(r1);
    integral += integrate_radius(tangent2, r0, s0, r1, s1, ozone_low_m_);
    if (cut) return integral / ozone_half_width_m_;
    r0 = r1;
    s0 = s1;
  }
  const bool cut = ozone_high_m_ >= top_radius_m;
  const double r1 = cut ? top_radius_m : ozone_high_m_;
  const double s1 = cut ? s_top : position(r1);
  integral -= integrate_radius(tangent2, r0, s0, r1, s1, ozone_high_m_);
  return std::max(0.0, integral / ozone_half_width_m_);
}

void Atmosphere::build_table() {
  // The mean density varies over sqrt(scale height / height) of the range of path lengths.
  const double narrow = std::sqrt(std::min({1.0, rayleigh_scale_height_m / height_m, mie_scale_height_m / height_m}));
  const double span = top_radius_m - base_radius_m_;
  nh_ = static_cast<std::size_t>(std::ceil(127.0 * span / height_m)) + 1;
  nx_ = static_cast<std::size_t>(std::clamp(24.0 / narrow, 64.0, 1024.0));
  table_.resize(nh_ * nx_);
  const GaussLegendre<10> rule;
  for (std::size_t ih = 0; ih < nh_; ++ih) {
    const double h = span * static_cast<double>(ih) / static_cast<double>(nh_ - 1);
    const double r = base_radius_m_ + h;
    const double shortest = span - h;
    const double longest2 = shortest * (top_radius_m + r);
    const double longest = std::sqrt(longest2);
    for (std::size_t ix = 0; ix < nx_; ++ix) {
      MeanDensity& entry = table_[ih * nx_ + ix];
      if (ih == nh_ - 1) {
        entry = {1.0, 1.0};  // a path of length 0
        continue;
      }
      const double d = shortest + (longest - shortest) * static_cast<double>(ix) / static_cast<double>(nx_ - 1);
      const double s = std::max(0.0, 0.5 * (longest2 / d - d));  // (s_top - s)(s_top + s) = longest^2
      entry.rayleigh = mean_relative_density(rule, r, s, d, rayleigh_scale_height_m);
      entry.mie = mean_relative_density(rule, r, s, d, mie_scale_height_m);
    }
  }
}

Amounts Atmosphere::exponential_density_integrals(double tangent2, double s, double s_top,
                                                  const Amounts& density) const {
  const double r = std::sqrt(tangent2 + s * s);
  const double shortest = std::max(0.0, top_radius_m - r);
  const double d = s_top - s;
  if (!(d > 0.0) || !(shortest > 0.0)) return {};
  const double longest = std::sqrt(shortest * (top_radius_m + r));

  // Cubic Lagrange interpolation over 4 x 4 nodes. The stencil is shifted inwards at the edges.
  const auto weights = [](double at, std::size_t count, std::size_t& first) {
    const auto node = static_cast<std::size_t>(at);  // at >= 0
    first = std::min(node > 0 ? node - 1 : 0, count - 4);
    const double base = static_cast<double>(first);
    const double t = at - base, t1 = t - 1.0, t2 = t - 2.0, t3 = t - 3.0;
    return std::array<double, 4>{t1 * t2 * t3 * (-1.0 / 6.0), t * t2 * t3 * 0.5, t * t1 * t3 * -0.5,
                                 t * t1 * t2 * (1.0 / 6.0)};
  };
  const double y = (1.0 - shortest / (top_radius_m - base_radius_m_)) * static_cast<double>(nh_ - 1);
  const double x = (longest > shortest ? (d - shortest) / (longest - shortest) : 0.0) * static_cast<double>(nx_ - 1);
  std::size_t iy = 0, ix = 0;
  const std::array<double, 4> wy = weights(std::max(0.0, y), nh_, iy);
  const std::array<double, 4> wx = weights(std::clamp(x, 0.0, static_cast<double>(nx_ - 1)), nx_, ix);
  double rayleigh = 0.0, mie = 0.0;
  for (std::size_t j = 0; j < 4; ++j) {
    const MeanDensity* row = &table_[(iy + j) * nx_ + ix];
    rayleigh +=
        wy[j] * (wx[0] * row[0].rayleigh + wx[1] * row[1].rayleigh + wx[2] * row[2].rayleigh + wx[3] * row[3].rayleigh);
    mie += wy[j] * (wx[0] * row[0].mie + wx[1] * row[1].mie + wx[2] * row[2].mie + wx[3] * row[3].mie);
  }
  return {d * density.rayleigh * rayleigh, d * density.mie * mie, 0.0};
}

}  // namespace tyndall::reference
