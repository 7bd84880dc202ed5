#include "viewer/gui/gui.hpp"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "scene/description/model_registry.hpp"
#include "viewer/gui/control_panels.hpp"
#include "viewer/gui/status_panels.hpp"

namespace tyndall::viewer {
namespace {

constexpr double kToast_s = 4.0;
constexpr double kBadToast_s = 12.0;
constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

struct HelpLine {
  const char* input;
  const char* effect;
};
constexpr HelpLine kHelp[] = {
    {"W A S D", "fly forward, left, back, right"},
    {"E, Q", "fly up and down"},
    {"Shift", "fly faster; the speed grows with the height above the ground"},
    {"Left drag", "look around"},
    {"Right drag", "turn the sun"},
    {"Wheel", "change the field of view"},
    {"P", "play or stop the camera flight of the scene file"},
    {"F1", "show or hide this help"},
    {"F2", "hide or show the panels"},
    {"F5, F9", "save and restore the whole state"},
    {"F8", "rebuild the shaders whose sources have changed"},
    {"F11", "switch to full screen and back"},
    {"F12", "save a screenshot as PNG and EXR"},
    {"Esc", "quit"},
};

constexpr HelpLine kFirstSteps[] = {
    {"W A S D, and E and Q for up and down. Shift is faster. Drag with the left button to look around.", "Move"},
    {"Drag with the right button.", "Turn the sun"},
    {"Move the slider \"Aerosol density\" at the top of the controls.", "More haze"},
    {"F1 shows a list.", "All keys"},
};

void help_table() {
  if (!ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) return;
  for (const HelpLine& line : kHelp) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.35F, 1.0F), "%s", line.input);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(line.effect);
  }
  ImGui::EndTable();
}

void centre_next(const GuiFacts& facts) {
  const ImVec2 middle(0.5F * static_cast<float>(facts.window.width), 0.5F * static_cast<float>(facts.window.height));
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, ImVec2(0.5F, 0.5F));
}

}  // namespace

void Gui::start() {
  scenes_ = shipped_scenes("scenes");
  for (SceneFile scene : shipped_scenes("scenes/oneil")) {
    scene.name.insert(0, "oneil/");
    scenes_.push_back(std::move(scene));
  }
  presets_ = shipped_scenes("scenes/presets");
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4.0F;
  style.FrameRounding = 3.0F;
  style.FramePadding = ImVec2(4.0F, 2.0F);
  style.ItemSpacing = ImVec2(6.0F, 3.0F);
  style.Colors[ImGuiCol_WindowBg].w = 0.86F;
  ImGui::GetIO().IniFilename = nullptr;  // do not write imgui.ini
}

void Gui::toast(std::string text, bool bad, double now) {
  // If the message is already visible, only its time is extended.
  std::erase_if(toasts_, [&](const Toast& t) { return t.text == text; });
  if (toasts_.size() > 5) toasts_.erase(toasts_.begin());
  toasts_.push_back({std::move(text), now + (bad ? kBadToast_s : kToast_s), bad});
}

void Gui::draw(config::Settings& left, config::Settings& right, const GuiFacts& facts, GuiRequests& requests) {
  widgets.begin_frame();
  if (!state.hidden) {
    config::Settings& side = state.picture.compare && state.edit_right ? right : left;
    menu(side, facts, requests);
    if (state.controls) draw_controls(state, widgets, side);
    if (state.performance) draw_performance(state, widgets, facts);
    if (state.views) draw_views(state, widgets, facts, requests);
    status(facts);
  }
  if (state.picture.compare) divider(facts);
  if (state.help) help(facts);
  if (state.first_run && !state.help) first_run(facts);
  toasts(facts);
}

bool Gui::begin_menu(const char* name) {
  const bool open = ImGui::BeginMenu(name);
  widgets.place(std::string("menu.") + name);
  return open;
}

bool Gui::item(const char* name, const char* key, bool* on) {
  const bool chosen = on != nullptr ? ImGui::MenuItem(name, key, on) : ImGui::MenuItem(name, key);
  widgets.place(std::string("item.") + name);
  return chosen;
}

