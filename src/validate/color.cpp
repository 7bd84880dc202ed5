#include "validate/color.hpp"

#include <algorithm>
#include <cmath>

#include "files/text.hpp"
#include "math/angles.hpp"
#include "reference/spectrum.hpp"
#include "validate/parts.hpp"
#include "validate/plot.hpp"

namespace tyndall::validate {
namespace {

using files::concat;

// Darker rays have no luminance to compare.
constexpr double kDarkest = 1.0e-9;
// Luminance of white over the mean luminance of a sky, for CIELAB: the eye is adapted to the sky as middle grey.
constexpr double kWhiteOverMean = 1.0 / 0.18;

std::array<double, 2> uv_of(const std::array<double, 3>& xyz) {
  const double sum = xyz[0] + 15.0 * xyz[1] + 3.0 * xyz[2];
  return {4.0 * xyz[0] / sum, 9.0 * xyz[1] / sum};
}

// Returns CIELAB for D65 white of the given luminance (CIE 15:2004).
std::array<double, 3> lab_of(const std::array<double, 3>& xyz, double white) {
  constexpr std::array<double, 3> kD65 = {0.95047, 1.0, 1.08883};
  std::array<double, 3> f = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / (kD65[i] * white);
    constexpr double kKnee = 6.0 / 29.0;
    f[i] = t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
  }
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

// Returns the hue angle of a and b in degrees, 0 to 360.
double hue(double a, double b) {
  if (a == 0.0 && b == 0.0) return 0.0;
  const double angle = std::atan2(b, a) / kRadPerDeg;
  return angle < 0.0 ? angle + 360.0 : angle;
}

double luminance(const Color& color) { return xyz_of(color)[1]; }

// Returns the mean luminance of the reference for a sun, for the adaptation of the eye.
double mean_luminance(const ColorTest& test, double sun_elevation_deg) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < test.rays.size(); ++i) {
    if (test.rays[i].sun_elevation_deg != sun_elevation_deg) continue;
    sum += luminance(test.reference[i]);
    count += 1.0;
  }
  return sum / count;
}

bool in_band(double value, const ColorBand& band) { return value >= band.low_deg && value <= band.high_deg; }

}  // namespace

