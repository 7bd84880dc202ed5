#include "viewer/redraw.hpp"

#include <algorithm>

namespace tyndall::viewer {
namespace {

constexpr int kSettlingFrames = 3;  // frames until ImGui's layout no longer changes
constexpr double kRestAfter_s = 0.6;
constexpr double kFlightPeriod_s = 1.0 / 60.0;
constexpr double kSlowPeriod_s = 1.0 / 30.0;  // between frames of the GUI while a CPU device draws the scene
constexpr double kAdaptionPeriod_s = 1.0 / 60.0;
constexpr double kPollPeriod_s = 0.25;  // between checks for threads that cannot wake the loop when they have finished

}  // namespace

void Redraw::request(int frames) { frames_ = std::max(frames_, frames); }

void Redraw::note_input(double now) {
  last_input_ = now;
  frames_ = kSettlingFrames;
}

void Redraw::note_motion(double now) {
  last_input_ = now;
  request(2);
}

void Redraw::note_drawn(double now) {
  last_drawn_ = now;
  --frames_;
}

bool Redraw::resting(double now) const { return !due() && now - last_input_ > kRestAfter_s; }

bool Redraw::throttled(const LoopState& state) const {
  return state.slow_device && state.busy && state.now - last_drawn_ < kSlowPeriod_s;
}

double Redraw::wait_time(const LoopState& state) const {
  if (due()) return throttled(state) ? std::max(last_drawn_ + kSlowPeriod_s - state.now, 0.001) : 0.0;
  if (state.work_due) return 0.0;
  if (state.moving) return state.slow_device ? kSlowPeriod_s : kFlightPeriod_s;
  if (state.adapting) return kAdaptionPeriod_s;
  if (state.busy || state.background) return kPollPeriod_s;
  double wait = -1.0;
  const auto within = [&wait](double seconds) { wait = wait < 0.0 ? seconds : std::min(wait, seconds); };
  if (state.store_tables_in_s >= 0.0) within(std::max(state.store_tables_in_s, 0.05));
  if (state.idle_work && !resting(state.now)) within(std::max(kRestAfter_s - (state.now - last_input_), 0.01));
  if (state.showing_toasts) within(kPollPeriod_s);
  return wait;
}

}  // namespace tyndall::viewer
