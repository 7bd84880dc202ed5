#include "viewer/viewer_loop.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "files/text.hpp"
#include "gpu/try.hpp"
#include "image/image.hpp"
#include "scene/description/map_projection.hpp"
#include "viewer/platform/display_loss.hpp"
#include "viewer/platform/files.hpp"
#include "viewer/platform/process_memory.hpp"
#include "viewer/scenes/settings_compare.hpp"

namespace tyndall::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMaxFlightStep_s = 0.25;
constexpr float kSlowScale = 0.5F;  // scale of the resolution on a CPU device
constexpr int kSlowCoarseness = 4;  // coarseness of the terrain on a CPU device
constexpr double kMemoryLogPeriod_s = 2.0;

}  // namespace

Result<void> Viewer::start() {
  if (!desc_.log.empty() && !notices_.events().open(desc_.log)) {
    return Error{ErrorCode::io, "--log: cannot write '" + desc_.log + "'; expected a file in an existing folder"};
  }
  script_ = Script(desc_.script, desc_.settings);
  if (settings_.state_file.empty()) settings_.state_file = default_state_file();
  TYNDALL_TRY(window_.open(desc_.width, desc_.height, "Tyndall"));
  watch_window(window_.handle());
  on_display_loss([this] {
    print_error(
        after_loss({ErrorCode::device_lost, "the connection to the display was lost", VK_ERROR_SURFACE_LOST_KHR}));
  });
  TYNDALL_TRY(devices_.open_scene_device({desc_.device, desc_.validation, desc_.script == "one-device"}));
  pipelines_ = std::make_unique<tables::PipelineStore>(devices_.scene(), desc_.make_tables.cache);
  devices_.scene().set_replace_shader(&ShaderReload::replace, &shaders_);
  if (devices_.slow()) {
    gui_.state.resolution_scale = kSlowScale;
    gui_.state.coarseness = kSlowCoarseness;
  }
  settings_.synchronise(true);
  flight_.take_camera(settings_.left);
  pair_.start(devices_.scene(), devices_.are_one(), desc_.make_tables, pair_request());
  TYNDALL_TRY(devices_.open_window_device());

  ImGui::CreateContext();
  window_.start_gui();
  gui_.start();
  gui_.state.first_run = desc_.first_steps && viewer::first_run(settings_.state_file);
  gui_.state.vsync = true;
  TYNDALL_TRY(swapchain_.create(devices_.window(), window_, true));
  TYNDALL_TRY(pair_.create_pictures(devices_.window(), swapchain_.format()));
  notices_.log("started " + devices_.scene().device_name());
  return {};
}

Result<void> Viewer::loop() {
  while (!window_.closing()) {
    if (window_.minimised() != minimised_) {
      minimised_ = !minimised_;
      notices_.log(minimised_ ? "minimised" : "restored");
    }
    if (window_is_gone()) {
      return Error{ErrorCode::device_lost, "another program destroyed the window", VK_ERROR_SURFACE_LOST_KHR};
    }
    if (minimised_) {
      window_.wait(0.5);
      TYNDALL_TRY(take_results());
      continue;
    }
    pair_.request(pair_request());
    const double wait = redraw_.wait_time(loop_state());
    if (wait < 0.0) notices_.log("resting");
    window_.wait(wait);
    const Clock::time_point begin = Clock::now();
    if (window_.take_activity()) {
      redraw_.note_input(now());
      pair_.note_input();
    }
    TYNDALL_TRY(step());
    const double took_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    if (steps_.add(took_ms)) notices_.log("longest_step " + std::to_string(took_ms));
  }
  notices_.log("steps " + steps_.text());
  notices_.log("leaving after " + std::to_string(pair_.frames()) + " frames");
  return {};
}

