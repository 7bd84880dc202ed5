// What keys and menus ask the viewer for.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "config/scene_file.hpp"
#include "files/text.hpp"
#include "gpu/try.hpp"
#include "image/image.hpp"
#include "viewer/viewer_state.hpp"

namespace tyndall::viewer {

void Viewer::handle_key(int key) {
  GuiRequests requests;
  switch (key) {
    case GLFW_KEY_F1: gui_.state.help = !gui_.state.help; break;
    case GLFW_KEY_F2: gui_.state.hidden = !gui_.state.hidden; break;
    case GLFW_KEY_F5: requests.save = true; break;
    case GLFW_KEY_F8: requests.reload_shaders = true; break;
    case GLFW_KEY_F9: requests.restore = true; break;
    case GLFW_KEY_P: requests.play = true; break;
    case GLFW_KEY_F11: window_.set_full_screen(!window_.full_screen()); break;
    case GLFW_KEY_F12: requests.screenshot = true; break;
    case GLFW_KEY_ESCAPE: requests.quit = true; break;
    default: return;
  }
  log("key " + std::to_string(key));
  do_requests(requests);
}

void Viewer::do_requests(const GuiRequests& requests) {
  if (requests.save) save_state();
  if (requests.play) {
    if (settings_.path.empty()) {
      tell("This scene has no flight");
    } else {
      flying_path_ = !flying_path_;
      if (!settings_.path.loop && path_s_ >= settings_.path.duration_s()) path_s_ = 0.0;
      log(flying_path_ ? "path begins" : "path stops");
    }
  }
  if (requests.restore) restore_state();
  if (requests.screenshot) screenshot_wanted_ = true;
  if (requests.reload_shaders) start_reload();
  if (!requests.scene.empty()) load_file(requests.scene, true);
  if (!requests.preset.empty()) load_file(requests.preset, false);
  if (requests.copy_to_right) {
    right_ = settings_;
    // The comparison that is wanted most often; the controls of the right side change it.
    if (other_ == nullptr && right_.effect.scattering.technique == Technique::epipolar) {
      right_.effect.scattering.technique = Technique::brute_force;
    }
  }
  if (requests.quit) window_.close();
}

void Viewer::save_state() {
  if (!make_folder_of(desc_.state_file)) {
    report({ErrorCode::io, "the folder of '" + desc_.state_file + "' cannot be made, F5, --state names another file"});
    return;
  }
  if (Result<void> saved = config::save(settings_, desc_.state_file); !saved) return report(saved.error());
  tell("The state is saved in " + desc_.state_file);
  log("saved " + desc_.state_file);
}

void Viewer::restore_state() { load_file(desc_.state_file, true); }

void Viewer::load_file(const std::string& path, bool over_defaults) {
  config::Settings loaded = over_defaults ? config::Settings() : settings_;
  // Where tables are kept is a matter of this machine, not of a scene.
  loaded.scene.tables = settings_.scene.tables;
  if (Result<void> read = config::load(loaded, path); !read) return report(read.error());
  if (Result<void> valid = config::check(loaded); !valid) return report(valid.error());
  settings_ = loaded;
  seconds_ = path_s_ = 0.0;
  flying_path_ = false;
  if (!settings_.path.empty()) tell("This scene has a flight: P plays it");
  tell("Loaded " + path);
  log("loaded " + path);
}

void Viewer::write_screenshot(Capture capture) {
  screenshot_wanted_ = false;
  const std::string stem = screenshot_stem(desc_.screenshots, {".png", ".exr"});
  writing_ = std::async(std::launch::async, [stem, shot = std::move(capture)]() -> Result<std::string> {
    Result<void> written = image::write_png(stem + ".png", shot.display, config::metadata(shot.settings));
    if (written) {
      written = image::write_exr(stem + ".exr", shot.radiance, config::radiance_metadata(shot.settings),
                                 {.content = image::ExrContent::radiance});
    }
    Window::wake();
    if (!written) return written.error();
    return stem;
  });
}

void Viewer::finish_tasks() {
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    const Result<std::string> stem = writing_.get();
    if (!stem) {
      report(stem.error());
    } else {
      tell("Written: " + stem.value() + ".png and .exr");
      log("screenshot " + stem.value());
    }
  }
  if (Result<void> reloaded = finish_reload(); !reloaded) report(reloaded.error());
}

void Viewer::start_reload() {
  if (shaders_->working()) return;
  if (Result<void> started = shaders_->start(); !started) return report(started.error());
  tell("Rebuilding the shaders ...");
}

// New shaders need new pipelines: new scenes, which take the place of the old ones when they are there.
Result<void> Viewer::finish_reload() {
  TYNDALL_ASSIGN(const ShaderReload::Outcome outcome, shaders_->finish());
  if (!outcome.finished) return {};
  shader_message_ = outcome.message;
  if (!outcome.message.empty()) {
    gui_.toast("The shaders stay as they were:\n" + outcome.message, true, now());
    log("shaders failed " + files::one_line(outcome.message, 400));
    frames_to_draw_ = 3;
    return {};
  }
  if (outcome.changed == 0 && outcome.restored == 0) {
    tell("The shaders are as their sources");
    log("shaders same");
    return {};
  }
  // Tables that changed shaders make are not those of the cache.
  desc_.make_tables.build_anew = outcome.tables_differ;
  if (outcome.tables_differ) desc_.make_tables.cache.place = "off";
  next_ = std::make_unique<SceneThread>();
  start_scene(*next_);
  return {};
}

Error Viewer::after_loss(const Error& error) {
  const bool gone = lost(error) || error.vk_result == VK_ERROR_SURFACE_LOST_KHR;
  log("failed " + error.message);
  if (!gone) return error;
  const bool surface = error.vk_result == VK_ERROR_SURFACE_LOST_KHR;
  const std::string what = surface ? "the window's surface was lost" : "the Vulkan device was lost";
  Result<void> saved = Error{ErrorCode::io, ""};
  if (make_folder_of(desc_.state_file)) saved = config::save(settings_, desc_.state_file);
  const std::string state = saved ? "the state is saved, 'tyndall view " + desc_.state_file + "' goes on from there"
                                  : "the state could not be saved in '" + desc_.state_file + "'";
  return Error{ErrorCode::device_lost, what + " (" + error.message + "), tyndall view, " + state, error.vk_result};
}

}  // namespace tyndall::viewer
