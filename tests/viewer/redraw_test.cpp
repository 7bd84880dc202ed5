// The schedule of redraws: when the viewer draws its GUI, and how long its loop sleeps. Needs no window or scene.
#include "viewer/redraw.hpp"

#include <gtest/gtest.h>

namespace tyndall::viewer {
namespace {

// Returns a schedule whose GUI has settled, with the last input at 1 s.
Redraw settled() {
  Redraw redraw;
  redraw.note_input(1.0);
  while (redraw.due()) redraw.note_drawn(1.0);
  return redraw;
}

LoopState at(double now) {
  LoopState state;
  state.now = now;
  return state;
}

TEST(Redraw, DrawsUntilTheGuiHasSettledAndThenSleepsForEver) {
  Redraw redraw;
  redraw.note_input(1.0);
  int frames = 0;
  for (; redraw.due(); ++frames) {
    EXPECT_EQ(redraw.wait_time(at(1.0)), 0.0);
    redraw.note_drawn(1.0);
  }
  EXPECT_EQ(frames, 3);
  EXPECT_LT(redraw.wait_time(at(1.0)), 0.0);
}

TEST(Redraw, RequestsDoNotShortenWhatIsStillToBeDrawn) {
  Redraw redraw = settled();
  redraw.request(2);
  redraw.request(1);
  redraw.note_drawn(1.0);
  EXPECT_TRUE(redraw.due());
  redraw.note_drawn(1.0);
  EXPECT_FALSE(redraw.due());
}

TEST(Redraw, RestsOnlySomeTimeAfterTheLastInput) {
  const Redraw redraw = settled();
  EXPECT_FALSE(redraw.resting(1.5));
  EXPECT_TRUE(redraw.resting(1.7));
  Redraw moved = settled();
  moved.note_motion(5.0);
  EXPECT_TRUE(moved.due());
  EXPECT_FALSE(moved.resting(5.7));
}

TEST(Redraw, BeginsWorkAtOnceAndWakesForMotion) {
  const Redraw redraw = settled();
  LoopState state = at(2.0);
  state.work_due = true;
  EXPECT_EQ(redraw.wait_time(state), 0.0);
  state = at(2.0);
  state.moving = true;
  EXPECT_NEAR(redraw.wait_time(state), 1.0 / 60.0, 1e-9);
  state.slow_device = true;
  EXPECT_NEAR(redraw.wait_time(state), 1.0 / 30.0, 1e-9);
}

TEST(Redraw, LeavesTheProcessorToASlowDeviceBetweenFrames) {
  Redraw redraw = settled();
  redraw.request(1);
  LoopState state = at(1.01);
  state.slow_device = true;
  EXPECT_FALSE(redraw.throttled(state));  // nothing is being drawn
  EXPECT_EQ(redraw.wait_time(state), 0.0);
  state.busy = true;
  EXPECT_TRUE(redraw.throttled(state));
  EXPECT_NEAR(redraw.wait_time(state), 1.0 + 1.0 / 30.0 - 1.01, 1e-9);
  state.now = 1.1;
  EXPECT_FALSE(redraw.throttled(state));
}

TEST(Redraw, WakesForTheEarliestDeadline) {
  const Redraw redraw = settled();
  LoopState state = at(1.2);
  state.store_tables_in_s = 20.0;
  EXPECT_NEAR(redraw.wait_time(state), 20.0, 1e-9);
  state.idle_work = true;  // begins 0.6 s after the last input
  EXPECT_NEAR(redraw.wait_time(state), 0.4, 1e-9);
  state.showing_toasts = true;
  EXPECT_NEAR(redraw.wait_time(state), 0.25, 1e-9);
  state.now = 2.0;  // resting: idle work has become due, and is no longer waited for
  state.showing_toasts = false;
  EXPECT_NEAR(redraw.wait_time(state), 20.0, 1e-9);
}

}  // namespace
}  // namespace tyndall::viewer