std::array<double, 3> xyz_of(const Color& color) {
  // IEC 61966-2-1.
  constexpr double kRows[3][3] = {
      {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
  std::array<double, 3> out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += kRows[i][k] * color[k];
  }
  return out;
}

double ciede2000(const std::array<double, 3>& lab_a, const std::array<double, 3>& lab_b) {
  const auto power7 = [](double x) { return std::pow(x, 7.0); };
  constexpr double k25 = 6103515625.0;  // 25 to the power of 7
  const double mean_chroma = 0.5 * (std::hypot(lab_a[1], lab_a[2]) + std::hypot(lab_b[1], lab_b[2]));
  const double g = 0.5 * (1.0 - std::sqrt(power7(mean_chroma) / (power7(mean_chroma) + k25)));
  const double a1 = (1.0 + g) * lab_a[1];
  const double a2 = (1.0 + g) * lab_b[1];
  const double c1 = std::hypot(a1, lab_a[2]);
  const double c2 = std::hypot(a2, lab_b[2]);
  const double h1 = hue(a1, lab_a[2]);
  const double h2 = hue(a2, lab_b[2]);
  double turn = c1 * c2 == 0.0 ? 0.0 : h2 - h1;
  if (turn > 180.0) turn -= 360.0;
  if (turn < -180.0) turn += 360.0;
  const double d_hue = 2.0 * std::sqrt(c1 * c2) * std::sin(0.5 * turn * kRadPerDeg);
  const double mean_l = 0.5 * (lab_a[0] + lab_b[0]);
  const double mean_c = 0.5 * (c1 + c2);
  double mean_h = h1 + h2;
  if (c1 * c2 != 0.0) {
    const bool far = std::abs(h1 - h2) > 180.0;
    mean_h = !far ? 0.5 * mean_h : mean_h < 360.0 ? 0.5 * (mean_h + 360.0) : 0.5 * (mean_h - 360.0);
  }
  const auto cosine = [](double degrees) { return std::cos(degrees * kRadPerDeg); };
  const double t = 1.0 - 0.17 * cosine(mean_h - 30.0) + 0.24 * cosine(2.0 * mean_h) +
                   0.32 * cosine(3.0 * mean_h + 6.0) - 0.20 * cosine(4.0 * mean_h - 63.0);
  const double spread = (mean_h - 275.0) / 25.0;
  const double rotation = 2.0 * std::sqrt(power7(mean_c) / (power7(mean_c) + k25)) *
                          std::sin(60.0 * std::exp(-spread * spread) * kRadPerDeg);
  const double off = (mean_l - 50.0) * (mean_l - 50.0);
  const double l = (lab_b[0] - lab_a[0]) / (1.0 + 0.015 * off / std::sqrt(20.0 + off));
  const double c = (c2 - c1) / (1.0 + 0.045 * mean_c);
  const double h = d_hue / (1.0 + 0.015 * mean_c * t);
  return std::sqrt(std::max(l * l + c * c + h * h - rotation * c * h, 0.0));
}

ColorError color_error(const Color& found, const Color& expected, double white) {
  const std::array<double, 3> a = xyz_of(found);
  const std::array<double, 3> b = xyz_of(expected);
  const std::array<double, 2> uv_a = uv_of(a);
  const std::array<double, 2> uv_b = uv_of(b);
  return {std::abs(a[1] / b[1] - 1.0), std::hypot(uv_a[0] - uv_b[0], uv_a[1] - uv_b[1]),
          ciede2000(lab_of(a, white), lab_of(b, white))};
}

RayQuery ColorRay::query() const {
  return {0.0, (90.0 - view_elevation_deg) * kRadPerDeg, (90.0 - sun_elevation_deg) * kRadPerDeg,
          azimuth_deg * kRadPerDeg, false};
}

std::vector<ColorRay> color_rays() {
  std::vector<ColorRay> out;
  for (const double sun : {60.0, 30.0, 14.0, 10.0, 7.0, 4.0, 2.0, 1.0, 0.0, -2.0, -4.0, -6.0}) {
    for (const double view : {2.0, 5.0, 10.0, 30.0, 60.0}) {
      for (const double azimuth : {5.0, 90.0, 180.0}) out.push_back({sun, view, azimuth});
    }
  }
  return out;
}

Result<ColorPart> run_color_part(const Params& params, const std::vector<ColorModel>& models, std::uint64_t samples,
                                 std::uint64_t seed, int orders, PartIndex part,
                                 const std::function<void(double)>& progress) {
  const std::vector<ColorRay> rays = color_rays();
  std::vector<RayQuery> queries;
  std::vector<RayQuery> chosen;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    queries.push_back(rays[i].query());
    if (i % part.count == part.index) chosen.push_back(queries.back());
  }
  reference::Options options;
  options.samples = samples;
  options.seed = seed;
  options.orders = orders;
  options.first = part.index;
  options.stride = part.count;
  const reference::VisibleSpectrum spectrum = reference::visible_spectrum_in_rec709();
  double sun = 0.0;
  for (const reference::Bin& bin : reference::visible_spectrum()) sun += bin.xyz[1];
  const auto traced =
      reference::trace_spectrum(params, {spectrum.nm, spectrum.weights}, queries, options, [&](double done) {
        progress(done);
        return true;
      });
  if (!traced) return traced.error();
  ColorPart out;
  for (const reference::SpectralEstimate& estimate : traced.value()) {
    Color color = estimate.sums;
    for (double& channel : color) channel /= sun;
    // The channels are summed with positive weights, and their errors are similar.
    out.push_back({color, luminance(estimate.standard_error) / (sun * luminance(color)), {}});
  }
  if (chosen.empty()) return out;
  for (const ColorModel& model : models) {
    const Result<std::vector<Color>> answers = model.answer(params, chosen);
    if (!answers) return answers.error();
    for (std::size_t i = 0; i < out.size(); ++i) out[i].models.push_back(answers.value()[i]);
  }
  return out;
}

