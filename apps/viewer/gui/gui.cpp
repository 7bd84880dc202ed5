// The frame of the GUI: menu, windows, overlays.
#include "viewer/gui/gui.hpp"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace tyndall::viewer {
namespace {

constexpr double kToast_s = 4.0;
constexpr double kBadToast_s = 12.0;
constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

struct HelpLine {
  const char* hands;
  const char* what;
};
constexpr HelpLine kHelp[] = {
    {"W A S D", "fly forward, left, back, right"},
    {"E, Q", "up, down"},
    {"Shift", "faster; speed grows with the height above the ground"},
    {"Left drag", "look around"},
    {"Right drag", "turn the sun"},
    {"Wheel", "field of view"},
    {"P", "play the flight of the scene file"},
    {"F1", "this help"},
    {"F2", "hide or show the panels"},
    {"F5, F9", "save and restore the whole state"},
    {"F8", "rebuild the shaders from their sources"},
    {"F11", "full screen"},
    {"F12", "screenshot, PNG and EXR"},
    {"Esc", "leave"},
};

constexpr HelpLine kFirstSteps[] = {
    {"W A S D, and E Q for up and down; Shift is faster. Drag with the left button to look.", "Move"},
    {"drag with the right button.", "Turn the sun"},
    {"the slider \"Aerosol density\", on top of the controls.", "More haze"},
    {"F1.", "All keys"},
};

// The systems of docs/models.md.
struct ModelItem {
  const char* name;
  scene::ScatteringModel model;
  MediumKind medium = MediumKind::atmosphere;
};
constexpr ModelItem kModels[] = {
    {"Atmosphere, all orders, shafts (Yusov 2013)", scene::ScatteringModel::atmosphere},
    {"Homogeneous medium, shafts (Yusov 2012)", scene::ScatteringModel::atmosphere, MediumKind::homogeneous},
    {"Air and haze (Hoffman, Preetham 2002)", scene::ScatteringModel::homogeneous},
    {"Scale function (O'Neil 2005)", scene::ScatteringModel::oneil},
    {"Table (O'Neil 2004)", scene::ScatteringModel::oneil_table},
};

void help_table() {
  if (!ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) return;
  for (const HelpLine& line : kHelp) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.35F, 1.0F), "%s", line.hands);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(line.what);
  }
  ImGui::EndTable();
}

void centre_next(const GuiFacts& facts) {
  const ImVec2 middle(0.5F * static_cast<float>(facts.window.width), 0.5F * static_cast<float>(facts.window.height));
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, ImVec2(0.5F, 0.5F));
}

}  // namespace

void FrameTimes::add(const std::vector<scene::PassTime>& times, double whole_ms) {
  double sum = 0.0;
  for (const scene::PassTime& time : times) sum += time.ms;
  gpu[next] = static_cast<float>(sum);
  whole[next] = static_cast<float>(whole_ms);
  next = (next + 1) % kCount;
  const bool same = passes.size() == times.size() &&
                    std::equal(passes.begin(), passes.end(), times.begin(),
                               [](const scene::PassTime& a, const scene::PassTime& b) { return a.name == b.name; });
  if (!same) {
    passes = times;
    return;
  }
  for (std::size_t i = 0; i < passes.size(); ++i) passes[i].ms += 0.2 * (times[i].ms - passes[i].ms);
}

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
  ImGui::GetIO().IniFilename = nullptr;  // the state is in the scene file
}

void Gui::toast(std::string text, bool bad, double now) {
  // The same again only lasts longer.
  std::erase_if(toasts_, [&](const Toast& t) { return t.text == text; });
  if (toasts_.size() > 5) toasts_.erase(toasts_.begin());
  toasts_.push_back({std::move(text), now + (bad ? kBadToast_s : kToast_s), bad});
}

void Gui::draw(config::Settings& left, config::Settings& right, const GuiFacts& facts, GuiRequests& requests) {
  widgets.begin_frame();
  if (!state.hidden) {
    config::Settings& side = state.picture.compare && state.edit_right ? right : left;
    menu(side, facts, requests);
    if (state.controls) controls(side, requests);
    if (state.performance) performance(facts);
    if (state.views) views(facts, requests);
    status(facts);
  }
  if (state.picture.compare) divider(facts);
  if (state.help) help(facts);
  if (state.first_run && !state.help) first_run(facts);
  toasts(facts);
}

