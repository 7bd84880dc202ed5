#include "viewer/view_settings.hpp"

#include <filesystem>
#include <utility>

#include "config/phase_file.hpp"
#include "config/scene_file.hpp"
#include "files/files.hpp"
#include "gpu/try.hpp"
#include "viewer/platform/files.hpp"
#include "viewer/scenes/settings_compare.hpp"

namespace tyndall::viewer {

void ViewSettings::synchronise(bool compare) {
  make_consistent(left);
  if (!compare) return;
  right.scene.camera = left.scene.camera;
  right.scene.sun = left.scene.sun;
  // The moon's place may follow from the date of the sun.
  right.scene.moon.by_date = left.scene.moon.by_date;
  right.scene.moon.elevation_deg = left.scene.moon.elevation_deg;
  right.scene.moon.azimuth_deg = left.scene.moon.azimuth_deg;
  right.scene.moon.angular_radius_deg = left.scene.moon.angular_radius_deg;
  make_consistent(right);
}

void ViewSettings::copy_to_right(bool new_comparison) {
  right = left;
  Technique& technique = right.effect.scattering.technique;
  if (new_comparison && technique == Technique::epipolar) technique = Technique::brute_force;
}

void ViewSettings::take_back(const PairResult& result) {
  for (std::size_t side = 0; side < result.refused.size(); ++side) {
    if (!result.refused[side]) continue;
    config::Settings& settings = side == 0 ? left : right;
    const scene::CameraParams camera = settings.scene.camera;
    const scene::SunParams sun = settings.scene.sun;
    go_back(settings, result.refused[side]->requested, result.refused[side]->current);
    settings.scene.camera = camera;
    settings.scene.sun = sun;
  }
}

Result<void> ViewSettings::save() const {
  if (!make_folder_of(state_file)) {
    return Error{ErrorCode::io,
                 "F5: cannot create the folder of '" + state_file + "'; expected a writable place, or --state FILE"};
  }
  const std::string folder = std::filesystem::path(state_file).parent_path().string();
  files::remove_leftovers(folder.empty() ? "." : folder);
  return config::save(left, state_file);
}

Result<void> ViewSettings::load(const std::string& path, bool over_defaults) {
  config::Settings loaded = over_defaults ? config::Settings() : left;
  loaded.scene.tables = left.scene.tables;
  TYNDALL_TRY(config::load(loaded, path));
  TYNDALL_TRY(config::load_files(loaded));
  TYNDALL_TRY(config::check(loaded));
  left = std::move(loaded);
  return {};
}

}  // namespace tyndall::viewer
