// Frames in flight: submission, waiting, and the results of frames that are complete.
#include <string_view>

#include "gpu/try.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {

Scene::InFlight::~InFlight() {
  if (host != nullptr) static_cast<void>(host->wait(submission));
}

Result<void> Scene::finish() {
  TYNDALL_TRY(wait_for_frames());
  if (!illuminance_stale_) return {};
  TYNDALL_ASSIGN(illuminance_, measure_illuminance());
  illuminance_stale_ = false;
  return {};
}

Result<void> Scene::wait_for_frames() {
  // Wait from the oldest frame to the newest, so that the results are those of the newest.
  for (std::uint32_t i = 0; i < gpu::kFramesInFlight; ++i) {
    TYNDALL_TRY(finish(static_cast<std::uint32_t>((frame_index_ + i) % gpu::kFramesInFlight)));
  }
  // Commands of other users of the queue may still read the pictures; the viewer's canvas does.
  return ahead() ? host_->wait_for_all() : Result<void>();
}

Result<void> Scene::finish(std::uint32_t slot) {
  InFlight& frame = in_flight_.at(slot);
  if (frame.taken) return {};
  frame.taken = true;
  TYNDALL_TRY(host_->wait(frame.submission));
  take_results(slot);
  return {};
}

void Scene::take_results(std::uint32_t slot) {
  measurement_ = tonemap_->exposure().read(slot);
  counters_ = model_ == nullptr ? effect_->counters(in_flight_.at(slot).frame_index) : Counters{};
  times_.clear();
  if (!desc_.timings) return;
  for (const gpu::TimedScope& scope : timer_.read(slot)) times_.push_back({scope.name, scope.milliseconds, false});
  const bool by_effect = model_ == nullptr;
  // On GPUs, the first entry is the time of the whole effect, which contains the other entries.
  for (const PassTiming& pass :
       by_effect ? effect_->timings(in_flight_.at(slot).frame_index) : std::span<const PassTiming>())
    times_.push_back({pass.name, pass.gpu_ms, std::string_view(pass.name) != "effect"});
  double frame_ms = 0.0;
  for (const PassTime& pass : times_) frame_ms += pass.name == "effect" ? 0.0 : pass.ms;
  slow_ = frame_ms > desc_.ahead_up_to_ms;
}

// Submits commands of the frame that is being drawn, and also waits for them if waits() is true.
Result<void> Scene::execute(const gpu::Host::Record& record) {
  if (waits()) return host_->run(record);
  InFlight& frame = in_flight_.at(slot());
  frame.host = host_;
  TYNDALL_ASSIGN(frame.submission, host_->submit(record));
  return {};
}

}  // namespace tyndall::scene
