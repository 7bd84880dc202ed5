// The scenes of the viewer: the left (or only) one, the right one of a comparison, and a replacement of the left one
// while shaders are reloaded. Gives them work, one piece at a time, and takes their pictures.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "viewer/camera_control.hpp"
#include "viewer/notices.hpp"
#include "viewer/scenes/frame_times.hpp"
#include "viewer/scenes/pictures.hpp"
#include "viewer/scenes/scene_thread.hpp"

namespace tyndall::viewer {

// The requested contents of the scenes.
struct PairRequest {
  std::array<config::Settings, 2> settings;  // settings of the left and the right scene
  bool compare = false;                      // show both scenes
  VkExtent2D extent = {};                    // size of each picture
  int coarseness = 1;                        // see TerrainLod
  View view;
  double seconds = 0.0;  // time of the scenes
  bool resting = false;  // the user is idle
  bool capture = false;  // return the left picture as images
  CameraState camera;    // for the event log
};

// The work that the scenes have finished since the last call.
struct PairResult {
  // Settings that a scene refused, and its current settings.
  struct Refused {
    config::Settings requested, current;
  };
  std::array<std::optional<Refused>, 2> refused;
  bool right_ended = false;  // the right scene has ended with an error, which has been reported
  std::optional<Capture> capture;
  bool replaced = false;                   // the replacement has become the left scene
  std::optional<Error> replacement_error;  // why no replacement could be created; the left scene stays
};

class ScenePair {
 public:
  ScenePair(Notices& notices, Redraw& redraw) : notices_(&notices), redraw_(&redraw) {}
  ScenePair(const ScenePair&) = delete;
  ScenePair& operator=(const ScenePair&) = delete;
  ~ScenePair();

  // Begins to create the left scene. `one_device`: the window uses the device of the scenes.
  void start(gpu::Host& host, bool one_device, const tables::MakeReady& make_tables, PairRequest request);
  // Creates the pipelines that draw the pictures into a window of this format.
  Result<void> create_pictures(gpu::Host& window_host, VkFormat format) {
    return pictures_.create(window_host, format);
  }
  // Begins to create a scene that will replace the left one, with other settings for building tables.
  void start_replacement(const tables::MakeReady& make_tables);

  // Sets the request for the next pieces of work.
  void request(PairRequest request) { request_ = std::move(request); }
  // Requests new frames although no parameter has changed.
  void request_frames() { again_ = {true, true}; }
  // Notes user input: "settled" is logged again once nothing is left to do.
  void note_input() { settled_logged_ = false; }
  // Creates or ends the right scene and launches the next piece of work.
  void update();
  // Returns the finished work. An error ends the viewer.
  Result<PairResult> take_results();
  // Records the pictures into a rendering scope over the window.
  Result<void> record(VkCommandBuffer cmd, VkExtent2D window, const PictureOptions& options);

  // Returns the facts of the left scene.
  [[nodiscard]] const SceneFacts& facts() const { return left_->facts(); }
  [[nodiscard]] Progress tables() const;  // progress of a scene that is building tables
  [[nodiscard]] bool creating() const;
  // Returns whether the left scene shows what was requested and nothing is under way.
  [[nodiscard]] bool settled() const;
  // Fills in the state of the scenes for the loop.
  void describe(LoopState& state) const;
  [[nodiscard]] std::uint64_t frames() const { return frames_; }  // frames that the left scene has drawn
  [[nodiscard]] const FrameTimes& times() const { return times_; }
  [[nodiscard]] bool has_right() const { return right_ != nullptr; }
  [[nodiscard]] bool has_right_picture() const { return pictures_.has(1); }

 private:
  struct Pose {
    CameraState camera;
    scene::SunParams sun;
  };

  [[nodiscard]] std::unique_ptr<SceneThread> start_thread(const SceneRequest& request) const;
  [[nodiscard]] SceneRequest request_of(const SceneThread* thread) const;
  void launch();
  [[nodiscard]] bool work_is_due() const;
  Result<void> take_result(std::size_t side, SceneResult& result, PairResult& out);
  Result<void> take_replacement(PairResult& out);
  void log_frame(std::size_t side, double took_ms);

  Notices* notices_;
  Redraw* redraw_;
  gpu::Host* host_ = nullptr;
  bool one_device_ = false;
  tables::MakeReady make_tables_;
  PairRequest request_;
  Pictures pictures_;
  std::unique_ptr<SceneThread> left_, right_;
  std::unique_ptr<SceneThread> replacement_;
  std::optional<Picture> replacement_picture_;
  std::future<void> retired_;  // destroys a left scene that was replaced
  FrameTimes times_;
  std::uint64_t frames_ = 0;
  bool left_first_ = false;  // the left scene is next; the order alternates
  std::array<bool, 2> again_ = {false, false};
  std::array<Pose, 2> drawn_poses_;  // the poses of the frames that are being drawn, or were drawn last
  bool settled_logged_ = false;
};

// Returns whether the device is gone.
[[nodiscard]] bool device_lost(const Error& error);

}  // namespace tyndall::viewer
