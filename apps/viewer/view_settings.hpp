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

  // Corrects inconsistent settings, and makes both sides of a comparison share the camera and the sun.
  void synchronise(bool compare);
  // Makes the right side a copy of the left. For a new comparison its technique is brute force, which is the comparison
  // that is needed most often.
  void copy_to_right(bool new_comparison);
  // Reverts settings that the scenes have refused. The camera and the sun are not reverted.
  void take_back(const PairResult& result);
  // Saves the left settings to the state file, and removes what killed runs have left beside it.
  [[nodiscard]] Result<void> save() const;
  // Loads a scene file over the defaults or over the left settings. The location of the table cache is retained,
  // because it depends on the machine and not on the scene. An error changes nothing.
  [[nodiscard]] Result<void> load(const std::string& path, bool over_defaults);
};

}  // namespace tyndall::viewer
