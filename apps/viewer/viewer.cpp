// The loop: wait, take what the hands did and what the scenes have become, draw the GUI, show it.
#include "viewer/viewer.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "files/text.hpp"
#include "gpu/try.hpp"
#include "scene/description/map_projection.hpp"
#include "viewer/platform/display_loss.hpp"
#include "viewer/scenes/settings_compare.hpp"
#include "viewer/viewer_state.hpp"

namespace tyndall::viewer {
namespace {

constexpr double kIdleAfter_s = 0.6;  // without anything from the hands
constexpr double kLongestFlightStep_s = 0.25;
constexpr double kFlightPeriod_s = 1.0 / 60.0;
constexpr double kSlowPeriod_s = 1.0 / 30.0;  // between frames of the GUI while a device without a GPU draws the scene
constexpr float kSlowScale = 0.5F;
constexpr int kSlowCoarseness = 4;

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

// What the process has of that from malloc and not given back, in KiB; 0 where that cannot be told.
std::size_t allocated_kib() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  return (info.uordblks + info.hblkhd) / 1024;
#else
  return 0;
#endif
}

void say(const Error& error) {
  std::fprintf(stderr, "tyndall: error: %s\n", files::one_line(error.message, 2000).c_str());
}

}  // namespace

Viewer::~Viewer() {
  if (writing_.valid()) writing_.wait();
  if (retired_.valid()) retired_.wait();
  left_.reset();
  other_.reset();
  next_.reset();
}

double Viewer::now() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

bool Viewer::slow_device() const { return host_->device().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }

std::uint32_t Viewer::validation_messages() const {
  if (host_ == nullptr) return 0;
  return host_->validation_messages() +
         (window_host_ != host_ && window_host_ != nullptr ? window_host_->validation_messages() : 0);
}

std::string Viewer::validation_text() const {
  if (host_ == nullptr) return "";
  return host_->validation_text() +
         (window_host_ != host_ && window_host_ != nullptr ? window_host_->validation_text() : "");
}

Result<void> Viewer::start() {
  if (!desc_.log.empty() && !log_.open(desc_.log)) {
    return Error{ErrorCode::io, "cannot be written, '" + desc_.log + "', --log needs a file in a folder that exists"};
  }
  if (desc_.script == "walk") script_ = Script(Script::Kind::walk, 0.0, 0, desc_.settings);
  if (desc_.script.starts_with("soak=")) {
    script_ = Script(Script::Kind::soak, std::strtod(desc_.script.c_str() + 5, nullptr), 0, desc_.settings);
  }
  if (desc_.script.starts_with("soak-frames=")) {
    script_ = Script(Script::Kind::soak, 0.0, std::strtoull(desc_.script.c_str() + 12, nullptr, 10), desc_.settings);
  }
  if (desc_.state_file.empty()) desc_.state_file = default_state_file();
  TYNDALL_TRY(window_.open(desc_.width, desc_.height, "Tyndall"));
  watch_window(window_.handle());
  on_display_loss([this] {
    say(after_loss(
        {ErrorCode::device_lost, "the connection to the display has broken off", VK_ERROR_SURFACE_LOST_KHR}));
  });
  TYNDALL_TRY(open_device());
  if (slow_device()) {
    gui_.state.resolution_scale = kSlowScale;
    gui_.state.coarseness = kSlowCoarseness;
  }
  make_consistent(settings_);
  right_ = settings_;
  take_camera();
  drawn_camera_[0] = {camera_, settings_.scene.sun};
  left_ = std::make_unique<SceneThread>();
  start_scene(*left_);
  TYNDALL_TRY(open_window_device());

  ImGui::CreateContext();
  gui_started_ = true;
  window_.start_gui();
  gui_.start();
  gui_.state.first_run = desc_.first_steps && viewer::first_run(desc_.state_file);
  gui_.state.vsync = true;
  TYNDALL_TRY(swapchain_.create(*window_host_, window_, true));
  TYNDALL_TRY(pictures_.create(*window_host_, swapchain_.format()));
  log("started " + host_->device_name());
  return {};
}

gpu::HostDesc Viewer::host_desc() const {
  gpu::HostDesc desc;
  desc.device = desc_.device;
  desc.validation = desc_.validation;
  desc.instance_extensions = Window::instance_extensions();
  desc.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  desc.can_present = Window::can_present;
  return desc;
}

Result<void> Viewer::open_device() {
  TYNDALL_ASSIGN(host_, gpu::Host::create(host_desc()));
  shaders_ = std::make_unique<ShaderReload>();
  host_->set_replace_shader(&ShaderReload::replace, shaders_.get());
  if (!slow_device() || desc_.script == "one-device") window_host_ = host_;
  return {};
}