void Gui::menu(config::Settings& settings, const GuiFacts& facts, GuiRequests& requests) {
  if (!ImGui::BeginMainMenuBar()) return;
  const auto begin = [this](const char* name) {
    const bool open = ImGui::BeginMenu(name);
    widgets.place(std::string("menu.") + name);
    return open;
  };
  const auto item = [this](const char* name, const char* key, bool* on = nullptr) {
    const bool chosen = on != nullptr ? ImGui::MenuItem(name, key, on) : ImGui::MenuItem(name, key);
    widgets.place(std::string("item.") + name);
    return chosen;
  };
  if (begin("File")) {
    requests.save = item("Save the state", "F5") || requests.save;
    requests.restore = item("Restore the state", "F9") || requests.restore;
    requests.screenshot = item("Screenshot", "F12") || requests.screenshot;
    if (facts.has_path)
      requests.play = item(facts.flying_path ? "Stop the flight" : "Play the flight", "P") || requests.play;
    requests.reload_shaders = item("Rebuild the shaders", "F8") || requests.reload_shaders;
    ImGui::Separator();
    requests.quit = item("Leave", "Esc") || requests.quit;
    ImGui::EndMenu();
  }
  if (begin("Scenes")) {
    for (const SceneFile& scene : scenes_) {
      if (item(scene.name.c_str(), nullptr)) requests.scene = scene.path;
    }
    if (scenes_.empty()) ImGui::TextDisabled("no scenes found; $TYNDALL_DATA names their place");
    ImGui::EndMenu();
  }
  if (begin("Presets")) {
    for (const SceneFile& preset : presets_) {
      if (item(preset.name.c_str(), nullptr)) requests.preset = preset.path;
    }
    if (presets_.empty()) ImGui::TextDisabled("no presets found; $TYNDALL_DATA names their place");
    ImGui::EndMenu();
  }
  if (begin("Model")) {
    scene::SceneParams& scene = settings.scene;
    MediumKind& medium = settings.effect.scattering.medium;
    for (const ModelItem& model : kModels) {
      bool chosen = scene.scattering.model == model.model &&
                    (model.model != scene::ScatteringModel::atmosphere || medium == model.medium);
      if (!item(model.name, nullptr, &chosen)) continue;
      scene.scattering.model = model.model;
      if (model.model == scene::ScatteringModel::atmosphere) medium = model.medium;
    }
    ImGui::Separator();
    const bool apart = scene.scattering.model != scene::ScatteringModel::atmosphere;
    bool pixel = scene.scattering.evaluate == scene::ModelEvaluation::pixel;
    ImGui::BeginDisabled(!apart);
    if (item("For every pixel", nullptr, &pixel)) {
      scene.scattering.evaluate = pixel ? scene::ModelEvaluation::pixel : scene::ModelEvaluation::vertex;
    }
    ImGui::EndDisabled();
    if (state.picture.compare) ImGui::TextDisabled(state.edit_right ? "of the right side" : "of the left side");
    ImGui::EndMenu();
  }
  if (begin("Windows")) {
    item("Controls", nullptr, &state.controls);
    item("Performance", nullptr, &state.performance);
    item("Views and comparison", nullptr, &state.views);
    item("Full screen", "F11", &state.full_screen);
    ImGui::EndMenu();
  }
  if (begin("Help")) {
    item("Keys and mouse", "F1", &state.help);
    item("First steps", nullptr, &state.first_run);
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
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
  // Beside the controls: the right edge is where the other windows are.
  const float width = static_cast<float>(facts.window.width);
  const float left = state.controls ? std::min(360.0F, 0.5F * width) : 0.0F;
  ImGui::SetNextWindowPos(ImVec2(left + 6.0F, static_cast<float>(facts.window.height) - 6.0F), ImGuiCond_Always,
                          ImVec2(0.0F, 1.0F));
  ImGui::SetNextWindowBgAlpha(0.55F);
  if (ImGui::Begin("status", nullptr, kOverlay | ImGuiWindowFlags_NoInputs)) {
    if (facts.creating) ImGui::TextUnformatted("Making the scene ...");
    if (!facts.tables.complete()) {
      ImGui::Text("Light of this atmosphere: %u of %u", facts.tables.done, facts.tables.total);
      ImGui::ProgressBar(static_cast<float>(facts.tables.done) / static_cast<float>(std::max(facts.tables.total, 1U)),
                         ImVec2(180.0F, 6.0F), "");
    }
    if (facts.flying_path) ImGui::Text("Flight: %.1f s of %.1f s", facts.path_s, facts.path_end_s);
    const bool far = facts.altitude_m >= 10000.0;
    ImGui::Text(far ? "%.1f km up, %.1f km/s" : "%.0f m up, %.0f m/s",
                far ? facts.altitude_m / 1000.0 : facts.altitude_m, far ? facts.speed_m_s / 1000.0 : facts.speed_m_s);
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
    ImGui::TextUnformatted("Hold the pointer over a control to read what it does; Ctrl and click to type a value.");
    ImGui::Text("The state is kept in %s", facts.state_file.c_str());
  }
  ImGui::End();
}

void Gui::first_run(const GuiFacts& facts) {
  // In the middle of what the controls leave free.
  const float width = static_cast<float>(facts.window.width);
  const float taken = state.controls && !state.hidden ? std::min(360.0F, 0.5F * width) : 0.0F;
  ImGui::SetNextWindowPos(ImVec2(0.5F * (taken + width), 0.5F * static_cast<float>(facts.window.height)),
                          ImGuiCond_Always, ImVec2(0.5F, 0.5F));
  ImGui::SetNextWindowBgAlpha(0.9F);
  if (ImGui::Begin("first steps", nullptr, kOverlay)) {
    ImGui::PushTextWrapPos(std::clamp(0.95F * (width - taken), 220.0F, 520.0F));
    for (const HelpLine& line : kFirstSteps) {
      ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.35F, 1.0F), "%s:", line.what);
      ImGui::SameLine(110.0F);
      ImGui::TextUnformatted(line.hands);
      widgets.place(std::string("first_run.") + line.what);
    }
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (ImGui::Button("Let me fly")) state.first_run = false;
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
