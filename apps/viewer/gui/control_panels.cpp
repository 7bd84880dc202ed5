#include "viewer/gui/control_panels.hpp"

#include <imgui.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace tyndall::viewer {
namespace {

// The coefficient that a colour control shows at full brightness, as in the demo of Yusov (2013).
constexpr float kScatteringScale = 5.0e-5F;  // 1/m
constexpr float kOzoneScale = 5.0e-6F;

// Greys out controls that have no effect with the other settings.
class Enabled {
 public:
  explicit Enabled(bool on) : on_(on) {
    if (!on_) ImGui::BeginDisabled();
  }
  Enabled(const Enabled&) = delete;
  Enabled& operator=(const Enabled&) = delete;
  ~Enabled() {
    if (!on_) ImGui::EndDisabled();
  }

 private:
  bool on_;
};

bool epipolar(const config::Settings& s) {
  return s.effect.scattering.enabled && s.effect.scattering.technique == Technique::epipolar;
}

// The panels of the controls, one function each. The first three are arranged as in the demo of Yusov (2013).
struct Panels {
  GuiState& state;
  Widgets& widgets;
  config::Settings& settings;

  void basic();
  void additional();
  void tone_mapping();
  void atmosphere();
  void everything();

 private:
  [[nodiscard]] bool has_effect(std::string_view key) const;
  void edit(std::initializer_list<const char*> keys);
  void edit_group(std::string_view group);
};

void Panels::edit(std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const Enabled on(has_effect(key));
    widgets.edit(key, settings);
  }
}

// Returns whether a parameter has an effect. The sun's angles have none if sun.time is set.
bool Panels::has_effect(std::string_view key) const {
  return settings.scene.sun.time.empty() || (key != "sun.elevation_deg" && key != "sun.azimuth_deg");
}

void Panels::edit_group(std::string_view group) {
  for (const config::Row& row : config::rows()) {
    if (row.info.group != group) continue;
    const Enabled on(has_effect(row.key()));
    widgets.edit(row, settings);
  }
}

void Panels::basic() {
  edit({"atmosphere.aerosol_density", "sun.elevation_deg", "sun.azimuth_deg", "sun.animate"});
  ImGui::Separator();
  if (ImGui::Button(state.full_screen ? "Window" : "Full screen")) state.full_screen = !state.full_screen;
  widgets.place("button.full_screen");
  ImGui::SameLine();
  ImGui::Checkbox("VSync", &state.vsync);
  widgets.place("button.vsync");
  edit({"scattering.enabled"});
  {
    const Enabled on(settings.effect.scattering.enabled);
    edit({"scattering.light_shafts", "scattering.technique"});
  }
  edit({"shadows.resolution"});
  {
    const ScatteringParams& p = settings.effect.scattering;
    const Enabled on(p.enabled && p.single == SingleScattering::integration && !p.light_shafts);
    edit({"scattering.integration_steps"});
  }
  {
    const Enabled on(epipolar(settings));
    edit({"epipolar.slices", "epipolar.samples", "epipolar.initial_step", "epipolar.epipole_density",
          "epipolar.refinement_threshold"});
  }
  edit({"scattering.scale"});
  {
    const Enabled on(epipolar(settings));
    edit({"epipolar.show_sampling", "epipolar.min_max_tree", "epipolar.optimize_locations",
          "epipolar.correct_depth_breaks", "epipolar.show_depth_breaks"});
  }
  edit({"scattering.only"});
}

void Panels::additional() {
  edit({"scattering.single", "scattering.multiple", "scattering.sections", "shadows.cascades", "shadows.show_cascades",
        "shadows.smooth", "shadows.best_cascade", "shadows.partitioning", "shadows.distance_m"});
  {
    const Enabled on(epipolar(settings));
    edit({"shadows.cascade_processing"});
  }
  edit({"shadows.first_marched"});
  {
    const Enabled on(epipolar(settings));
    edit({"scattering.extinction", "epipolar.refinement", "epipolar.min_max_format"});
  }
  ImGui::Separator();
  edit({"atmosphere.custom_coefficients"});
  {
    const Enabled on(settings.effect.atmosphere.custom_coefficients);
    widgets.edit_color("atmosphere.rayleigh_scattering", settings, kScatteringScale);
    widgets.edit_color("atmosphere.mie_scattering", settings, kScatteringScale);
  }
  edit({"atmosphere.aerosol_density", "atmosphere.aerosol_absorption"});
  ImGui::Separator();
  edit({"sun.animate", "sun.animate_speed_deg", "sun.irradiance", "sun.angular_radius_deg"});
  edit({"terrain.shading", "terrain.exaggeration", "terrain.seed", "scattering.model", "scattering.evaluate"});
}

