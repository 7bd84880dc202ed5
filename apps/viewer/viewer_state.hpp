// The viewer itself, between the window, the GUI and the scenes. viewer.cpp has the loop, viewer_actions.cpp what
// keys and menus ask for.
#pragma once

#include <chrono>
#include <future>

#include "camera_control.hpp"
#include "event_log.hpp"
#include "gui.hpp"
#include "screen.hpp"
#include "script.hpp"
#include "shader_reload.hpp"
#include "stage.hpp"
#include "viewer.hpp"
#include "window.hpp"

namespace tyndall::viewer {

class Viewer {
 public:
  explicit Viewer(const ViewerDesc& desc) : desc_(desc), settings_(desc.settings), right_(desc.settings) {}
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer();

  Result<void> start();
  Result<void> loop();
  [[nodiscard]] std::uint32_t validation_messages() const { return host_ != nullptr ? host_->validation_messages() : 0; }
  [[nodiscard]] std::string validation_text() const { return host_ != nullptr ? host_->validation_text() : ""; }
  // What is left to do when the device or the surface is gone: keeps the state, and tells where.
  Error after_loss(const Error& error);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] double now() const;
  [[nodiscard]] double wait_time() const;
  Result<void> step();
  void begin_gui();
  void log_sets(const config::Settings& before, const config::Settings& after, const char* what);
  void handle_events(const std::vector<Event>& events);
  void handle_key(int key);
  void fly(double seconds);
  void follow_path(double seconds);
  void take_camera();
  void put_camera();
  Result<void> follow();
  Result<void> follow_side(Stage& stage, config::Settings& settings);
  Result<void> work(bool idle);
  void run_script();
  void log_frame(const Stage& stage, double took);
  Result<void> render();
  double step_of(int side);
  Result<void> present();
  void report(const Error& error);
  void tell(const std::string& text);
  void log(const std::string& text) { log_.line(now(), text); }

  void do_requests(const GuiRequests& requests);
  void save_state();
  void restore_state();
  void load_file(const std::string& path, bool over_defaults);
  void take_screenshot();
  void write_screenshot();
  void start_reload();
  Result<void> finish_reload();
  Result<void> poll_next();
  void finish_tasks();
  Result<void> make_stage(Stage& stage, const config::Settings& settings);
  [[nodiscard]] VkExtent2D picture_extent() const;
  [[nodiscard]] bool slow_device() const;

  ViewerDesc desc_;
  Clock::time_point started_ = Clock::now();
  EventLog log_;
  std::vector<std::string> validation_log_;
  Window window_;
  std::unique_ptr<gpu::Host> host_;
  std::unique_ptr<ShaderReload> shaders_;  // outlives the scenes
  Screen screen_;
  Pictures pictures_;
  Gui gui_;
  bool gui_started_ = false;
  config::Settings settings_, right_;   // wanted, of the left (or only) and the right side
  std::unique_ptr<Stage> left_, other_;
  std::unique_ptr<Stage> next_;         // with rebuilt shaders, until it can take the place of left_
  FrameTimes times_;
  Progress pipelines_ = {};

  CameraState camera_;
  scene::CameraParams camera_params_;   // as put_camera() wrote them
  double speed_m_s_ = 0.0, height_m_ = 0.0;
  bool dragging_view_ = false, dragging_sun_ = false;
  double pointer_[2] = {0.0, 0.0};
  double seconds_ = 0.0;                // of the scene's own time
  bool flying_path_ = false;            // along the path of the scene file
  double path_s_ = 0.0;
  double last_step_ = 0.0;
  double last_activity_ = 0.0;
  int frames_to_draw_ = 3;              // of the GUI, until it has settled
  std::uint64_t frames_ = 0;            // of the scene
  bool turn_ = false;                   // whose turn it is to be rendered, with two sides
  bool first_frame_told_ = false;
  bool two_shown_ = false;
  std::uint64_t shown_frame_ = 0;
  std::uint32_t shown_width_ = 0;
  bool screenshot_wanted_ = false;
  std::future<Result<std::string>> writing_;
  std::string shader_message_;
  double longest_step_ms_ = 0.0;
  Script script_;
  double last_memory_ = -100.0;
  double drawn_at_[2] = {0.0, 0.0};     // when each side was drawn or exposed last [s]
};

}  // namespace tyndall::viewer