Result<void> Viewer::step() {
  finish_screenshot();
  if (Result<void> reloaded = finish_reload(); !reloaded) notices_.report(reloaded.error());
  TYNDALL_TRY(take_results());
  const double before = std::exchange(last_step_, now());
  const double elapsed = std::min(last_step_ - before, kMaxFlightStep_s);
  ImGui_ImplVulkan_NewFrame();
  window_.begin_gui();
  ImGui::NewFrame();
  handle_events();
  flight_.advance(elapsed, pair_.facts(), settings_.left);
  window_.forget_keys();
  run_script();
  draw_gui();
  if (settings_.left.scene.sun.animate && gui_.state.playing && pair_.facts().can_render) {
    seconds_ += elapsed;
    pair_.request_frames();
  }
  update_scenes();
  if (redraw_.due() && !redraw_.throttled(loop_state())) TYNDALL_TRY(present());
  return {};
}

LoopState Viewer::loop_state() const {
  LoopState state;
  state.now = now();
  state.slow_device = devices_.slow();
  state.moving = flight_.moving() || settings_.left.scene.sun.animate;
  state.background = screenshot_.writing() || shaders_.working();
  state.showing_toasts = gui_.showing_toasts(state.now);
  pair_.describe(state);
  return state;
}

VkExtent2D Viewer::picture_extent() const {
  const VkExtent2D window = window_.size();
  const auto scaled = [this](std::uint32_t side) {
    return std::clamp(static_cast<std::uint32_t>(std::lround(static_cast<double>(side) * gui_.state.resolution_scale)),
                      16U, 8192U);
  };
  return {scaled(window.width), scaled(window.height)};
}

PairRequest Viewer::pair_request() const {
  PairRequest out;
  out.settings = {settings_.left, settings_.right};
  out.compare = gui_.state.picture.compare;
  out.extent = picture_extent();
  out.coarseness = gui_.state.coarseness;
  out.view = view_of(gui_.state.picture, window_.size());
  out.seconds = seconds_;
  out.resting = redraw_.resting(now());
  out.capture = screenshot_.wants_capture();
  out.camera = flight_.camera();
  return out;
}

// Requests pictures with the current settings, and starts the work of the scenes.
void Viewer::update_scenes() {
  settings_.synchronise(gui_.state.picture.compare);
  pair_.request(pair_request());
  pair_.update();
}

Result<void> Viewer::take_results() {
  TYNDALL_ASSIGN(PairResult result, pair_.take_results());
  if (result.replacement_error) {
    shaders_.revert();
    shader_message_ = result.replacement_error->message;
    notices_.log("shaders failed " + shader_message_);
    if (device_lost(*result.replacement_error)) return *result.replacement_error;
    notices_.report(*result.replacement_error);
  }
  if (result.replaced) {
    shader_message_.clear();
    notices_.note("The shaders have been rebuilt");
    notices_.log("shaders rebuilt");
  }
  if (result.right_ended) gui_.state.picture.compare = false;
  settings_.take_back(result);
  if (result.capture) screenshot_.write(std::move(*result.capture), desc_.screenshots);
  return {};
}

void Viewer::handle_events() {
  for (const Event& event : window_.take_events()) {
    if (event.kind != Event::Kind::key) {
      flight_.handle_pointer(event, settings_.left);
    } else if (!ImGui::GetIO().WantTextInput || event.key == GLFW_KEY_ESCAPE) {
      handle_key(event.key);
    }
  }
}

void Viewer::run_script() {
  if (script_.done()) window_.close();
  if (!script_.on()) return;
  pair_.request(pair_request());
  if (!pair_.settled()) return;
  notices_.log("script " + script_.advance(settings_.left, gui_.state, now(), pair_.frames()));
  redraw_.request(1);
  if (now() - last_memory_log_ < kMemoryLogPeriod_s) return;
  last_memory_log_ = now();
  const scene::Scene::Memory& memory = pair_.facts().memory;
  notices_.log("memory " + std::to_string(resident_kib()) + " " +
               std::to_string(memory.effect_persistent + memory.effect_transient + memory.effect_host + memory.scene) +
               " " + std::to_string(allocated_kib()));
}