void Panels::tone_mapping() { edit_group("tonemap"); }

void Panels::atmosphere() {
  ImGui::TextDisabled("Changes rebuild the scattering tables.");
  edit_group("planet");
  ImGui::Separator();
  edit({"atmosphere.aerosol_density", "atmosphere.aerosol_absorption", "atmosphere.mie_g", "atmosphere.mie_phase",
        "atmosphere.custom_coefficients"});
  {
    const Enabled on(settings.effect.atmosphere.custom_coefficients);
    for (const char* key :
         {"atmosphere.rayleigh_scattering", "atmosphere.mie_scattering", "atmosphere.mie_absorption"}) {
      widgets.edit(key, settings);
      widgets.edit_color(key, settings, kScatteringScale);
    }
  }
  edit({"atmosphere.ozone_absorption"});
  widgets.edit_color("atmosphere.ozone_absorption", settings, kOzoneScale);
  for (const config::Row& row : config::rows()) {
    constexpr std::string_view kAbove[] = {"aerosol_density", "aerosol_absorption",  "mie_g",
                                           "mie_phase",       "custom_coefficients", "rayleigh_scattering",
                                           "mie_scattering",  "mie_absorption",      "ozone_absorption"};
    const bool shown = std::find(std::begin(kAbove), std::end(kAbove), row.info.name) != std::end(kAbove);
    if (row.info.group == "atmosphere" && !shown) widgets.edit(row, settings);
  }
  ImGui::Separator();
  edit({"tables.size", "tables.orders", "tables.parameterization"});
}

void Panels::everything() {
  widgets.with_group = false;  // the headers already name the groups
  for (const config::Group& group : config::groups()) {
    const std::string name(group.title);
    const bool open = ImGui::CollapsingHeader(name.c_str());
    widgets.place("group." + std::string(group.name));
    if (!open) continue;
    edit_group(group.name);
  }
  widgets.with_group = true;
}

}  // namespace

void draw_controls(GuiState& state, Widgets& widgets, config::Settings& settings) {
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  const float width = std::min(360.0F, 0.5F * viewport->WorkSize.x);
  const float top = ImGui::GetFrameHeight();  // below the menu
  ImGui::SetNextWindowPos(ImVec2(0.0F, top), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(width, viewport->Size.y - top), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(120.0F, 60.0F), ImVec2(viewport->WorkSize.x, viewport->WorkSize.y));
  if (ImGui::Begin("Controls", &state.controls, ImGuiWindowFlags_NoSavedSettings)) {
    if (state.picture.compare) {
      int side = state.edit_right ? 1 : 0;
      ImGui::RadioButton("Left side", &side, 0);
      widgets.place("side.left");
      ImGui::SameLine();
      ImGui::RadioButton("Right side", &side, 1);
      widgets.place("side.right");
      state.edit_right = side == 1;
    }
    if (ImGui::BeginTabBar("panels")) {
      const struct {
        const char* name;
        void (Panels::*draw)();
      } tabs[] = {{"Basic", &Panels::basic},
                  {"Additional", &Panels::additional},
                  {"Tone mapping", &Panels::tone_mapping},
                  {"Atmosphere", &Panels::atmosphere},
                  {"All", &Panels::everything}};
      Panels panels = {state, widgets, settings};
      const int wanted = state.tab;
      state.tab = -1;
      for (int i = 0; i < 5; ++i) {
        const bool open = ImGui::BeginTabItem(tabs[i].name, nullptr, wanted == i ? ImGuiTabItemFlags_SetSelected : 0);
        widgets.place(std::string("tab.") + tabs[i].name);
        if (!open) continue;
        if (ImGui::BeginChild(tabs[i].name)) (panels.*tabs[i].draw)();
        ImGui::EndChild();
        ImGui::EndTabItem();
      }
      ImGui::EndTabBar();
    }
  }
  ImGui::End();
}

}  // namespace tyndall::viewer