// While the scene is being created already.
Result<void> Viewer::open_window_device() {
  if (window_host_ != nullptr) return {};
  TYNDALL_ASSIGN(window_host_, gpu::Host::create(host_desc()));
  return {};
}

// How long to wait for the hands [s]: 0 while there is something to draw or to begin, negative for ever.
double Viewer::wait_time() const {
  if (frames_to_draw_ > 0) return throttled() ? std::max(last_present_ + kSlowPeriod_s - now(), 0.001) : 0.0;
  if (work_is_due()) return 0.0;
  const bool busy = left_->busy() || (other_ != nullptr && other_->busy()) || next_ != nullptr;
  const bool moving = flying() || flying_path_ || settings_.scene.sun.animate;
  if (moving) return slow_device() ? kSlowPeriod_s : kFlightPeriod_s;
  for (const SceneThread* thread : {left_.get(), other_.get()}) {
    if (thread != nullptr && thread->facts().tone_stale) return 1.0 / 60.0;
  }
  // Threads wake the loop when they are done.
  if (busy || left_->facts().working || (other_ != nullptr && other_->facts().working) || writing_.valid() ||
      shaders_->working()) {
    return 0.25;
  }
  double wait = -1.0;
  const auto within = [&wait](double seconds) { wait = wait < 0.0 ? seconds : std::min(wait, seconds); };
  const SceneFacts& facts = left_->facts();
  if (facts.keep_tables_in_s >= 0.0) within(std::max(facts.keep_tables_in_s, 0.05));
  if (facts.can_render && !resting() && (!facts.pipelines.complete() || facts.pipelines.total == 0 || wait >= 0.0)) {
    within(std::max(kIdleAfter_s - (now() - last_activity_), 0.01));
  }
  if (gui_.showing_toasts(now())) within(0.25);
  return wait;
}

bool Viewer::resting() const { return frames_to_draw_ <= 0 && now() - last_activity_ > kIdleAfter_s; }

bool Viewer::throttled() const {
  const bool busy = left_->busy() || (other_ != nullptr && other_->busy());
  return slow_device() && busy && now() - last_present_ < kSlowPeriod_s;
}

Result<void> Viewer::loop() {
  while (!window_.closing()) {
    if (window_.minimised() != minimised_) {
      minimised_ = !minimised_;
      log(minimised_ ? "minimised" : "restored");
    }
    if (window_is_gone()) {
      return Error{ErrorCode::device_lost, "the window has been destroyed from outside", VK_ERROR_SURFACE_LOST_KHR};
    }
    if (minimised_) {
      window_.wait(0.5);
      TYNDALL_TRY(take_results());
      continue;
    }
    const double wait = wait_time();
    if (wait < 0.0) log("resting");
    window_.wait(wait);
    const Clock::time_point begin = Clock::now();
    if (window_.take_activity()) {
      last_activity_ = now();
      frames_to_draw_ = 3;
      settled_told_ = false;
    }
    TYNDALL_TRY(step());
    const double took_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (steps_.add(took_ms)) log("longest_step " + std::to_string(took_ms));
  }
  log("steps " + steps_.text());
  log("leaving after " + std::to_string(frames_) + " frames");
  return {};
}

Result<void> Viewer::step() {
  finish_tasks();
  TYNDALL_TRY(take_results());
  const double before = std::exchange(last_step_, now());
  const double elapsed = std::min(last_step_ - before, kLongestFlightStep_s);
  begin_gui();
  handle_events(window_.take_events());
  follow_path(elapsed);
  fly(elapsed);
  window_.forget_keys();
  run_script();
  draw_gui();
  if (settings_.scene.sun.animate && gui_.state.playing && left_->facts().can_render) {
    seconds_ += elapsed;
    again_[0] = again_[1] = true;
  }
  follow();
  launch_work();
  if (frames_to_draw_ > 0 && !throttled()) TYNDALL_TRY(present());
  return {};
}

