// Scene files with their includes and camera paths. A line "%" ends a file: the input has the scene and then the files
// a.toml, b.toml and c.toml beside it. An accepted scene without files is written and read back unchanged.
#include "config/scene_file.hpp"

#include <array>
#include <cmath>

#include "fuzz.hpp"
#include "scene/description/camera_path.hpp"
#include "scene/description/placed_sun.hpp"

namespace {

using namespace tyndall;

void require_finite(const scene::SceneParams& params) {
  const scene::CameraParams& camera = params.camera;
  const std::array<double, 8> values = {camera.position_m.x, camera.position_m.y,     camera.position_m.z,
                                        camera.yaw_deg,      camera.pitch_deg,        camera.fov_deg,
                                        camera.altitude_m,   params.sun.elevation_deg};
  for (const double value : values) fuzz::require(std::isfinite(value), "a pose on the path is finite");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  std::string_view rest = fuzz::text_of(data, size);
  for (const char* const name : {"scene.toml", "a.toml", "b.toml", "c.toml"}) {
    constexpr std::string_view kEnd = "\n%\n";
    const std::size_t end = std::min(rest.find(kEnd), rest.size());
    folder.write(name, rest.substr(0, end));
    rest.remove_prefix(std::min(end + kEnd.size(), rest.size()));
  }
  config::Settings settings;
  const Result<void> loaded = config::load(settings, folder.at("scene.toml"));
  if (!loaded) {
    fuzz::require_one_line(loaded.error());
    return 0;
  }
  const Result<void> checked = config::check(settings);
  if (!checked) fuzz::require_one_line(checked.error());
  const std::string written = config::to_toml(settings);
  config::Settings again;
  const Result<void> read = config::load_text(again, written, "written");
  fuzz::require(read.ok(), "a written scene is read back");
  fuzz::require(config::to_toml(again) == written, "a written scene is read back unchanged");
  if (settings.path.empty()) return 0;
  const double duration = settings.path.duration_s();
  for (const double seconds : {-1.0, 0.0, 0.3 * duration, 0.99 * duration, duration, 2.7 * duration}) {
    require_finite(scene::pose_at(settings.path, seconds, settings.scene, settings.effect.planet.radius_m));
  }
  return 0;
}