GuiFacts Viewer::gui_facts() const {
  GuiFacts facts;
  facts.scene = &pair_.facts();
  facts.times = &pair_.times();
  facts.device = devices_.scene().device_name();
  facts.state_file = settings_.state_file;
  facts.present_mode = swapchain_.present_mode();
  facts.window = window_.size();
  facts.picture = picture_extent();
  facts.creating = pair_.creating();
  facts.tables = pair_.tables();
  facts.shader_message = shader_message_;
  facts.flight.altitude_m = scene::altitude_of(flight_.camera().position, settings_.left.effect.planet.radius_m);
  facts.flight.speed_m_s = flight_.speed_m_s();
  facts.flight.has_path = !settings_.left.path.empty();
  facts.flight.path_playing = flight_.path_playing();
  facts.flight.path_s = flight_.path_s();
  facts.flight.path_end_s = settings_.left.path.duration_s();
  facts.now = now();
  return facts;
}

void Viewer::draw_gui() {
  gui_.state.full_screen = window_.full_screen();
  const bool first_run_before = gui_.state.first_run;
  GuiRequests requests;
  const ViewSettings before = settings_;
  gui_.draw(settings_.left, settings_.right, gui_facts(), requests);
  log_changes(before.left, settings_.left, "set ");
  log_changes(before.right, settings_.right, "set right ");
  if (first_run_before && !gui_.state.first_run) leave_first_run_mark(settings_.state_file);
  ImGui::Render();
  notices_.events().places(gui_.widgets.places());
  // Logged after the places, so that the log shows which of them the pointer was at.
  if (const std::string text = flight_.take_pointer_text(); !text.empty()) notices_.log(text);
  if (gui_.state.full_screen != window_.full_screen()) window_.set_full_screen(gui_.state.full_screen);
  swapchain_.set_vsync(gui_.state.vsync);
  handle_requests(requests);
}

// Logs the parameters that widgets have changed.
void Viewer::log_changes(const config::Settings& before, const config::Settings& after, const char* what) {
  if (!notices_.events().on()) return;
  for (const config::Row& row : config::rows()) {
    if (!same_value(row, before, after)) notices_.log(what + row.key() + "=" + config::value_text(row, after));
  }
}

Result<void> Viewer::present() {
  const PictureOptions& options = gui_.state.picture;
  TYNDALL_ASSIGN(const Drawn drawn, swapchain_.draw([&](VkCommandBuffer cmd, VkExtent2D window) -> Result<void> {
    return pair_.record(cmd, window, options);
  }));
  redraw_.note_drawn(now());
  const bool has_picture = pair_.frames() > 0;
  if (desc_.script == "lose-device" && has_picture) {
    return Error{ErrorCode::device_lost, "simulated by --script", VK_ERROR_DEVICE_LOST};
  }
  if (drawn == Drawn::surface_lost || (desc_.script == "lose-surface" && has_picture)) {
    if (desc_.script == "lose-surface") desc_.script.clear();
    notices_.log("surface lost");
    TYNDALL_TRY(swapchain_.recover());
    redraw_.request(3);
  }
  if (drawn == Drawn::not_now) redraw_.request(2);
  if (drawn != Drawn::done) return {};
  const bool two = options.compare && pair_.has_right_picture();
  present_log_.add({pair_.frames(), swapchain_.extent(), two, swapchain_.present_mode()}, notices_);
  return {};
}

void Viewer::handle_key(int key) {
  GuiRequests requests;
  switch (key) {
    case GLFW_KEY_F1: gui_.state.help = !gui_.state.help; break;
    case GLFW_KEY_F2: gui_.state.hidden = !gui_.state.hidden; break;
    case GLFW_KEY_F5: requests.save = true; break;
    case GLFW_KEY_F8: requests.reload_shaders = true; break;
    case GLFW_KEY_F9: requests.restore = true; break;
    case GLFW_KEY_P: requests.play = true; break;
    case GLFW_KEY_F11: window_.set_full_screen(!window_.full_screen()); break;
    case GLFW_KEY_F12: requests.screenshot = true; break;
    case GLFW_KEY_ESCAPE: requests.quit = true; break;
    default: return;
  }
  notices_.log("key " + std::to_string(key));
  handle_requests(requests);
}

