// The errors of colours: luminance, chromaticity and colour difference of models against the path tracer with 40
// wavelengths.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "reference/path_tracer.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"
#include "validate/statistics.hpp"

namespace tyndall::validate {

// A linear Rec. 709 colour of which the luminance is relative to the sun's above the atmosphere.
using Color = std::array<double, 3>;

struct ColorError {
  double luminance = 0.0;     // relative
  double chromaticity = 0.0;  // distance in the CIE 1976 diagram u'v'
  double difference = 0.0;    // CIEDE2000
};

// Returns CIE XYZ (1931, 2 degrees), in the unit of the colour.
[[nodiscard]] std::array<double, 3> xyz_of(const Color& color);
// Returns the colour difference CIEDE2000 (Sharma, Wu, Dalal, "The CIEDE2000 color-difference formula: implementation
// notes, supplementary test data, and mathematical observations", 2005) between CIELAB colours.
[[nodiscard]] double ciede2000(const std::array<double, 3>& lab_a, const std::array<double, 3>& lab_b);
// Returns the errors of a colour. `white` is the luminance of D65 white for CIELAB, to which the eye is adapted.
[[nodiscard]] ColorError color_error(const Color& found, const Color& expected, double white);

// The sun's elevations and the elevations of the views of the test.
struct ColorBand {
  const char* name;
  double low_deg, high_deg;
};
constexpr ColorBand kColorSuns[] = {
    {"60° to 14°", 14.0, 90.0}, {"10° to 4°", 4.0, 10.0}, {"2° to 0°", 0.0, 2.0}, {"−2° to −6°", -6.0, -2.0}};
constexpr ColorBand kColorViews[] = {{"2° to 10°", 0.0, 10.0}, {"30° to 90°", 30.0, 90.0}};

struct ColorRay {
  double sun_elevation_deg, view_elevation_deg, azimuth_deg;
  [[nodiscard]] RayQuery query() const;
};
[[nodiscard]] std::vector<ColorRay> color_rays();

struct ColorModel {
  std::string name;
  std::function<Result<std::vector<Color>>(const Params& params, std::span<const RayQuery> queries)> answer;
};

struct ColorTest {
  std::vector<std::string> models;
  std::vector<ColorRay> rays;
  std::vector<Color> reference;
  std::vector<double> noise;                // standard error of the luminance, relative
  std::vector<std::vector<Color>> answers;  // [model][ray]
};

// Runs the path tracer with 40 wavelengths, and all models.
[[nodiscard]] Result<ColorTest> run_color_test(const Params& params, const std::vector<ColorModel>& models,
                                               std::uint64_t samples, std::uint64_t seed, int orders,
                                               const std::function<void(double)>& progress);

struct ColorSummary {
  Summary luminance, chromaticity, difference;
  double noise = 0.0;
};
[[nodiscard]] ColorSummary summarise(const ColorTest& test, std::size_t model, const ColorBand& sun,
                                     const ColorBand& view);

// Returns the section of docs/generated/accuracy.md, and the members of a JSON object.
[[nodiscard]] std::string color_markdown(const ColorTest& test);
[[nodiscard]] std::string color_json(const ColorTest& test);

}  // namespace tyndall::validate
