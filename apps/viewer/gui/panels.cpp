// The panels of controls: basic, additional and tone mapping as the demo of Yusov (2013) arranges them, the
// atmosphere, and everything. What a control is comes from the table; here stands only which, and when it counts.
#include <imgui.h>

#include <algorithm>

#include "viewer/gui/gui.hpp"

namespace tyndall::viewer {
namespace {

// Full brightness of the colours of the coefficients, as in the demo of Yusov (2013) and what came after.
constexpr float kScatteringScale = 5.0e-5F;  // 1/m
constexpr float kOzoneScale = 5.0e-6F;

// Greys out what has no effect with the other settings.
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

}  // namespace

void Gui::edit(config::Settings& settings, std::initializer_list<const char*> keys) {
  for (const char* key : keys) widgets.edit(key, settings);
}

void Gui::controls(config::Settings& settings, GuiRequests&) {
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
      using Panel = void (Gui::*)(config::Settings&);
      const struct {
        const char* name;
        Panel panel;
      } tabs[] = {{"Basic", &Gui::basic},
                  {"Additional", &Gui::additional},
                  {"Tone mapping", &Gui::tone_mapping},
                  {"Atmosphere", &Gui::atmosphere},
                  {"All", &Gui::everything}};
      const int wanted = state.tab;
      state.tab = -1;
      for (int i = 0; i < 5; ++i) {
        const bool open = ImGui::BeginTabItem(tabs[i].name, nullptr, wanted == i ? ImGuiTabItemFlags_SetSelected : 0);
        widgets.place(std::string("tab.") + tabs[i].name);
        if (!open) continue;
        if (ImGui::BeginChild(tabs[i].name)) (this->*tabs[i].panel)(settings);
        ImGui::EndChild();
        ImGui::EndTabItem();
      }
      ImGui::EndTabBar();
    }
  }
  ImGui::End();
}

void Gui::basic(config::Settings& s) {
  edit(s, {"atmosphere.aerosol_density", "sun.elevation_deg", "sun.azimuth_deg", "sun.animate"});
  ImGui::Separator();
  if (ImGui::Button(state.full_screen ? "Window" : "Full screen")) state.full_screen = !state.full_screen;
  widgets.place("button.full_screen");
  ImGui::SameLine();
  ImGui::Checkbox("VSync", &state.vsync);
  widgets.place("button.vsync");
  edit(s, {"scattering.enabled"});
  {
    const Enabled on(s.effect.scattering.enabled);
    edit(s, {"scattering.light_shafts", "scattering.technique"});
  }
  edit(s, {"shadows.resolution"});
  {
    const ScatteringParams& p = s.effect.scattering;
    const Enabled on(p.enabled && p.single == SingleScattering::integration && !p.light_shafts);
    edit(s, {"scattering.integration_steps"});
  }
  {
    const Enabled on(epipolar(s));
    edit(s, {"epipolar.slices", "epipolar.samples", "epipolar.initial_step", "epipolar.epipole_density",
             "epipolar.refinement_threshold"});
  }
  edit(s, {"scattering.scale"});
  {
    const Enabled on(epipolar(s));
    edit(s, {"epipolar.show_sampling", "epipolar.min_max_tree", "epipolar.optimize_locations",
             "epipolar.correct_depth_breaks", "epipolar.show_depth_breaks"});
  }
  edit(s, {"scattering.only"});
}

void Gui::additional(config::Settings& s) {
  edit(s,
       {"scattering.single", "scattering.multiple", "scattering.sections", "shadows.cascades", "shadows.show_cascades",
        "shadows.smooth", "shadows.best_cascade", "shadows.partitioning", "shadows.distance_m"});
  {
    const Enabled on(epipolar(s));
    edit(s, {"shadows.cascade_processing"});
  }
  edit(s, {"shadows.first_marched"});
  {
    const Enabled on(epipolar(s));
    edit(s, {"scattering.extinction", "epipolar.refinement", "epipolar.min_max_format"});
  }
  ImGui::Separator();
  edit(s, {"atmosphere.custom_coefficients"});
  {
    const Enabled on(s.effect.atmosphere.custom_coefficients);
    widgets.edit_color("atmosphere.rayleigh_scattering", s, kScatteringScale);
    widgets.edit_color("atmosphere.mie_scattering", s, kScatteringScale);
  }
  edit(s, {"atmosphere.aerosol_density", "atmosphere.aerosol_absorption"});
  ImGui::Separator();
  edit(s, {"sun.animate", "sun.animate_speed_deg", "sun.irradiance", "sun.angular_radius_deg"});
  edit(s, {"terrain.shading", "terrain.exaggeration", "terrain.seed", "scattering.model", "scattering.evaluate"});
}

void Gui::tone_mapping(config::Settings& s) {
  for (const config::Row& row : config::rows()) {
    if (row.info.group == "tonemap") widgets.edit(row, s);
  }
}

void Gui::atmosphere(config::Settings& s) {
  ImGui::TextDisabled("Changes build the light of the air anew.");
  for (const config::Row& row : config::rows()) {
    if (row.info.group == "planet") widgets.edit(row, s);
  }
  ImGui::Separator();
  edit(s, {"atmosphere.aerosol_density", "atmosphere.aerosol_absorption", "atmosphere.mie_g", "atmosphere.mie_phase",
           "atmosphere.custom_coefficients"});
  {
    const Enabled on(s.effect.atmosphere.custom_coefficients);
    for (const char* key :
         {"atmosphere.rayleigh_scattering", "atmosphere.mie_scattering", "atmosphere.mie_absorption"}) {
      widgets.edit(key, s);
      widgets.edit_color(key, s, kScatteringScale);
    }
  }
  edit(s, {"atmosphere.ozone_absorption"});
  widgets.edit_color("atmosphere.ozone_absorption", s, kOzoneScale);
  for (const config::Row& row : config::rows()) {
    constexpr std::string_view kAbove[] = {"aerosol_density", "aerosol_absorption",  "mie_g",
                                           "mie_phase",       "custom_coefficients", "rayleigh_scattering",
                                           "mie_scattering",  "mie_absorption",      "ozone_absorption"};
    const bool shown = std::find(std::begin(kAbove), std::end(kAbove), row.info.name) != std::end(kAbove);
    if (row.info.group == "atmosphere" && !shown) widgets.edit(row, s);
  }
  ImGui::Separator();
  edit(s, {"tables.size", "tables.orders", "tables.parameterization"});
}

void Gui::everything(config::Settings& s) {
  widgets.with_group = false;  // the headers have it
  for (const config::Group& group : config::groups()) {
    const std::string name(group.title);
    const bool open = ImGui::CollapsingHeader(name.c_str());
    widgets.place("group." + std::string(group.name));
    if (!open) continue;
    for (const config::Row& row : config::rows()) {
      if (row.info.group == group.name) widgets.edit(row, s);
    }
  }
  widgets.with_group = true;
}

}  // namespace tyndall::viewer