void Viewer::handle_requests(const GuiRequests& requests) {
  if (requests.save) save_state();
  if (requests.play) flight_.toggle_path(settings_.left);
  if (requests.restore) load_file(settings_.state_file, true);
  if (requests.screenshot) screenshot_.request();
  if (requests.reload_shaders) start_reload();
  if (!requests.scene.empty()) load_file(requests.scene, true);
  if (!requests.preset.empty()) load_file(requests.preset, false);
  if (requests.copy_to_right) settings_.copy_to_right(!pair_.has_right());
  if (requests.quit) window_.close();
}

void Viewer::save_state() {
  if (Result<void> saved = settings_.save(); !saved) return notices_.report(saved.error());
  notices_.note("The state has been saved in " + settings_.state_file);
  notices_.log("saved " + settings_.state_file);
}

void Viewer::load_file(const std::string& path, bool over_defaults) {
  if (Result<void> loaded = settings_.load(path, over_defaults); !loaded) return notices_.report(loaded.error());
  seconds_ = 0.0;
  flight_.reset_path();
  if (!settings_.left.path.empty()) notices_.note("This scene has a camera flight. P plays it");
  notices_.note("Loaded " + path);
  notices_.log("loaded " + path);
}

void Viewer::finish_screenshot() {
  const std::optional<Result<std::string>> stem = screenshot_.take_written();
  if (!stem) return;
  if (!*stem) return notices_.report(stem->error());
  notices_.note("Saved " + stem->value() + (image::exr_supported() ? ".png and .exr" : ".png"));
  notices_.log("screenshot " + stem->value());
}

void Viewer::start_reload() {
  if (shaders_.working()) return;
  if (Result<void> started = shaders_.start(); !started) return notices_.report(started.error());
  notices_.note("Rebuilding the shaders ...");
}

// New shaders need new pipelines, so a new scene is created. It replaces the left one when it has been drawn.
Result<void> Viewer::finish_reload() {
  TYNDALL_ASSIGN(const ShaderReload::Rebuilt rebuilt, shaders_.finish());
  if (!rebuilt.finished) return {};
  shader_message_ = rebuilt.message;
  if (!rebuilt.message.empty()) {
    gui_.toast("The shaders have not been replaced:\n" + rebuilt.message, true, now());
    notices_.log("shaders failed " + files::one_line(rebuilt.message, 400));
    redraw_.request(3);
    return {};
  }
  if (rebuilt.changed == 0 && rebuilt.restored == 0) {
    notices_.note("The sources of the shaders have not changed");
    notices_.log("shaders same");
    return {};
  }
  // The cached tables do not match the changed shaders.
  desc_.make_tables.rebuild = rebuilt.tables_differ;
  desc_.make_tables.cache.place = rebuilt.tables_differ ? "off" : cache_place_;
  pair_.request(pair_request());
  pair_.start_replacement(desc_.make_tables);
  return {};
}

Error Viewer::after_loss(const Error& error) {
  const bool surface = error.vk_result == VK_ERROR_SURFACE_LOST_KHR;
  notices_.log("failed " + error.message);
  if (!surface && !device_lost(error)) return error;
  const std::string what = surface ? "the window's surface was lost" : "the Vulkan device was lost";
  const std::string state = settings_.save()
                                ? "the state is saved; 'tyndall view " + settings_.state_file + "' continues from there"
                                : "the state could not be saved in '" + settings_.state_file + "'";
  return Error{ErrorCode::device_lost, "tyndall view: " + what + " (" + error.message + "); " + state, error.vk_result};
}

}  // namespace tyndall::viewer