ColorSummary summarise(const ColorTest& test, std::size_t model, const ColorBand& sun, const ColorBand& view) {
  std::vector<double> y, uv, de;
  ColorSummary out;
  for (std::size_t i = 0; i < test.rays.size(); ++i) {
    const ColorRay& ray = test.rays[i];
    if (!in_band(ray.sun_elevation_deg, sun) || !in_band(ray.view_elevation_deg, view)) continue;
    if (luminance(test.reference[i]) < kDarkest) continue;
    const double white = kWhiteOverMean * mean_luminance(test, ray.sun_elevation_deg);
    const ColorError error = color_error(test.answers[model][i], test.reference[i], white);
    y.push_back(error.luminance);
    uv.push_back(error.chromaticity);
    de.push_back(error.difference);
    out.noise += test.noise[i];
  }
  if (!y.empty()) out.noise /= static_cast<double>(y.size());
  out.luminance = summarise(std::move(y));
  out.chromaticity = summarise(std::move(uv));
  out.difference = summarise(std::move(de));
  return out;
}

std::string color_markdown(const ColorTest& test) {
  std::string out =
      "\n## Colours of the sky at sea level\n\nThe reference follows 40 wavelengths ([spectral.md](../spectral.md)). "
      "Luminance: relative error in per cent. Δu′v′: distance in the\nCIE 1976 diagram. ΔE₀₀: CIEDE2000, for an eye "
      "that is adapted to the mean luminance of the sky as middle grey. `noise` is the mean\nstandard error of the "
      "reference's luminance.\n\n"
      "| `scattering.color` | sun | view | luminance, mean | 95 % | Δu′v′, mean | 95 % | ΔE₀₀, mean | 95 % | noise |\n"
      "|---|---|---|--:|--:|--:|--:|--:|--:|--:|\n";
  for (std::size_t m = 0; m < test.models.size(); ++m) {
    for (const ColorBand& sun : kColorSuns) {
      for (const ColorBand& view : kColorViews) {
        const ColorSummary s = summarise(test, m, sun, view);
        if (s.luminance.count == 0) continue;
        out += concat({"| ",  test.models[m],
                       " | ", sun.name,
                       " | ", view.name,
                       " | ", fixed(100.0 * s.luminance.mean, 2),
                       " | ", fixed(100.0 * s.luminance.p95, 2),
                       " | ", fixed(s.chromaticity.mean, 4),
                       " | ", fixed(s.chromaticity.p95, 4),
                       " | ", fixed(s.difference.mean, 2),
                       " | ", fixed(s.difference.p95, 2),
                       " | ", fixed(100.0 * s.noise, 2),
                       " |\n"});
      }
    }
  }
  return out;
}

std::string color_json(const ColorTest& test) {
  std::string out = "\"colors\": [";
  bool first = true;
  for (std::size_t m = 0; m < test.models.size(); ++m) {
    for (const ColorBand& sun : kColorSuns) {
      for (const ColorBand& view : kColorViews) {
        const ColorSummary s = summarise(test, m, sun, view);
        if (s.luminance.count == 0) continue;
        const auto number = [](double value) { return std::isfinite(value) ? files::number_text(value) : "null"; };
        out += concat({first ? "\n" : ",\n",
                       "  {\"color\": ",
                       files::quoted_text(test.models[m]),
                       ", \"sun\": ",
                       files::quoted_text(sun.name),
                       ", \"view\": ",
                       files::quoted_text(view.name),
                       ", \"rays\": ",
                       std::to_string(s.luminance.count),
                       ", \"luminance_mean\": ",
                       number(s.luminance.mean),
                       ", \"luminance_p95\": ",
                       number(s.luminance.p95),
                       ", \"duv_mean\": ",
                       number(s.chromaticity.mean),
                       ", \"duv_p95\": ",
                       number(s.chromaticity.p95),
                       ", \"de2000_mean\": ",
                       number(s.difference.mean),
                       ", \"de2000_p95\": ",
                       number(s.difference.p95),
                       ", \"noise\": ",
                       number(s.noise),
                       "}"});
        first = false;
      }
    }
  }
  return out + "\n ]";
}

}  // namespace tyndall::validate
