#include "scene/description/camera_exposure.hpp"

#include "files/text.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {
namespace {

constexpr float kNotSet = -100.0F;  // the default of tonemap.exposure_ev100

}  // namespace

std::optional<double> camera_ev100(const TonemapParams& tonemap) {
  if (tonemap.exposure_ev100 > kNotSet) return static_cast<double>(tonemap.exposure_ev100);
  if (!(tonemap.aperture > 0.0F && tonemap.shutter_s > 0.0F)) return std::nullopt;
  return ev100_of_camera(static_cast<double>(tonemap.aperture), static_cast<double>(tonemap.shutter_s),
                         static_cast<double>(tonemap.iso));
}

bool is_auto_exposed(const TonemapParams& tonemap) {
  return tonemap.auto_exposure.value != 0 && !camera_ev100(tonemap).has_value();
}

Result<void> check_camera_exposure(const TonemapParams& tonemap) {
  const bool aperture = tonemap.aperture > 0.0F, shutter = tonemap.shutter_s > 0.0F;
  if (tonemap.exposure_ev100 > kNotSet && (aperture || shutter)) {
    return files::input_error("the exposure is given both by its value and by the camera", "tonemap.exposure_ev100",
                              "expected either exposure_ev100, or aperture and shutter_s");
  }
  if (aperture != shutter) {
    return files::input_error(aperture ? "the camera has no exposure time" : "the camera has no f-number",
                              aperture ? "tonemap.aperture" : "tonemap.shutter_s",
                              "expected both aperture and shutter_s, or neither");
  }
  return {};
}

}  // namespace tyndall::scene
