#include "viewer/scene_pair.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "files/text.hpp"
#include "gpu/try.hpp"
#include "scene/description/placed_sun.hpp"

namespace tyndall::viewer {
namespace {

bool in_work(const SceneThread* thread) { return thread != nullptr && thread->busy(); }

// A frame of the window waits for at most two frames of the scene that are as long as this.
constexpr double kAheadUpTo_ms = 40.0;

// Returns whether a thread is drawing. Only one scene may draw at a time, so that they do not slow each other down.
bool draws(const SceneThread* thread) { return in_work(thread) && !thread->creating(); }

}  // namespace

bool device_lost(const Error& error) {
  return error.code == ErrorCode::device_lost || error.vk_result == VK_ERROR_DEVICE_LOST;
}

ScenePair::~ScenePair() {
  if (retired_.valid()) retired_.wait();
  left_.reset();
  right_.reset();
  replacement_.reset();
}

void ScenePair::start(gpu::Host& host, bool one_device, const tables::MakeReady& make_tables, PairRequest request) {
  host_ = &host;
  one_device_ = one_device;
  make_tables_ = make_tables;
  request_ = std::move(request);
  drawn_poses_[0] = {request_.camera, request_.settings[0].scene.sun};
  left_ = start_thread(request_of(nullptr));
}

void ScenePair::start_replacement(const tables::MakeReady& make_tables) {
  make_tables_ = make_tables;
  replacement_ = start_thread(request_of(nullptr));
}

std::unique_ptr<SceneThread> ScenePair::start_thread(const SceneRequest& request) const {
  scene::SceneDesc desc;
  desc.timings = true;
  desc.histogram = true;
  desc.illuminance = true;
  desc.pipeline_threads = gpu::Host::pipeline_threads();
  desc.make_tables = make_tables_;
  desc.in_parts = one_device_;  // so that frames of the window need not wait for a whole frame of the scene
  if (one_device_) desc.ahead_up_to_ms = kAheadUpTo_ms;  // otherwise each canvas is read back, which waits for it
  auto thread = std::make_unique<SceneThread>();
  thread->start(*host_, desc, request, !one_device_);
  return thread;
}

// Returns the request for the left scene or its replacement, or for the right scene.
SceneRequest ScenePair::request_of(const SceneThread* thread) const {
  const std::size_t side = thread != nullptr && thread == right_.get() ? 1 : 0;
  const bool is_left = thread != nullptr && thread == left_.get();
  SceneRequest request;
  request.settings = request_.settings[side];
  request.extent = request_.extent;
  request.coarseness = request_.coarseness;
  request.view = request_.view;
  request.seconds = request_.seconds;
  request.again = again_[side];
  request.rest = is_left && request_.resting;
  request.capture = is_left && request_.capture;
  return request;
}

void ScenePair::update() {
  if (request_.compare && right_ == nullptr) {
    // request_of() recognises the right thread by `right_`, which is not set yet.
    SceneRequest request = request_of(nullptr);
    request.settings = request_.settings[1];
    right_ = start_thread(request);
  } else if (!request_.compare && right_ != nullptr && !right_->busy()) {
    right_.reset();
    pictures_.forget(1);
  }
  launch();
}

void ScenePair::launch() {
  if (draws(left_.get()) || draws(right_.get()) || draws(replacement_.get())) return;
  if (replacement_ != nullptr && !replacement_->busy()) {
    if (const SceneRequest request = request_of(replacement_.get()); replacement_->wants(request)) {
      return replacement_->launch(request);
    }
  }
  SceneThread* const threads[2] = {left_.get(), right_.get()};
  for (int i = 0; i < 2; ++i) {
    left_first_ = !left_first_;
    const std::size_t side = left_first_ ? 0 : 1;
    SceneThread* const thread = threads[side];
    if (thread == nullptr || thread->busy()) continue;
    const SceneRequest request = request_of(thread);
    if (!thread->wants(request)) continue;
    again_[side] = false;
    drawn_poses_[side] = {request_.camera, request_.settings[0].scene.sun};
    if (!request.rest) settled_logged_ = false;
    thread->launch(request);
    return;
  }
  if (!settled_logged_ && left_->facts().can_render && !left_->busy() && right_ == nullptr) {
    settled_logged_ = true;
    notices_->log("settled");
  }
}

bool ScenePair::work_is_due() const {
  const SceneThread* const threads[] = {left_.get(), right_.get(), replacement_.get()};
  if (std::any_of(std::begin(threads), std::end(threads), draws)) return false;
  return std::any_of(std::begin(threads), std::end(threads), [this](const SceneThread* thread) {
    return thread != nullptr && !thread->busy() && thread->wants(request_of(thread));
  });
}

Result<PairResult> ScenePair::take_results() {
  PairResult out;
  TYNDALL_TRY(take_replacement(out));
  if (std::optional<SceneResult> result = left_->poll()) TYNDALL_TRY(take_result(0, *result, out));
  if (right_ == nullptr) return out;
  if (std::optional<SceneResult> result = right_->poll()) TYNDALL_TRY(take_result(1, *result, out));
  return out;
}

Result<void> ScenePair::take_result(std::size_t side, SceneResult& result, PairResult& out) {
  for (const std::string& note : result.notes) notices_->note(note);
  if (result.error) {
    if (device_lost(*result.error) || (result.over && side == 0)) return *result.error;
    notices_->report(*result.error);
    redraw_->request(3);
    if (result.over) {
      out.right_ended = true;
      return {};
    }
    out.refused.at(side) = {std::move(result.requested), std::move(result.settings)};
  }
  if (result.picture) {
    TYNDALL_TRY(pictures_.take(side, std::move(*result.picture)));
    redraw_->request(1);
  }
  if (result.frame) {
    if (side == 0) {
      times_.add(left_->facts().timings, result.frame_ms);
      ++frames_;
    }
    log_frame(side, result.frame_ms);
  }
  if (result.tables) redraw_->request(1);
  if (result.tables_done) notices_->log("tables");
  if (result.tables_stored) notices_->log("tables stored");
  if (result.pipelines_done) notices_->log("pipelines");
  if (result.capture) out.capture = std::move(result.capture);
  return {};
}

// Replaces the left scene by the one with rebuilt shaders once that has been drawn.
Result<void> ScenePair::take_replacement(PairResult& out) {
  if (replacement_ == nullptr) return {};
  if (std::optional<SceneResult> result = replacement_->poll()) {
    if (result->error && result->over) {
      replacement_.reset();
      out.replacement_error = std::move(result->error);
      return {};
    }
    if (result->picture) replacement_picture_ = std::move(result->picture);
  }
  if (replacement_->busy() || in_work(left_.get()) || in_work(right_.get()) || !replacement_picture_) return {};
  // Destroying the old scene takes too long for the GUI's thread.
  retired_ = std::async(std::launch::async,
                        [before = std::shared_ptr<SceneThread>(std::move(left_))]() mutable { before.reset(); });
  left_ = std::move(replacement_);
  TYNDALL_TRY(pictures_.take(0, std::move(*std::exchange(replacement_picture_, std::nullopt))));
  ++frames_;
  redraw_->request(1);
  right_.reset();  // update() creates another one if there is still a comparison
  pictures_.forget(1);
  out.replaced = true;
  return {};
}

Result<void> ScenePair::record(VkCommandBuffer cmd, VkExtent2D window, const PictureOptions& options) {
  return pictures_.record(cmd, window, options.compare && pictures_.has(1), options);
}

Progress ScenePair::tables() const {
  Progress out = {};
  for (const SceneThread* thread : {left_.get(), right_.get()}) {
    if (thread != nullptr && thread->facts().building) out = thread->facts().tables;
  }
  return out;
}

bool ScenePair::creating() const { return left_->creating() || (right_ != nullptr && right_->creating()); }

bool ScenePair::settled() const {
  return !left_->busy() && !left_->facts().working && left_->shows(request_of(left_.get()));
}

void ScenePair::describe(LoopState& state) const {
  state.busy = in_work(left_.get()) || in_work(right_.get());
  state.work_due = work_is_due();
  state.background = state.background || replacement_ != nullptr;
  for (const SceneThread* thread : {left_.get(), right_.get()}) {
    if (thread == nullptr) continue;
    state.adapting = state.adapting || thread->facts().tone_stale;
    state.background = state.background || thread->facts().working;
  }
  const SceneFacts& facts = left_->facts();
  state.store_tables_in_s = facts.store_tables_in_s;
  const bool pipelines_left = !facts.pipelines.complete() || facts.pipelines.total == 0;
  state.idle_work = facts.can_render && (pipelines_left || facts.store_tables_in_s >= 0.0);
}

void ScenePair::log_frame(std::size_t side, double took_ms) {
  if (!notices_->events().on()) return;
  const SceneFacts& facts = (side == 0 ? *left_ : *right_).facts();
  const CameraState& camera = drawn_poses_.at(side).camera;
  // The sun's position may follow from a time.
  const scene::SunParams& given = drawn_poses_.at(side).sun;
  const std::optional<scene::Place> place = facts.elevations != nullptr ? facts.elevations->place() : std::nullopt;
  const Result<scene::SunParams> placed = scene::placed_sun(given, place);
  const scene::SunParams& sun = placed ? placed.value() : given;
  std::string text = side == 0 ? "frame left " : "frame right ";
  text += std::to_string(frames_) + " " + std::to_string(facts.extent.width) + " " +
          std::to_string(facts.extent.height) + " ms " + files::number_text(took_ms) + " camera";
  for (const double value :
       {camera.position.x, camera.position.y, camera.position.z, camera.yaw_deg, camera.pitch_deg, camera.fov_deg}) {
    text += " " + files::number_text(value);
  }
  text += " sun " + files::number_text(sun.azimuth_deg) + " " + files::number_text(sun.elevation_deg);
  notices_->log(text);
  std::string passes = "passes";
  for (const scene::PassTime& pass : facts.timings) {
    passes += " " + pass.name + " " + files::number_text(std::round(100.0 * pass.ms) / 100.0);
  }
  notices_->log(passes);
}

}  // namespace tyndall::viewer