GuiFacts Viewer::gui_facts() const {
  GuiFacts facts;
  facts.scene = &left_->facts();
  facts.times = &times_;
  facts.device = host_->device_name();
  facts.state_file = desc_.state_file;
  facts.present_mode = swapchain_.present_mode();
  facts.window = window_.size();
  facts.picture = picture_extent();
  facts.creating = left_->creating() || (other_ != nullptr && other_->creating());
  facts.pipelines = left_->facts().pipelines;
  for (const SceneThread* thread : {left_.get(), other_.get()}) {
    if (thread != nullptr && thread->facts().building) facts.tables = thread->facts().tables;
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
  return facts;
}

void Viewer::draw_gui() {
  gui_.state.full_screen = window_.full_screen();
  const bool first_run_before = gui_.state.first_run;
  GuiRequests requests;
  const config::Settings sides[2] = {settings_, right_};
  gui_.draw(settings_, right_, gui_facts(), requests);
  log_sets(sides[0], settings_, "set ");
  log_sets(sides[1], right_, "set right ");
  if (first_run_before && !gui_.state.first_run) leave_first_run_mark(desc_.state_file);
  ImGui::Render();
  log_.places(gui_.widgets.places());
  // After the places that the pointer has been seen among.
  if (!pointer_seen_.empty()) log(std::exchange(pointer_seen_, {}));
  if (gui_.state.full_screen != window_.full_screen()) window_.set_full_screen(gui_.state.full_screen);
  swapchain_.set_vsync(gui_.state.vsync);
  do_requests(requests);
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
  window_.begin_gui();
  ImGui::NewFrame();
}

void Viewer::run_script() {
  if (script_.done()) window_.close();
  if (!script_.on() || left_->busy() || left_->facts().working || !left_->shows(request_of(*left_))) return;
  log("script " + script_.advance(settings_, gui_.state, now(), frames_));
  frames_to_draw_ = std::max(frames_to_draw_, 1);
  if (now() - last_memory_ < 2.0) return;
  last_memory_ = now();
  const scene::Scene::Memory& memory = left_->facts().memory;
  log("memory " + std::to_string(resident_kib()) + " " +
      std::to_string(memory.effect_persistent + memory.effect_transient + memory.effect_host + memory.scene) + " " +
      std::to_string(allocated_kib()));
}

Result<void> Viewer::present() {
  const bool two = gui_.state.picture.compare && pictures_.has(1);
  TYNDALL_ASSIGN(const Drawn drawn, swapchain_.draw([&](VkCommandBuffer cmd, VkExtent2D window) -> Result<void> {
    return pictures_.record(cmd, window, two, gui_.state.picture);
  }));
  last_present_ = now();
  --frames_to_draw_;
  const bool something = frames_ > 0;
  if (desc_.script == "lose-device" && something) {
    return Error{ErrorCode::device_lost, "asked for by --script", VK_ERROR_DEVICE_LOST};
  }
  if (drawn == Drawn::surface_lost || (desc_.script == "lose-surface" && something)) {
    if (desc_.script == "lose-surface") desc_.script.clear();
    log("surface lost");
    TYNDALL_TRY(swapchain_.recover());
    frames_to_draw_ = 3;
  }
  if (drawn == Drawn::not_now) frames_to_draw_ = std::max(frames_to_draw_, 2);
  if (drawn != Drawn::done) return {};
  if (present_mode_ != swapchain_.present_mode()) {
    present_mode_ = swapchain_.present_mode();
    log("present_mode " + present_mode_);
  }
  if (!opened_) {
    // The window's first frame is part of starting: the driver makes its own of the GUI's shaders.
    opened_ = true;
    log("opened");
  }
  if (something && (frames_ != shown_frame_ || swapchain_.extent().width != shown_width_)) {
    shown_frame_ = frames_;
    shown_width_ = swapchain_.extent().width;
    log("shown " + std::to_string(frames_) + " in " + std::to_string(swapchain_.extent().width) + " " +
        std::to_string(swapchain_.extent().height));
  }
  if (two != two_shown_) {
    two_shown_ = two;
    log(two ? "shown two" : "shown one");
  }
  if (something && !first_frame_told_) {
    first_frame_told_ = true;
    log("ready " + std::to_string(now()));
  }
  return {};
}

void Viewer::report(const Error& error) {
  log("error " + error.message);
  gui_.toast(error.message, true, now());
  say(error);
}

void Viewer::tell(const std::string& text) {
  log("note " + text);
  gui_.toast(text, false, now());
  frames_to_draw_ = std::max(frames_to_draw_, 2);
}

Result<void> run(const ViewerDesc& desc) {
#ifdef __GLIBC__
  // Threads come and go here and in the drivers: with an arena for each, memory that was freed lies about in all of
  // them. Large blocks, the tables and pictures of a device without a GPU, go back to the system when they are freed.
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
  TYNDALL_TRY(Window::start());
  Result<void> outcome;
  std::uint32_t messages = 0;
  std::string text;
  {
    Viewer viewer(desc);
    outcome = viewer.start();
    if (outcome) outcome = viewer.loop();
    if (!outcome) outcome = viewer.after_loss(outcome.error());
    // What there is to say has been found out; when the display breaks off only now, it is still to be said.
    on_display_loss([outcome] {
      if (!outcome) say(outcome.error());
    });
    messages = viewer.validation_messages();
    text = viewer.validation_text();
  }
  if (ImGui::GetCurrentContext() != nullptr) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Window::stop();
  if (outcome && messages > 0) {
    return Error{ErrorCode::vulkan, std::to_string(messages) +
                                        " messages of the validation layer, the first: " + files::one_line(text, 1500)};
  }
  return outcome;
}

}  // namespace tyndall::viewer
