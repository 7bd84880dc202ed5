// The scenes of the viewer: what they are to show, what has come of their work, and the next piece of it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "files/text.hpp"
#include "gpu/try.hpp"
#include "viewer/scenes/settings_compare.hpp"
#include "viewer/viewer_state.hpp"

namespace tyndall::viewer {

VkExtent2D Viewer::picture_extent() const {
  const VkExtent2D window = window_.size();
  const auto scaled = [this](std::uint32_t side) {
    return std::clamp(static_cast<std::uint32_t>(std::lround(static_cast<double>(side) * gui_.state.resolution_scale)),
                      16U, 8192U);
  };
  return {scaled(window.width), scaled(window.height)};
}

SceneRequest Viewer::request_of(const SceneThread& thread) const {
  const bool left = &thread != other_.get();
  SceneRequest request;
  request.settings = left ? settings_ : right_;
  request.extent = picture_extent();
  request.coarseness = gui_.state.coarseness;
  request.view = view_of(gui_.state.picture, window_.size());
  request.seconds = seconds_;
  request.again = again_[left ? 0 : 1];
  request.rest = &thread == left_.get() && resting();
  request.capture = &thread == left_.get() && screenshot_wanted_ && !writing_.valid();
  return request;
}

void Viewer::start_scene(SceneThread& thread) {
  scene::SceneDesc desc;
  desc.timings = true;
  desc.histogram = true;
  desc.make_tables = desc_.make_tables;
  desc.keep_shadows = true;
  desc.in_parts = window_host_ == host_;  // the window's frames come in between
  thread.start(*host_, desc, request_of(thread), slow_device() && desc_.script != "one-device");
}

// The settings as they are wanted now, and the scenes that they need.
void Viewer::follow() {
  make_consistent(settings_);
  if (!gui_.state.picture.compare) {
    if (other_ != nullptr && !other_->busy()) {
      other_.reset();
      pictures_.forget(1);
    }
    return;
  }
  right_.scene.camera = settings_.scene.camera;
  right_.scene.sun = settings_.scene.sun;
  make_consistent(right_);
  if (other_ != nullptr) return;
  other_ = std::make_unique<SceneThread>();
  start_scene(*other_);
}

// One piece of work at a time, left and right in turn, so that they do not take the machine from each other.
void Viewer::launch_work() {
  SceneThread* threads[2] = {left_.get(), other_.get()};
  for (const SceneThread* thread : threads) {
    if (thread != nullptr && thread->busy() && !thread->creating()) return;
  }
  if (next_ != nullptr && next_->busy() && !next_->creating()) return;
  if (next_ != nullptr && !next_->busy() && next_->wants(request_of(*next_))) return next_->launch(request_of(*next_));
  for (int i = 0; i < 2; ++i) {
    turn_ = !turn_;
    const int side = turn_ ? 0 : 1;
    SceneThread* const thread = threads[side];
    if (thread == nullptr || thread->busy()) continue;
    const SceneRequest request = request_of(*thread);
    if (!thread->wants(request)) continue;
    again_[side] = false;
    drawn_camera_[side] = {camera_, settings_.scene.sun};
    if (!request.rest) settled_told_ = false;
    thread->launch(request);
    return;
  }
  if (!settled_told_ && left_->facts().can_render && !left_->busy() && other_ == nullptr) {
    settled_told_ = true;
    log("settled");
  }
}

// Whether a piece of work could begin now.
bool Viewer::work_is_due() const {
  for (const SceneThread* thread : {left_.get(), other_.get(), next_.get()}) {
    if (thread != nullptr && thread->busy() && !thread->creating()) return false;
  }
  for (const SceneThread* thread : {left_.get(), other_.get(), next_.get()}) {
    if (thread != nullptr && !thread->busy() && thread->wants(request_of(*thread))) return true;
  }
  return false;
}

Result<void> Viewer::take_results() {
  TYNDALL_TRY(take_next());
  if (std::optional<SceneResult> outcome = left_->poll()) TYNDALL_TRY(take_result(0, *outcome));
  if (other_ == nullptr) return {};
  if (std::optional<SceneResult> outcome = other_->poll()) TYNDALL_TRY(take_result(1, *outcome));
  return {};
}

Result<void> Viewer::take_result(std::size_t side, SceneResult& outcome) {
  const SceneThread& thread = side == 0 ? *left_ : *other_;
  for (const std::string& note : outcome.notes) tell(note);
  if (outcome.error) {
    if (lost(*outcome.error) || (outcome.over && side == 0)) return *outcome.error;
    report(*outcome.error);
    frames_to_draw_ = std::max(frames_to_draw_, 3);
    if (outcome.over) {
      gui_.state.picture.compare = false;
      return {};
    }
    // What the scene could not follow goes back; camera and sun stay in the hands.
    config::Settings& settings = side == 0 ? settings_ : right_;
    const scene::CameraParams camera = settings.scene.camera;
    const scene::SunParams sun = settings.scene.sun;
    go_back(settings, outcome.asked, outcome.settings);
    settings.scene.camera = camera;
    settings.scene.sun = sun;
  }
  if (outcome.picture) {
    TYNDALL_TRY(pictures_.take(side, std::move(*outcome.picture)));
    frames_to_draw_ = std::max(frames_to_draw_, 1);
  }
  if (outcome.frame) {
    if (side == 0) {
      times_.add(thread.facts().timings, outcome.frame_ms);
      ++frames_;
    }
    log_frame(side, outcome.frame_ms);
  }
  if (outcome.tables) frames_to_draw_ = std::max(frames_to_draw_, 1);
  if (outcome.tables_done) log("tables");
  if (outcome.tables_kept) log("tables kept");
  if (outcome.pipelines_done) log("pipelines");
  if (outcome.capture) write_screenshot(std::move(*outcome.capture));
  return {};
}

// A scene with rebuilt shaders takes the place of the one before when it can be drawn.
Result<void> Viewer::take_next() {
  if (next_ == nullptr) return {};
  if (std::optional<SceneResult> outcome = next_->poll()) {
    if (outcome->error && outcome->over) {
      next_.reset();
      shaders_->revert();
      shader_message_ = outcome->error->message;
      log("shaders failed " + outcome->error->message);
      if (lost(*outcome->error)) return *outcome->error;
      report(*outcome->error);
      return {};
    }
    if (outcome->picture) next_picture_ = std::move(outcome->picture);
  }
  const bool others_busy = left_->busy() || (other_ != nullptr && other_->busy());
  if (next_->busy() || others_busy || !next_picture_) return {};
  // Giving back what the one before held takes longer than a step of the GUI may.
  retired_ = std::async(std::launch::async,
                        [before = std::shared_ptr<SceneThread>(std::move(left_))]() mutable { before.reset(); });
  left_ = std::move(next_);
  TYNDALL_TRY(pictures_.take(0, std::move(*std::exchange(next_picture_, std::nullopt))));
  ++frames_;
  frames_to_draw_ = std::max(frames_to_draw_, 1);
  other_.reset();  // made anew, if it is still wanted
  pictures_.forget(1);
  shader_message_.clear();
  tell("The shaders are rebuilt");
  log("shaders rebuilt");
  return {};
}

void Viewer::log_frame(std::size_t side, double took_ms) {
  if (!log_.on()) return;
  const SceneFacts& facts = (side == 0 ? *left_ : *other_).facts();
  const CameraState& camera = drawn_camera_[side].camera;
  const scene::SunParams& sun = drawn_camera_[side].sun;
  log(std::string("frame ") + (side == 0 ? "left " : "right ") + std::to_string(frames_) + " " +
      std::to_string(facts.extent.width) + " " + std::to_string(facts.extent.height) + " ms " +
      files::number_text(took_ms) + " camera " + files::number_text(camera.position.x) + " " +
      files::number_text(camera.position.y) + " " + files::number_text(camera.position.z) + " " +
      files::number_text(camera.yaw_deg) + " " + files::number_text(camera.pitch_deg) + " " +
      files::number_text(camera.fov_deg) + " sun " + files::number_text(sun.azimuth_deg) + " " +
      files::number_text(sun.elevation_deg));
  std::string passes = "passes";
  for (const scene::PassTime& pass : facts.timings) {
    passes += " " + pass.name + " " + files::number_text(std::round(100.0 * pass.ms) / 100.0);
  }
  log(passes);
}

}  // namespace tyndall::viewer
