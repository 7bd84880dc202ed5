// `tyndall view`: the interactive viewer. One thread draws the GUI; each scene has another, see
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
  std::uint32_t width = 1280, height = 720;  // of the window [px]
  std::string device;                        // as everywhere
  tables::MakeReady make_tables;
  std::string state_file;   // F5, F9; empty: default_state_file()
  std::string screenshots;  // folder; empty: the working directory
  std::string log;          // where what happens is written, a line each; empty: nowhere
  bool validation = false;
  // For tests: "walk" takes every parameter to both ends, "soak=SECONDS" or "soak-frames=COUNT" changes them at random;
  // then it leaves. "lose-surface" and "lose-device" act as if that had happened after some frames; "one-device" draws
  // the window and the scenes on one device, whatever it is.
  std::string script;
  bool first_steps = true;  // show them when this is the first run
};

// Returns when the window is closed. An error is one line for the user.
Result<void> run(const ViewerDesc& desc);

}  // namespace tyndall::viewer
