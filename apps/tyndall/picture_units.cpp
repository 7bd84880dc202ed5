#include "picture_units.hpp"

#include "files/text.hpp"
#include "image/primaries.hpp"
#include "scene/photometry.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::cli {

void PictureUnits::add_options(Arguments& arguments) {
  arguments.choice("--primaries", primaries_name_, {image::kPrimariesNames.begin(), image::kPrimariesNames.end()},
                   "colour space of an EXR");
  arguments.choice("--unit", unit_, {"relative", "radiance", "luminance"},
                   "unit of an EXR: that of sun.irradiance per sr, W/(m^2 sr) over 683 lm/W, or cd/m^2; the last two "
                   "need scattering.color = spectral");
}

Result<void> PictureUnits::resolve(const config::Settings& settings) {
  primaries_ = image::primaries_of_name(primaries_name_).value_or(image::Primaries::rec709);
  const bool spectral = settings.effect.scattering.color == ColorMode::spectral;
  if (spectral) white_luminance_ = scene::white_luminance(settings.effect, settings.scene);
  if (unit_ == "relative") return {};
  if (!spectral) {
    return files::input_error(files::concat({"three channels have no unit '", unit_, "'"}), "--unit",
                              "expected scattering.color = spectral, or relative");
  }
  if (white_luminance_ == 0.0) {
    return files::input_error(files::concat({"a scene without sunlight has no unit '", unit_, "'"}), "--unit",
                              "expected sun.irradiance above 0, or relative");
  }
  factor_ = unit_ == "luminance" ? white_luminance_ : white_luminance_ / kLuminousEfficacy;
  return {};
}

Result<void> PictureUnits::check_png() const {
  if (primaries_name_ == "rec709" && unit_ == "relative") return {};
  return files::input_error("a PNG holds display values in sRGB",
                            primaries_name_ != "rec709" ? "--primaries" : "--unit",
                            "expected an output file with the ending .exr, or no such option");
}

void PictureUnits::convert(image::Image& image) const {
  image::convert_to(primaries_, image);
  if (factor_ == 1.0) return;
  for (float& value : image.rgb) value = static_cast<float>(factor_ * static_cast<double>(value));
}

std::array<double, 3> PictureUnits::convert(std::array<double, 3> color) const {
  color = image::in_primaries(color, primaries_);
  for (double& value : color) value *= factor_;
  return color;
}

image::ExrOptions PictureUnits::exr(image::ExrContent content) const {
  return {.content = content, .primaries = primaries_, .white_luminance = white_luminance_ / factor_};
}

image::Metadata PictureUnits::metadata(const config::Settings& settings) const {
  const std::string_view text = unit_ == "luminance" ? "cd/m^2"
                                : unit_ == "radiance"
                                    ? "W/(m^2 sr), luminance over 683 lm/W; times whiteLuminance it is cd/m^2"
                                    : "";
  image::Metadata out = config::radiance_metadata(settings, text);
  out.emplace_back("tyndall.primaries", primaries_name_);
  return out;
}

void PictureUnits::add_inputs(std::vector<std::pair<std::string, std::string>>& inputs) const {
  inputs.emplace_back("--primaries", primaries_name_);
  inputs.emplace_back("--unit", unit_);
}

}  // namespace tyndall::cli
