// The loop: wait, take what the hands did, draw the GUI, let the scenes follow, show them.
#include "viewer.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "config/text.hpp"
#include "gpu/try.hpp"
#include "scene/chart.hpp"
#include "viewer_state.hpp"

namespace tyndall::viewer {
namespace {

constexpr double kTables_ms = 60.0;         // of one step, while a scene is drawn between the steps
constexpr double kIdleAfter_s = 0.6;        // without anything from the hands
constexpr double kLongestFlightStep_s = 0.25;
constexpr float kSlowScale = 0.5F;
constexpr int kSlowCoarseness = 4;
constexpr int kFlightKeys[] = {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E};

// Memory of the process in KiB (proc(5), statm).
long resident_kib() {
  long pages = 0;
  long resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r"); file != nullptr) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

bool lost(const Error& error) {
  return error.code == ErrorCode::device_lost || error.vk_result == VK_ERROR_DEVICE_LOST;
}

}  // namespace

Viewer::~Viewer() {
  if (writing_.valid()) writing_.wait();
  left_.reset();
  other_.reset();
  next_.reset();
}

double Viewer::now() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

bool Viewer::slow_device() const { return host_->device().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }

Result<void> Viewer::start() {
  if (!desc_.log.empty() && !log_.open(desc_.log)) {
    return Error{ErrorCode::io, "cannot be written, '" + desc_.log + "', --log needs a file in a folder that exists"};
  }
  if (desc_.script == "walk") script_ = Script(Script::Kind::walk, 0.0, desc_.settings);
  if (desc_.script.starts_with("soak=")) {
    script_ = Script(Script::Kind::soak, std::strtod(desc_.script.c_str() + 5, nullptr), desc_.settings);
  }
  if (desc_.state_file.empty()) desc_.state_file = default_state_file();
  TYNDALL_TRY(window_.open(desc_.width, desc_.height, "Tyndall"));
  gpu::HostDesc host;
  host.device = desc_.device;
  host.validation = desc_.validation;
  host.validation_log = &validation_log_;
  host.instance_extensions = Window::instance_extensions();
  host.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  host.can_present = Window::can_present;
  TYNDALL_ASSIGN(host_, gpu::Host::create(host));
  shaders_ = std::make_unique<ShaderReload>();
  host_->set_replace_shader(&ShaderReload::replace, shaders_.get());
  if (slow_device()) {
    gui_.state.resolution_scale = kSlowScale;
    gui_.state.coarseness = kSlowCoarseness;
  }
  make_consistent(settings_);
  right_ = settings_;
  left_ = std::make_unique<Stage>();
  TYNDALL_TRY(make_stage(*left_, settings_));

  ImGui::CreateContext();
  gui_started_ = true;
  ImGui_ImplGlfw_InitForVulkan(window_.handle(), true);
  gui_.start();
  gui_.state.first_run = desc_.first_steps && viewer::first_run(desc_.state_file);
  gui_.state.vsync = true;
  TYNDALL_TRY(screen_.create(*host_, window_, true));
  TYNDALL_TRY(pictures_.create(host_->device(), screen_.format()));
  take_camera();
  log("started " + host_->device_name());
  return {};
}

VkExtent2D Viewer::picture_extent() const {
  const VkExtent2D window = window_.size();
  const auto scaled = [this](std::uint32_t side) {
    return std::clamp(static_cast<std::uint32_t>(std::lround(static_cast<double>(side) * gui_.state.resolution_scale)), 16U, 8192U);
  };
  return {scaled(window.width), scaled(window.height)};
}

Result<void> Viewer::make_stage(Stage& stage, const config::Settings& settings) {
  scene::SceneDesc desc;
  desc.extent = picture_extent();
  desc.timings = true;
  desc.histogram = true;
  desc.make_tables = desc_.make_tables;
  desc.terrain_coarseness = gui_.state.coarseness;
  desc.keep_shadows = true;
  stage.start(*host_, desc, settings);
  return {};
}

// How long to wait for the hands [s]: 0 while there is something to draw or build, negative for ever.
double Viewer::wait_time() const {
  if (frames_to_draw_ > 0) return 0.0;
  const bool flying = std::any_of(std::begin(kFlightKeys), std::end(kFlightKeys), [this](int key) { return window_.held(key); });
  const bool animated = settings_.scene.sun.animate && left_->ready();
  if (flying || animated || (script_.on() && left_->ready())) return 0.0;
  for (const Stage* stage : {left_.get(), other_.get(), next_.get()}) {
    if (stage == nullptr) continue;
    if (stage->building() || (stage->stale() && stage->ready())) return 0.0;
  }
  for (const Stage* stage : {left_.get(), other_.get()}) {
    if (stage != nullptr && stage->tone_stale()) return 1.0 / 60.0;
  }
  if (next_ != nullptr || left_->working() || (other_ != nullptr && other_->working()) || writing_.valid() || shaders_->working()) return 0.05;
  if (left_->ready() && !pipelines_.complete()) return std::max(kIdleAfter_s - (now() - last_activity_), 0.01);
  if (gui_.showing_toasts(now())) return 0.25;
  return -1.0;
}

Result<void> Viewer::loop() {
  while (!window_.closing()) {
    if (window_.minimised()) {
      window_.wait(0.5);
      TYNDALL_TRY(left_->poll());
      continue;
    }
    const double wait = wait_time();
    if (wait < 0.0) log("resting");
    window_.wait(wait);
    const Clock::time_point begin = Clock::now();
    const bool activity = window_.take_activity();
    if (activity) {
      last_activity_ = now();
      frames_to_draw_ = 3;
    }
    TYNDALL_TRY(step());
    const double took = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (took > longest_step_ms_) {
      longest_step_ms_ = took;
      log("longest_step " + std::to_string(took));
    }
  }
  log("leaving after " + std::to_string(frames_) + " frames");
  return {};
}

Result<void> Viewer::step() {
  finish_tasks();
  if (Result<void> polled = poll_next(); !polled) {
    if (lost(polled.error())) return polled;
    report(polled.error());
  }
  for (Stage* stage : {left_.get(), other_.get()}) {
    if (stage == nullptr) continue;
    if (Result<void> polled = stage->poll(); !polled) {
      // Without a scene there is nothing to go on with.
      if (lost(polled.error()) || (stage == left_.get() && stage->scene() == nullptr && !stage->creating())) return polled;
      (stage == left_.get() ? settings_ : right_) = stage->settings();
      report(polled.error());
    }
    for (const std::string& note : stage->take_notes()) tell(note);
  }
  const double before = last_step_;
  last_step_ = now();
  const double elapsed = last_step_ - before;
  begin_gui();
  handle_events(window_.take_events());
  follow_path(std::min(elapsed, kLongestFlightStep_s));
  fly(std::min(elapsed, kLongestFlightStep_s));
  window_.forget_keys();

  GuiFacts facts;
  facts.scene = left_->scene();
  facts.times = &times_;
  facts.device = host_->device_name();
  facts.state_file = desc_.state_file;
  facts.present_mode = screen_.present_mode();
  facts.window = window_.size();
  facts.picture = picture_extent();
  facts.creating = left_->creating() || (other_ != nullptr && other_->creating());
  facts.pipelines = pipelines_;
  for (const Stage* stage : {left_.get(), other_.get()}) {
    if (stage != nullptr && stage->building()) facts.tables = stage->scene()->tables_progress();
  }
  facts.shader_message = shader_message_;
  facts.slow_device = slow_device();
  facts.altitude_m = scene::altitude_of(camera_.position, settings_.effect.planet.radius_m);
  facts.height_m = height_m_;
  facts.speed_m_s = speed_m_s_;
  facts.has_path = !settings_.path.empty();
  facts.flying_path = flying_path_;
  facts.path_s = path_s_;
  facts.path_end_s = settings_.path.duration_s();
  facts.now = now();
  gui_.state.full_screen = window_.full_screen();
  const bool first_run_before = gui_.state.first_run;
  GuiRequests requests;
  run_script();
  const config::Settings sides[2] = {settings_, right_};
  gui_.draw(settings_, right_, facts, requests);
  log_sets(sides[0], settings_, "set ");
  log_sets(sides[1], right_, "set right ");
  if (first_run_before && !gui_.state.first_run) leave_first_run_mark(desc_.state_file);
  ImGui::Render();
  log_.places(gui_.widgets.places());
  if (gui_.state.full_screen != window_.full_screen()) window_.set_full_screen(gui_.state.full_screen);
  screen_.set_vsync(gui_.state.vsync);
  do_requests(requests);
  TYNDALL_TRY(follow());
  TYNDALL_TRY(work(frames_to_draw_ <= 0 && now() - last_activity_ > kIdleAfter_s));
  if (settings_.scene.sun.animate && gui_.state.playing && left_->ready()) {
    seconds_ += std::min(elapsed, kLongestFlightStep_s);
    left_->make_stale();
    if (other_ != nullptr) other_->make_stale();
  }
  TYNDALL_TRY(render());
  TYNDALL_TRY(present());
  --frames_to_draw_;
  return {};
}

// What a hand has set with a widget.
void Viewer::log_sets(const config::Settings& before, const config::Settings& after, const char* what) {
  if (!log_.on()) return;
  for (const config::Row& row : config::rows()) {
    if (!same_value(row, before, after)) log(what + row.key() + "=" + config::value_text(row, after));
  }
}

void Viewer::begin_gui() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Viewer::handle_events(const std::vector<Event>& events) {
  const ImGuiIO& io = ImGui::GetIO();
  const double height = std::max(window_.size().height, 1U);
  for (const Event& event : events) {
    switch (event.kind) {
      case Event::Kind::key:
        if (!io.WantTextInput || event.key == GLFW_KEY_ESCAPE) handle_key(event.key);
        break;
      case Event::Kind::press:
        log(event.button == Button::left ? "press left" : "press right");
        pointer_[0] = event.x;
        pointer_[1] = event.y;
        if (io.WantCaptureMouse) break;
        (event.button == Button::left ? dragging_view_ : dragging_sun_) = true;
        break;
      case Event::Kind::release:
        log(event.button == Button::left ? "release left" : "release right");
        (event.button == Button::left ? dragging_view_ : dragging_sun_) = false;
        break;
      case Event::Kind::move: {
        const double dx = event.x - pointer_[0];
        const double dy = event.y - pointer_[1];
        pointer_[0] = event.x;
        pointer_[1] = event.y;
        if (log_.on()) log("pointer " + config::number_text(event.x) + " " + config::number_text(event.y));
        if (dragging_view_) camera_ = turned(camera_, dx, dy, height);
        if (dragging_sun_) settings_.scene.sun = sun_turned(settings_.scene.sun, dx, dy, height);
        break;
      }
      case Event::Kind::wheel:
        if (!io.WantCaptureMouse) camera_ = zoomed(camera_, event.y);
        break;
    }
  }
}

// The flight of the scene file, by the same function as in `render`; hands stop it.
void Viewer::follow_path(double seconds) {
  if (!flying_path_) return;
  const bool hands = dragging_view_ || dragging_sun_ ||
                     std::any_of(std::begin(kFlightKeys), std::end(kFlightKeys), [this](int key) { return window_.held(key); });
  const double end_s = settings_.path.duration_s();
  if (hands || settings_.path.empty() || (!settings_.path.loop && path_s_ >= end_s)) {
    flying_path_ = false;
    log("path stops");
    return;
  }
  if (left_->ready()) path_s_ += seconds;
  if (!settings_.path.loop) path_s_ = std::min(path_s_, end_s);
  settings_.scene = scene::pose_at(settings_.path, path_s_, settings_.scene, settings_.effect.planet.radius_m);
  frames_to_draw_ = std::max(frames_to_draw_, 2);
}

void Viewer::fly(double seconds) {
  take_camera();
  const double radius_m = settings_.effect.planet.radius_m;
  const double altitude = scene::altitude_of(camera_.position, radius_m);
  const double ground = left_->scene() != nullptr ? left_->scene()->ground_below(camera_.position) : altitude - kLeastHeight_m;
  height_m_ = altitude - ground;
  Motion motion;
  if (!ImGui::GetIO().WantTextInput) {
    const auto axis = [this](int more, int less) { return (window_.held(more) ? 1.0 : 0.0) - (window_.held(less) ? 1.0 : 0.0); };
    motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
    motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    motion.fast = window_.held(GLFW_KEY_LEFT_SHIFT) || window_.held(GLFW_KEY_RIGHT_SHIFT);
  }
  speed_m_s_ = flight_speed(height_m_, motion.fast);
  if (motion.any()) {
    camera_ = moved(camera_, motion, seconds, speed_m_s_, radius_m);
    last_activity_ = now();
    frames_to_draw_ = std::max(frames_to_draw_, 2);
  }
  if (left_->scene() != nullptr) {
    camera_ = above_ground(camera_, left_->scene()->ground_below(camera_.position), radius_m);
  }
  put_camera();
}

// Takes the camera from the settings, when something else than put_camera() has changed them.
void Viewer::take_camera() {
  const scene::CameraParams& p = settings_.scene.camera;
  const scene::CameraParams& c = camera_params_;
  const bool same = first_frame_told_ || frames_ > 0 || last_step_ > 0.0
                        ? p.position_m == c.position_m && p.altitude_m == c.altitude_m && p.yaw_deg == c.yaw_deg &&
                              p.pitch_deg == c.pitch_deg && p.fov_deg == c.fov_deg
                        : false;
  if (same) return;
  camera_ = camera_from_params(p, settings_.effect.planet.radius_m);
  camera_params_ = p;
}

void Viewer::put_camera() {
  const CameraState before = camera_from_params(camera_params_, settings_.effect.planet.radius_m);
  const bool moved_at_all = camera_.yaw_deg != before.yaw_deg || camera_.pitch_deg != before.pitch_deg ||
                            camera_.fov_deg != before.fov_deg || glm::distance(camera_.position, before.position) > 1.0e-4;
  if (!moved_at_all) return;
  camera_to_params(camera_, settings_.scene.camera);
  camera_params_ = settings_.scene.camera;
}

Result<void> Viewer::follow_side(Stage& stage, config::Settings& settings) {
  make_consistent(settings);
  TYNDALL_TRY(stage.set_extent(picture_extent()));
  TYNDALL_TRY(stage.set_coarseness(gui_.state.coarseness));
  if (Result<void> followed = stage.follow(settings); !followed) {
    if (lost(followed.error())) return followed;
    report(followed.error());
    settings = stage.settings();
  }
  return {};
}

Result<void> Viewer::follow() {
  TYNDALL_TRY(follow_side(*left_, settings_));
  if (!gui_.state.picture.compare) {
    if (other_ != nullptr && !other_->working()) other_.reset();
    return {};
  }
  right_.scene.camera = settings_.scene.camera;
  right_.scene.sun = settings_.scene.sun;
  if (other_ == nullptr) {
    other_ = std::make_unique<Stage>();
    return make_stage(*other_, right_);
  }
  return follow_side(*other_, right_);
}

// Tables in slices; and when the hands rest, what makes later changes cheap.
Result<void> Viewer::work(bool idle) {
  for (Stage* stage : {left_.get(), other_.get(), next_.get()}) {
    if (stage == nullptr || stage->scene() == nullptr) continue;
    TYNDALL_ASSIGN(const bool built, stage->advance_tables(kTables_ms));
    if (built) {
      frames_to_draw_ = std::max(frames_to_draw_, 1);
      if (!stage->building()) log("tables");
      return {};
    }
  }
  if (!idle || !left_->ready()) return {};
  TYNDALL_ASSIGN(const bool kept, left_->keep_tables());
  if (kept) return {};
  if (!pipelines_.complete() || pipelines_.total == 0) {
    TYNDALL_ASSIGN(pipelines_, left_->scene()->effect().prepare_pipelines(1));
    if (pipelines_.complete()) log("pipelines");
  }
  return {};
}

// Seconds since that side was drawn last.
double Viewer::step_of(int side) {
  const double last = std::exchange(drawn_at_[side], now());
  return std::clamp(drawn_at_[side] - last, 1.0e-3, 1.0);
}

void Viewer::run_script() {
  if (script_.done()) window_.close();
  if (!script_.on() || !left_->ready() || left_->stale() || left_->working()) return;
  log("script " + script_.advance(settings_, gui_.state, now()));
  if (now() - last_memory_ < 2.0) return;
  last_memory_ = now();
  const scene::Scene::Memory memory = left_->scene()->memory();
  log("memory " + std::to_string(resident_kib()) + " " +
      std::to_string(memory.effect_persistent + memory.effect_transient + memory.effect_host + memory.scene));
}

void Viewer::log_frame(const Stage& stage, double took) {
  if (!log_.on()) return;
  const VkExtent2D extent = stage.scene()->extent();
  const scene::SceneParams& s = settings_.scene;
  log(std::string("frame ") + (&stage == left_.get() ? "left " : "right ") + std::to_string(frames_) + " " +
      std::to_string(extent.width) + " " + std::to_string(extent.height) + " ms " + config::number_text(took) + " camera " +
      config::number_text(camera_.position.x) + " " + config::number_text(camera_.position.y) + " " +
      config::number_text(camera_.position.z) + " " + config::number_text(camera_.yaw_deg) + " " +
      config::number_text(camera_.pitch_deg) + " " + config::number_text(camera_.fov_deg) + " sun " +
      config::number_text(s.sun.azimuth_deg) + " " + config::number_text(s.sun.elevation_deg));
  std::string passes = "passes";
  for (const scene::PassTime& pass : stage.scene()->timings()) {
    passes += " " + pass.name + " " + config::number_text(std::round(100.0 * pass.ms) / 100.0);
  }
  log(passes);
}

// At most one scene per step, so that the GUI stays at hand.
Result<void> Viewer::render() {
  Stage* stages[2] = {left_.get(), other_.get()};
  for (int i = 0; i < 2; ++i) {
    turn_ = !turn_;
    Stage* const stage = stages[turn_ ? 0 : 1];
    if (stage == nullptr || !stage->ready()) continue;
    const int side = turn_ ? 0 : 1;
    if (!stage->stale()) {
      if (stage == left_.get() && frames_ == 0) {  // the first frame came with the scene
        ++frames_;
        log_frame(*stage, 0.0);
      }
      if (!stage->tone_stale()) continue;
      TYNDALL_TRY(stage->tone(step_of(side)));
      frames_to_draw_ = std::max(frames_to_draw_, 1);
      continue;
    }
    const Clock::time_point begin = Clock::now();
    TYNDALL_TRY(stage->render(seconds_, step_of(side)));
    const double took = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (stage == left_.get()) {
      times_.add(stage->scene()->timings(), took);
      ++frames_;
    }
    log_frame(*stage, took);
    frames_to_draw_ = std::max(frames_to_draw_, 1);
    return {};
  }
  return {};
}

Result<void> Viewer::present() {
  const bool two = other_ != nullptr && other_->ready() && gui_.state.picture.compare && !other_->stale();
  const bool something = left_->ready() && frames_ > 0;
  TYNDALL_ASSIGN(const Drawn drawn, screen_.draw([&](VkCommandBuffer cmd, VkExtent2D window) -> Result<void> {
    if (!something) return {};
    return pictures_.record(cmd, window, *left_->scene(), two ? other_->scene() : nullptr, gui_.state.picture);
  }));
  if (desc_.script == "lose-device" && frames_ > 0) {
    return Error{ErrorCode::device_lost, "asked for by --script", VK_ERROR_DEVICE_LOST};
  }
  if (drawn == Drawn::surface_lost || (desc_.script == "lose-surface" && frames_ > 0)) {
    if (desc_.script == "lose-surface") desc_.script.clear();
    log("surface lost");
    TYNDALL_TRY(screen_.recover());
    frames_to_draw_ = 3;
  }
  if (drawn == Drawn::not_now) frames_to_draw_ = std::max(frames_to_draw_, 2);
  if (drawn == Drawn::done && something && (frames_ != shown_frame_ || screen_.extent().width != shown_width_)) {
    shown_frame_ = frames_;
    shown_width_ = screen_.extent().width;
    log("shown " + std::to_string(frames_) + " in " + std::to_string(screen_.extent().width) + " " +
        std::to_string(screen_.extent().height));
  }
  if (two != two_shown_) {
    two_shown_ = two;
    log(two ? "shown two" : "shown one");
  }
  if (drawn == Drawn::done && something && !first_frame_told_) {
    first_frame_told_ = true;
    log("ready " + std::to_string(now()));
  }
  if (drawn == Drawn::done && screenshot_wanted_ && something && !left_->stale()) write_screenshot();
  return {};
}

void Viewer::report(const Error& error) {
  log("error " + error.message);
  gui_.toast(error.message, true, now());
  std::fprintf(stderr, "tyndall: error: %s\n", config::one_line(error.message, 2000).c_str());
}

void Viewer::tell(const std::string& text) {
  log("note " + text);
  gui_.toast(text, false, now());
  frames_to_draw_ = std::max(frames_to_draw_, 2);
}

Result<void> run(const ViewerDesc& desc) {
  TYNDALL_TRY(Window::start());
  Result<void> outcome;
  std::uint32_t messages = 0;
  std::string text;
  {
    Viewer viewer(desc);
    outcome = viewer.start();
    if (outcome) outcome = viewer.loop();
    if (!outcome) outcome = viewer.after_loss(outcome.error());
    messages = viewer.validation_messages();
    text = viewer.validation_text();
  }
  if (ImGui::GetCurrentContext() != nullptr) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Window::stop();
  if (outcome && messages > 0) {
    return Error{ErrorCode::vulkan, std::to_string(messages) + " messages of the validation layer, the first: " +
                 config::one_line(text, 1500)};
  }
  return outcome;
}

}  // namespace tyndall::viewer
