// The viewer itself, between the window, the GUI and the scenes. viewer.cpp has the loop, viewer_hands.cpp the flight,
// viewer_scenes.cpp what becomes of the scenes, viewer_actions.cpp what keys and menus ask for.
#pragma once

#include <chrono>
#include <future>

#include "viewer/camera_control.hpp"
#include "viewer/event_log.hpp"
#include "viewer/gui/gui.hpp"
#include "viewer/platform/swapchain.hpp"
#include "viewer/platform/window.hpp"
#include "viewer/scenes/scene_thread.hpp"
#include "viewer/script.hpp"
#include "viewer/shader_reload.hpp"
#include "viewer/step_times.hpp"
#include "viewer/viewer.hpp"

namespace tyndall::viewer {

[[nodiscard]] inline bool lost(const Error& error) {
  return error.code == ErrorCode::device_lost || error.vk_result == VK_ERROR_DEVICE_LOST;
}

class Viewer {
 public:
  explicit Viewer(const ViewerDesc& desc) : desc_(desc), settings_(desc.settings), right_(desc.settings) {}
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer();

  Result<void> start();
  Result<void> loop();
  // Of the validation layer, on both devices.
  [[nodiscard]] std::uint32_t validation_messages() const;
  [[nodiscard]] std::string validation_text() const;
  // What is left to do when the device or the surface is gone: keeps the state, and tells where.
  Error after_loss(const Error& error);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] double now() const;
  [[nodiscard]] double wait_time() const;
  [[nodiscard]] bool resting() const;
  [[nodiscard]] bool throttled() const;
  [[nodiscard]] gpu::HostDesc host_desc() const;
  Result<void> open_device();
  Result<void> open_window_device();
  Result<void> step();
  void begin_gui();
  void draw_gui();
  [[nodiscard]] GuiFacts gui_facts() const;
  Result<void> present();
  void report(const Error& error);
  void tell(const std::string& text);
  void log(const std::string& text) { log_.line(now(), text); }
  void log_sets(const config::Settings& before, const config::Settings& after, const char* what);
  void run_script();

  void handle_events(const std::vector<Event>& events);
  void handle_key(int key);
  void fly(double seconds);
  [[nodiscard]] bool flying() const;
  [[nodiscard]] double ground_below(const SceneFacts& facts) const;
  void follow_path(double seconds);
  void take_camera();
  void put_camera();

  void start_scene(SceneThread& thread);
  [[nodiscard]] SceneRequest request_of(const SceneThread& thread) const;
  [[nodiscard]] VkExtent2D picture_extent() const;
  void follow();
  void launch_work();
  [[nodiscard]] bool work_is_due() const;
  Result<void> take_results();
  Result<void> take_result(std::size_t side, SceneResult& outcome);
  Result<void> take_next();
  void log_frame(std::size_t side, double took_ms);

  void do_requests(const GuiRequests& requests);
  void save_state();
  void restore_state();
  void load_file(const std::string& path, bool over_defaults);
  void write_screenshot(Capture capture);
  void start_reload();
  Result<void> finish_reload();
  void finish_tasks();
  [[nodiscard]] bool slow_device() const;

  ViewerDesc desc_;
  Clock::time_point started_ = Clock::now();
  EventLog log_;
  Window window_;
  // The scenes' device, and the window's. On a device without a GPU the window has one of its own: a queue works
  // through what it gets in order, and the GUI would wait for whole frames of the scene. The same one otherwise.
  std::shared_ptr<gpu::Host> host_, window_host_;
  std::unique_ptr<ShaderReload> shaders_;  // outlives the scenes
  Swapchain swapchain_;
  Pictures pictures_;
  Gui gui_;
  bool gui_started_ = false;
  config::Settings settings_, right_;  // wanted, of the left (or only) and the right side
  std::unique_ptr<SceneThread> left_, other_;
  std::unique_ptr<SceneThread> next_;  // with rebuilt shaders, until it can take the place of left_
  std::optional<Picture> next_picture_;
  FrameTimes times_;
  StepTimes steps_;

  CameraState camera_;
  scene::CameraParams camera_params_;  // as put_camera() wrote them
  double speed_m_s_ = 0.0, height_m_ = 0.0;
  bool dragging_view_ = false, dragging_sun_ = false;
  double pointer_[2] = {0.0, 0.0};
  std::string pointer_seen_;  // for the log
  double seconds_ = 0.0;      // of the scene's own time
  bool flying_path_ = false;  // along the path of the scene file
  double path_s_ = 0.0;
  double last_step_ = 0.0;
  double last_activity_ = 0.0;
  int frames_to_draw_ = 3;          // of the GUI, until it has settled
  std::uint64_t frames_ = 0;        // of the scene
  bool turn_ = false;               // whose turn it is to be worked on, with two sides
  bool again_[2] = {false, false};  // the scene's time has gone on
  struct Pose {
    CameraState camera;
    scene::SunParams sun;
  } drawn_camera_[2];  // of the frame that is being drawn, or was last
  bool settled_told_ = false;
  double last_present_ = -1.0;
  bool minimised_ = false;
  bool opened_ = false;  // the window has shown something
  bool first_frame_told_ = false;
  bool two_shown_ = false;
  std::string present_mode_;  // that was told
  std::uint64_t shown_frame_ = 0;
  std::uint32_t shown_width_ = 0;
  bool screenshot_wanted_ = false;
  std::future<Result<std::string>> writing_;
  std::future<void> retired_;  // a scene that is being given back
  std::string shader_message_;
  Script script_;
  double last_memory_ = -100.0;
};

}  // namespace tyndall::viewer
