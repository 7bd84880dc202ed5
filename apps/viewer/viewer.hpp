// `tyndall view`: the interactive viewer. One thread draws the GUI; each scene has a thread of its own, see
// scenes/scene_thread.hpp.
#pragma once

#include <string>
#include <vector>

#include "config/settings.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/result.hpp"

namespace tyndall::viewer {

struct ViewerDesc {
  config::Settings settings;
  std::uint32_t width = 1280, height = 720;  // size of the window [px]
  std::string device;                        // value of --device
  tables::MakeReady make_tables;
  std::string state_file;   // file that F5 saves and F9 restores; empty: default_state_file()
  std::string screenshots;  // folder; empty: the working directory
  std::string log;          // file for the event log; empty: none
  bool validation = false;
  // For tests: "walk" sets every parameter to both ends of its range; "soak=SECONDS" or "soak-frames=COUNT" changes
  // random parameters; then the viewer quits. "lose-surface" and "lose-device" simulate the loss of the surface or the
  // device after the first frame; "one-device" draws the window and the scenes on one device, also without a GPU.
  std::string script;
  bool first_steps = true;  // show the first steps if this is the first run
};

// Runs the viewer until its window is closed. An error is one line for the user.
Result<void> run(const ViewerDesc& desc);

}  // namespace tyndall::viewer
