// The settings of the viewer: those of the left (or only) side and those of the right side of a comparison, and the
// file that F5 and F9 save and restore.
#pragma once

#include <string>

#include "config/settings.hpp"
#include "viewer/scene_pair.hpp"

namespace tyndall::viewer {

struct ViewSettings {
  config::Settings left, right;
  std::string state_file;

  // Corrects what ranges alone cannot say, and lets both sides share the camera and the sun when they are compared.
  void synchronise(bool compare);
  // Makes the right side a copy of the left. For a new comparison its technique is brute force, which is the comparison
  // that is needed most often.
  void copy_to_right(bool new_comparison);
  // Returns to what the scenes have where they could not take over the settings. Camera and sun stay as the user moves
  // them.
  void take_back(const PairResult& result);
  // Saves the left settings to the state file.
  [[nodiscard]] Result<void> save() const;
  // Loads a scene file over the defaults or over the left settings. Where tables are cached depends on this machine,
  // not on the scene, and stays. An error leaves everything as it was.
  [[nodiscard]] Result<void> load(const std::string& path, bool over_defaults);
};

}  // namespace tyndall::viewer
