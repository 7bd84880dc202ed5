#include "viewer/screenshot.hpp"

#include <chrono>
#include <utility>

#include "files/files.hpp"
#include "image/image.hpp"
#include "scene/photometry.hpp"
#include "viewer/platform/files.hpp"
#include "viewer/platform/window.hpp"

namespace tyndall::viewer {

Screenshot::~Screenshot() {
  if (writing_.valid()) writing_.wait();
}

void Screenshot::write(Capture capture, const std::string& folder) {
  requested_ = false;
  const std::string stem = screenshot_stem(folder, {".png", ".exr"});
  writing_ = std::async(std::launch::async, [stem, folder, shot = std::move(capture)]() -> Result<std::string> {
    files::remove_leftovers(folder.empty() ? "." : folder);
    Result<void> written = image::write_png(stem + ".png", shot.display, config::metadata(shot.settings));
    if (written && image::exr_supported()) {
      const Params& params = shot.settings.effect;
      image::ExrOptions options = {.content = image::ExrContent::radiance};
      if (params.scattering.color == ColorMode::spectral) {
        options.white_luminance = scene::white_luminance(params, shot.settings.scene);
      }
      written = image::write_exr(stem + ".exr", shot.radiance, config::radiance_metadata(shot.settings), options);
    }
    Window::wake();
    if (!written) return written.error();
    return stem;
  });
}

std::optional<Result<std::string>> Screenshot::take_written() {
  if (!writing_.valid() || writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return writing_.get();
}

}  // namespace tyndall::viewer
