// Plots as SVG: axes with ticks, lines, points with error bars, a legend. Text and axes use the colour of the
// surrounding text. The same input gives the same bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::validate {

struct Axis {
  std::string label;
  double min = 0.0;
  double max = 1.0;
  bool logarithmic = false;  // requires 0 < min < max
};

struct Point {
  double x = 0.0;
  double y = 0.0;
  double error = 0.0;  // half length of the error bar; 0: none
};

enum class Mark { line, dashed, dotted, points, circles };

struct Series {
  std::string label;   // label in the legend; empty: no entry
  std::string colour;  // "#1f77b4"
  Mark mark = Mark::line;
  std::vector<Point> points;  // lines are interrupted at values that are not finite
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
};

// Returns the <svg> element. Lines are clipped at the axes; points beyond the y axis are drawn at its ends.
[[nodiscard]] std::string to_svg(const Plot& plot);

// Sets the axis to the decades that contain all positive values, at most `decades` of them below the largest; 0.1 to 1
// if there are none.
void fit_logarithmic(Axis& axis, const std::vector<Series>& series, int decades);

// Returns the text with &, <, > and quotes escaped for HTML, XML and attributes.
[[nodiscard]] std::string escaped(std::string_view text);

// Formats in fixed notation with the given number of decimals.
[[nodiscard]] std::string fixed(double value, int decimals);
// Returns a ratio in percent, with two decimals and without the sign %.
[[nodiscard]] std::string percent(double ratio);

}  // namespace tyndall::validate
