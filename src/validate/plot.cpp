#include "validate/plot.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "files/text.hpp"

namespace tyndall::validate {
namespace {

using files::concat;

constexpr double kWidth = 560.0, kHeight = 340.0;  // size of the picture in SVG units
constexpr double kLeft = 66.0, kRight = 14.0, kTop = 30.0, kBottom = 46.0;
constexpr double kKeyRow = 16.0;

// The mapping from values to positions in the picture.
class Scale {
 public:
  Scale(const Axis& axis, double from, double to) : axis_(axis), from_(from), to_(to) {}

  // Returns 0 to 1 within the axis.
  [[nodiscard]] double fraction(double value) const {
    if (!axis_.logarithmic) return (value - axis_.min) / (axis_.max - axis_.min);
    return std::log(std::max(value, 1e-300) / axis_.min) / std::log(axis_.max / axis_.min);
  }
  [[nodiscard]] double at(double value) const { return from_ + (to_ - from_) * std::clamp(fraction(value), -0.5, 1.5); }
  [[nodiscard]] bool is_outside(double value) const {
    return !(fraction(value) >= -1e-9 && fraction(value) <= 1.0 + 1e-9);
  }
  [[nodiscard]] double clamped(double value) const {
    return from_ + (to_ - from_) * std::clamp(fraction(value), 0.0, 1.0);
  }

 private:
  const Axis& axis_;
  double from_, to_;
};

struct Tick {
  double value;
  std::string text;  // empty for a minor tick
};

std::vector<Tick> ticks(const Axis& axis) {
  std::vector<Tick> out;
  if (axis.logarithmic) {
    const int first = static_cast<int>(std::floor(std::log10(axis.min) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(axis.max) - 1e-9));
    const int every = std::max(1, (last - first + 7) / 8);
    for (int decade = first; decade <= last; ++decade) {
      const double value = std::pow(10.0, decade);
      const bool named = (decade - first) % every == 0;
      if (value >= axis.min * 0.999 && value <= axis.max * 1.001) {
        const std::string text = decade >= -2 && decade <= 3 ? files::number_text(static_cast<float>(value))
                                                             : concat({"1e", std::to_string(decade)});
        out.push_back({value, named ? text : ""});
      }
      for (int i = 2; i < 10 && every == 1; ++i) {
        if (i * value > axis.min && i * value < axis.max) out.push_back({i * value, ""});
      }
    }
    return out;
  }
  const double rough = (axis.max - axis.min) / 7.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) {
      step = factor * power;
      break;
    }
  }
  // Use multiples of 15 and 30 for angles instead of 20 and 50.
  if (axis.label.find("deg") != std::string::npos && step > 10.0) step = step <= 20.0 ? 15.0 : 30.0;
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  for (double i = std::ceil(axis.min / step - 1e-9); i * step <= axis.max + 1e-9 * step; ++i) {
    out.push_back({i * step, fixed(i * step + 0.0, decimals)});
  }
  return out;
}

std::string text_at(double x, double y, std::string_view anchor, std::string_view text, std::string_view more = "") {
  return concat({"<text x=\"", fixed(x, 1), "\" y=\"", fixed(y, 1), "\" text-anchor=\"", anchor, "\"", more, ">",
                 escaped(text), "</text>\n"});
}

std::string line_from(double x1, double y1, double x2, double y2, std::string_view more) {
  return concat({"<line x1=\"", fixed(x1, 1), "\" y1=\"", fixed(y1, 1), "\" x2=\"", fixed(x2, 1), "\" y2=\"",
                 fixed(y2, 1), "\"", more, "/>\n"});
}

std::string axes(const Plot& plot, const Scale& x, const Scale& y) {
  const double bottom = kHeight - kBottom;
  const double right = kWidth - kRight;
  std::string out = text_at(kLeft, 18.0, "start", plot.title, " font-weight=\"bold\"");
  for (const Tick& tick : ticks(plot.x)) {
    out += line_from(x.at(tick.value), bottom, x.at(tick.value), kTop,
                     tick.text.empty() ? " class=\"small\"" : " class=\"grid\"");
    if (!tick.text.empty()) out += text_at(x.at(tick.value), bottom + 15.0, "middle", tick.text);
  }
  for (const Tick& tick : ticks(plot.y)) {
    out += line_from(kLeft, y.at(tick.value), right, y.at(tick.value),
                     tick.text.empty() ? " class=\"small\"" : " class=\"grid\"");
    if (!tick.text.empty()) out += text_at(kLeft - 6.0, y.at(tick.value) + 4.0, "end", tick.text);
  }
  out += concat({"<rect x=\"", fixed(kLeft, 1), "\" y=\"", fixed(kTop, 1), "\" width=\"", fixed(right - kLeft, 1),
                 "\" height=\"", fixed(bottom - kTop, 1), "\" class=\"frame\"/>\n"});
  out += text_at(0.5 * (kLeft + right), kHeight - 10.0, "middle", plot.x.label);
  const double middle = 0.5 * (kTop + bottom);
  return out + text_at(14.0, middle, "middle", plot.y.label,
                       concat({" transform=\"rotate(-90 14 ", fixed(middle, 1), ")\""}));
}

