// Plots as SVG: axes with ticks, lines, points with error bars, a key. Text and axes take the colour of the
// text around the picture. The same input gives the same bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::validate {

struct Axis {
  std::string label;
  double min = 0.0;
  double max = 1.0;
  bool logarithmic = false;  // then 0 < min < max
};

struct Point {
  double x = 0.0;
  double y = 0.0;
  double error = 0.0;  // half the length of its bar; 0: none
};

enum class Mark { line, dashed, dotted, points, circles };

struct Series {
  std::string label;   // in the key; none when empty
  std::string colour;  // "#1f77b4"
  Mark mark = Mark::line;
  std::vector<Point> points;  // lines break at values that are not finite
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
};

// The <svg> element. Lines are cut at the axes; points beyond the y axis are drawn at its ends.
[[nodiscard]] std::string to_svg(const Plot& plot);

// The decades that hold all positive values, at most `decades` of them below the largest; 0.1 to 1 without
// any.
void fit_logarithmic(Axis& axis, const std::vector<Series>& series, int decades);

// With &, <, > and quotes written so that HTML, XML and attributes take them as text.
[[nodiscard]] std::string escaped(std::string_view text);

// Fixed notation with as many decimals.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace tyndall::validate
