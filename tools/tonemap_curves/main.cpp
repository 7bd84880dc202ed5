// Plots the tone-mapping operators for docs/tonemapping.md at the default settings: display value, encoded as sRGB,
// over scaled luminance of a grey.
// tonemap_curves FILE.svg
#include <cmath>
#include <cstdio>

#include "files/files.hpp"
#include "tyndall/post_settings.hpp"
#include "validate/plot.hpp"

namespace tyndall {
namespace {

struct Row {
  const char* name;
  const char* colour;
  validate::Mark mark;
};
// The curves in the order of post::Operator.
constexpr Row kRows[] = {
    {"exponential", "#1f77b4", validate::Mark::line},
    {"reinhard", "#2ca02c", validate::Mark::line},
    {"reinhard-modified", "#2ca02c", validate::Mark::dashed},
    {"uncharted2", "#d62728", validate::Mark::line},
    {"filmic-alu", "#ff7f0e", validate::Mark::line},
    {"logarithmic", "#9467bd", validate::Mark::line},
    {"adaptive-logarithmic", "#9467bd", validate::Mark::dashed},
    {"agx", "#8c564b", validate::Mark::dashed},
    {"pbr-neutral", "#7f7f7f", validate::Mark::dotted},
    {"exponential-channels", "#1f77b4", validate::Mark::dotted},
};
static_assert(std::size(kRows) == post::kOperators);

double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::string curves() {
  validate::Plot plot;
  plot.title = "Tone-mapping operators, white point 3";
  plot.x = {"scaled luminance (middle grey is 0.18)", 0.001, 100.0, true};
  plot.y = {"display value, sRGB", 0.0, 1.0, false};
  for (std::uint32_t i = 0; i < post::kOperators; ++i) {
    post::TonemapSettings settings;
    settings.op = static_cast<post::Operator>(i);
    validate::Series series = {kRows[i].name, kRows[i].colour, kRows[i].mark, {}};
    for (int k = 0; k <= 200; ++k) {
      const double x = 0.001 * std::pow(1.0e5, k / 200.0);
      series.points.push_back({x, encoded(post::tonemapped(settings, 1.0, {x, x, x})[1])});
    }
    plot.series.push_back(std::move(series));
  }
  return validate::to_svg(plot) + "\n";
}

}  // namespace
}  // namespace tyndall

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: tonemap_curves FILE.svg\n", stderr);
    return 2;
  }
  const tyndall::Result<void> written = tyndall::files::write_file(argv[1], tyndall::curves());
  if (written) return 0;
  std::fprintf(stderr, "tonemap_curves: error: %s\n", written.error().message.c_str());
  return 1;
}