std::string_view dashes(Mark mark) {
  return mark == Mark::dashed ? " stroke-dasharray=\"6 3\"" : mark == Mark::dotted ? " stroke-dasharray=\"2 3\"" : "";
}

bool is_line(Mark mark) { return mark == Mark::line || mark == Mark::dashed || mark == Mark::dotted; }

std::string marker(double x, double y, const Series& series) {
  return concat({"<circle cx=\"", fixed(x, 1), "\" cy=\"", fixed(y, 1), "\" r=\"2.2\" ",
                 series.mark == Mark::circles ? "fill=\"none\" stroke=\"" : "fill=\"", series.colour, "\"/>\n"});
}

std::string drawn(const Series& series, const Axis& y_axis, const Scale& x, const Scale& y) {
  std::string out;
  if (is_line(series.mark)) {
    std::string path;
    bool open = false;
    for (const Point& point : series.points) {
      const bool drawable = std::isfinite(point.y) && (!y_axis.logarithmic || point.y > 0.0);
      if (drawable) {
        path += concat({open ? "L" : "M", fixed(x.at(point.x), 1), " ", fixed(y.at(point.y), 1)});
      }
      open = drawable;
    }
    return concat({"<path clip-path=\"url(#box)\" d=\"", path, "\" fill=\"none\" stroke=\"", series.colour,
                   "\" stroke-width=\"1.4\"", dashes(series.mark), "/>\n"});
  }
  for (const Point& point : series.points) {
    if (!std::isfinite(point.y) || x.is_outside(point.x)) continue;
    if (point.error > 0.0 && std::isfinite(point.error)) {
      out += line_from(x.clamped(point.x), y.clamped(point.y - point.error), x.clamped(point.x),
                       y.clamped(point.y + point.error), concat({" stroke=\"", series.colour, "\""}));
    }
    out += marker(x.clamped(point.x), y.clamped(point.y), series);
  }
  return out;
}

}  // namespace

std::string fixed(double value, int decimals) {
  char buffer[400];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), value, std::chars_format::fixed, decimals).ptr;
  std::string out(buffer, end);
  // Avoid "-0.00".
  if (out.starts_with('-') && out.find_first_not_of("-0.") == std::string::npos) out.erase(0, 1);
  return out;
}

std::string percent(double ratio) { return fixed(100.0 * ratio, 2); }

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

void fit_logarithmic(Axis& axis, const std::vector<Series>& series, int decades) {
  double low = 1e300;
  double high = 0.0;
  for (const Series& one : series) {
    for (const Point& point : one.points) {
      if (!std::isfinite(point.y) || point.y <= 0.0) continue;
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
  }
  axis.logarithmic = true;
  axis.max = high > 0.0 ? std::pow(10.0, std::ceil(std::log10(high))) : 1.0;
  axis.min = high > 0.0 ? std::pow(10.0, std::floor(std::log10(low))) : 0.1;
  axis.min = std::max(std::min(axis.min, 0.1 * axis.max), axis.max * std::pow(10.0, -decades));
}

std::string to_svg(const Plot& plot) {
  const Scale x(plot.x, kLeft, kWidth - kRight);
  const Scale y(plot.y, kHeight - kBottom, kTop);
  const std::size_t named = static_cast<std::size_t>(
      std::count_if(plot.series.begin(), plot.series.end(), [](const Series& s) { return !s.label.empty(); }));
  const std::size_t key_rows = (named + 1) / 2;
  const double height = kHeight + kKeyRow * static_cast<double>(key_rows) + 4.0;
  std::string out =
      concat({"<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", fixed(kWidth, 0), " ", fixed(height, 0),
              "\" role=\"img\" aria-label=\"", escaped(plot.title),
              "\" font-family=\"sans-serif\" font-size=\"12\" "
              "fill=\"currentColor\">\n<style>.grid{stroke:currentColor;opacity:.18}.small{stroke:currentColor;"
              "opacity:.07}.frame{fill:none;stroke:currentColor;opacity:.6}</style>\n<clipPath id=\"box\"><rect "
              "x=\"",
              fixed(kLeft, 1), "\" y=\"", fixed(kTop, 1), "\" width=\"", fixed(kWidth - kRight - kLeft, 1),
              "\" height=\"", fixed(kHeight - kBottom - kTop, 1), "\"/></clipPath>\n"});
  out += axes(plot, x, y);
  for (const Series& series : plot.series) out += drawn(series, plot.y, x, y);
  std::size_t index = 0;
  for (const Series& series : plot.series) {
    if (series.label.empty()) continue;
    const double row = kHeight + 6.0 + kKeyRow * static_cast<double>(index / 2);
    const double column = kLeft + (index % 2 == 0 ? 0.0 : 245.0);
    if (is_line(series.mark)) {
      out += line_from(column, row, column + 24.0, row,
                       concat({" stroke=\"", series.colour, "\" stroke-width=\"1.6\"", dashes(series.mark)}));
    } else {
      out += marker(column + 12.0, row, series);
    }
    out += text_at(column + 30.0, row + 4.0, "start", series.label);
    ++index;
  }
  return out + "</svg>\n";
}

}  // namespace tyndall::validate
