// The colour space and the unit of EXR files: the options --primaries and --unit of `render` and `sky`.
#pragma once

#include "arguments.hpp"
#include "config/settings.hpp"
#include "image/image.hpp"

namespace tyndall::cli {

class PictureUnits {
 public:
  // Declares the options. This object must outlive Arguments::parse().
  void add_options(Arguments& arguments);
  // Fails (invalid_argument) if the settings have no such unit.
  [[nodiscard]] Result<void> resolve(const config::Settings& settings);
  // Fails (invalid_argument) if an option is given that has no effect on a PNG.
  [[nodiscard]] Result<void> check_png() const;

  // Returns the number that relative radiance is multiplied by.
  [[nodiscard]] double factor() const { return factor_; }
  // Returns the luminance of the colour (1, 1, 1) in a relative picture [cd/m^2]; 0 with three channels.
  [[nodiscard]] double white_luminance() const { return white_luminance_; }
  [[nodiscard]] image::Primaries primaries() const { return primaries_; }
  // Converts relative radiance in linear Rec. 709.
  void convert(image::Image& image) const;
  [[nodiscard]] std::array<double, 3> convert(std::array<double, 3> color) const;
  [[nodiscard]] image::ExrOptions exr(image::ExrContent content) const;
  [[nodiscard]] image::Metadata metadata(const config::Settings& settings) const;
  // Adds the options to the inputs of a manifest.
  void add_inputs(std::vector<std::pair<std::string, std::string>>& inputs) const;

 private:
  std::string primaries_name_ = "rec709", unit_ = "relative";
  image::Primaries primaries_ = image::Primaries::rec709;
  double factor_ = 1.0, white_luminance_ = 0.0;
};

}  // namespace tyndall::cli