void Gui::menu(config::Settings& settings, const GuiFacts& facts, GuiRequests& requests) {
  if (!ImGui::BeginMainMenuBar()) return;
  file_menu(facts, requests);
  scene_menus(requests);
  model_menu(settings);
  if (begin_menu("Windows")) {
    item("Controls", nullptr, &state.controls);
    item("Performance", nullptr, &state.performance);
    item("Views and comparison", nullptr, &state.views);
    item("Full screen", "F11", &state.full_screen);
    ImGui::EndMenu();
  }
  if (begin_menu("Help")) {
    item("Keys and mouse", "F1", &state.help);
    item("First steps", nullptr, &state.first_run);
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

void Gui::file_menu(const GuiFacts& facts, GuiRequests& requests) {
  if (!begin_menu("File")) return;
  requests.save = item("Save the state", "F5") || requests.save;
  requests.restore = item("Restore the state", "F9") || requests.restore;
  requests.screenshot = item("Screenshot", "F12") || requests.screenshot;
  if (facts.flight.has_path) {
    requests.play =
        item(facts.flight.path_playing ? "Stop the camera flight" : "Play the camera flight", "P") || requests.play;
  }
  requests.reload_shaders = item("Rebuild the shaders", "F8") || requests.reload_shaders;
  ImGui::Separator();
  requests.quit = item("Quit", "Esc") || requests.quit;
  ImGui::EndMenu();
}

void Gui::scene_menus(GuiRequests& requests) {
  const auto list = [this](const std::vector<SceneFile>& files, const char* none, std::string& chosen) {
    for (const SceneFile& file : files) {
      if (item(file.name.c_str(), nullptr)) chosen = file.path;
    }
    if (files.empty()) ImGui::TextDisabled("%s", none);
    ImGui::EndMenu();
  };
  if (begin_menu("Scenes"))
    list(scenes_, "no scenes found; set $TYNDALL_DATA to the folder that contains scenes", requests.scene);
  if (begin_menu("Presets"))
    list(presets_, "no presets found; set $TYNDALL_DATA to the folder that contains scenes", requests.preset);
}

void Gui::model_menu(config::Settings& settings) {
  if (!begin_menu("Model")) return;
  scene::SceneParams& scene = settings.scene;
  const scene::ModelInfo& current = scene::drawn_model(settings.effect, scene);
  for (const scene::ModelInfo& model : scene::model_registry()) {
    bool chosen = model.id == current.id;
    if (!model.drawn_by || !item(model.title, nullptr, &chosen)) continue;
    scene.scattering.model = model.drawn_by->model;
    if (model.drawn_by->model == scene::ScatteringModel::atmosphere) {
      settings.effect.scattering.medium = model.drawn_by->medium;
    }
  }
  ImGui::Separator();
  bool pixel = scene.scattering.evaluate == scene::ModelEvaluation::pixel;
  ImGui::BeginDisabled(scene.scattering.model == scene::ScatteringModel::atmosphere);
  if (item("For every pixel", nullptr, &pixel)) {
    scene.scattering.evaluate = pixel ? scene::ModelEvaluation::pixel : scene::ModelEvaluation::vertex;
  }
  ImGui::EndDisabled();
  if (state.picture.compare) ImGui::TextDisabled(state.edit_right ? "of the right side" : "of the left side");
  ImGui::EndMenu();
}

void Gui::divider(const GuiFacts& facts) {
  const float width = static_cast<float>(facts.window.width);
  ImGui::SetNextWindowPos(ImVec2(state.picture.divider * width, static_cast<float>(facts.window.height) - 26.0F),
                          ImGuiCond_Always, ImVec2(0.5F, 0.5F));
  if (ImGui::Begin("divider", nullptr, kOverlay)) {
    ImGui::Button("< drag >");
    widgets.place("divider");
    if (ImGui::IsItemActive()) {
      state.picture.divider = std::clamp(ImGui::GetIO().MousePos.x / std::max(width, 1.0F), 0.02F, 0.98F);
    }
  }
  ImGui::End();
}

void Gui::status(const GuiFacts& facts) {
  // Placed beside the controls, because the other windows are at the right edge.
  const float width = static_cast<float>(facts.window.width);
  const float left = state.controls ? std::min(360.0F, 0.5F * width) : 0.0F;
  ImGui::SetNextWindowPos(ImVec2(left + 6.0F, static_cast<float>(facts.window.height) - 6.0F), ImGuiCond_Always,
                          ImVec2(0.0F, 1.0F));
  ImGui::SetNextWindowBgAlpha(0.55F);
  if (ImGui::Begin("status", nullptr, kOverlay | ImGuiWindowFlags_NoInputs)) {
    if (facts.creating) ImGui::TextUnformatted("Creating the scene ...");
    if (!facts.tables.complete()) {
      ImGui::Text("Scattering tables: %u of %u", facts.tables.done, facts.tables.total);
      ImGui::ProgressBar(static_cast<float>(facts.tables.done) / static_cast<float>(std::max(facts.tables.total, 1U)),
                         ImVec2(180.0F, 6.0F), "");
    }
    const FlightFacts& flight = facts.flight;
    if (flight.path_playing) ImGui::Text("Camera flight: %.1f s of %.1f s", flight.path_s, flight.path_end_s);
    const bool far = flight.altitude_m >= 10000.0;
    const double unit = far ? 1000.0 : 1.0;
    ImGui::Text(far ? "Altitude %.1f km, speed %.1f km/s" : "Altitude %.0f m, speed %.0f m/s", flight.altitude_m / unit,
                flight.speed_m_s / unit);
  }
  ImGui::End();
}

void Gui::help(const GuiFacts& facts) {
  centre_next(facts);
  ImGui::SetNextWindowBgAlpha(0.92F);
  if (ImGui::Begin(
          "Keys and mouse", &state.help,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    help_table();
    ImGui::Separator();
    ImGui::TextUnformatted(
        "Hold the pointer over a control to see its description. Ctrl and click lets you type a value.");
    ImGui::Text("F5 saves the state in %s", facts.state_file.c_str());
  }
  ImGui::End();
}

void Gui::first_run(const GuiFacts& facts) {
  // Centred in the area that the controls leave free.
  const float width = static_cast<float>(facts.window.width);
  const float taken = state.controls && !state.hidden ? std::min(360.0F, 0.5F * width) : 0.0F;
  ImGui::SetNextWindowPos(ImVec2(0.5F * (taken + width), 0.5F * static_cast<float>(facts.window.height)),
                          ImGuiCond_Always, ImVec2(0.5F, 0.5F));
  ImGui::SetNextWindowBgAlpha(0.9F);
  if (ImGui::Begin("first steps", nullptr, kOverlay)) {
    ImGui::PushTextWrapPos(std::clamp(0.95F * (width - taken), 220.0F, 520.0F));
    for (const HelpLine& line : kFirstSteps) {
      ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.35F, 1.0F), "%s:", line.effect);
      ImGui::SameLine(110.0F);
      ImGui::TextUnformatted(line.input);
      widgets.place(std::string("first_run.") + line.effect);
    }
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (ImGui::Button("Start")) state.first_run = false;
    widgets.place("first_run.close");
  }
  ImGui::End();
}

void Gui::toasts(const GuiFacts& facts) {
  std::erase_if(toasts_, [&](const Toast& t) { return t.until <= facts.now; });
  if (toasts_.empty()) return;
  ImGui::SetNextWindowPos(ImVec2(0.5F * static_cast<float>(facts.window.width), 30.0F), ImGuiCond_Always,
                          ImVec2(0.5F, 0.0F));
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (ImGui::Begin("messages", nullptr, kOverlay | ImGuiWindowFlags_NoInputs)) {
    ImGui::PushTextWrapPos(0.8F * static_cast<float>(facts.window.width));
    for (const Toast& toast : toasts_) {
      const ImVec4 color = toast.bad ? ImVec4(1.0F, 0.45F, 0.35F, 1.0F) : ImVec4(0.85F, 0.95F, 0.85F, 1.0F);
      ImGui::PushStyleColor(ImGuiCol_Text, color);
      ImGui::TextUnformatted(toast.text.c_str());
      ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace tyndall::viewer
