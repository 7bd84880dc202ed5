#include "viewer/gui/status_panels.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tyndall::viewer {
namespace {

constexpr float kViewsHeight = 190.0F;  // height of the window "Views and comparison"

void text_bytes(const char* name, VkDeviceSize bytes) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  ImGui::TableNextColumn();
  ImGui::Text("%8.2f MiB", static_cast<double>(bytes) / 1048576.0);
}

// Plots the shares of the picture by luminance in stops, and marks the measured and the adapted luminance.
void histogram(const SceneFacts& scene) {
  const post::Measurement& m = scene.exposure.measurement;
  float largest = 1.0e-4F;
  for (const float share : m.share) largest = std::max(largest, share);
  ImGui::PlotHistogram("##histogram", m.share.data(), static_cast<int>(m.share.size()), 0, nullptr, 0.0F,
                       largest * 1.05F, ImVec2(ImGui::GetContentRegionAvail().x, 60.0F));
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const double first = post::stop_of_bin(0);
  const double last = post::stop_of_bin(post::kHistogramBins - 1);
  const auto mark = [&](float luminance, ImU32 color) {
    if (luminance <= 0.0F) return;
    const double t = (std::log2(static_cast<double>(luminance)) - first) / (last - first);
    if (t < 0.0 || t > 1.0) return;
    const float x = min.x + static_cast<float>(t) * (max.x - min.x);
    ImGui::GetWindowDrawList()->AddLine(ImVec2(x, min.y), ImVec2(x, max.y), color, 1.5F);
  };
  mark(m.measured, IM_COL32(120, 200, 255, 255));
  mark(m.luminance, IM_COL32(255, 200, 90, 255));
  ImGui::TextDisabled("2^%.0f", first);
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 40.0F);
  ImGui::TextDisabled("2^%.0f", last);
  ImGui::Text("Exposure %.4g (%+.2f stops)", static_cast<double>(scene.exposure.scale),
              std::log2(std::max(static_cast<double>(scene.exposure.scale), 1.0e-12)));
  if (scene.exposure.ev100) {
    ImGui::SameLine();
    ImGui::Text("EV100 %.2f", *scene.exposure.ev100);
  }
  if (scene.exposure.illuminance) {
    ImGui::Text("Sun %.4g lx (horizontal %.4g lx), sky %.4g lx", scene.exposure.illuminance->sun_lux,
                scene.exposure.illuminance->sun_horizontal_lux, scene.exposure.illuminance->sky_lux);
  }
  ImGui::TextColored(ImVec4(0.47F, 0.78F, 1.0F, 1.0F), "Luminance %.4g", static_cast<double>(m.measured));
  ImGui::SameLine();
  ImGui::TextColored(ImVec4(1.0F, 0.78F, 0.35F, 1.0F), "adapted %.4g", static_cast<double>(m.luminance));
  ImGui::SameLine();
  ImGui::TextDisabled("below 2^%.0f: %.1f %%", first, 100.0 * static_cast<double>(m.black));
}

void plot(const char* label, const std::array<float, FrameTimes::kCount>& values, std::size_t next) {
  float largest = 1.0F;
  for (const float value : values) largest = std::max(largest, value);
  const float last = values[(next + FrameTimes::kCount - 1) % FrameTimes::kCount];
  char overlay[48];
  std::snprintf(overlay, sizeof overlay, "%.1f ms (graph to %.0f)", static_cast<double>(last),
                static_cast<double>(largest));
  ImGui::PlotLines(label, values.data(), static_cast<int>(FrameTimes::kCount), static_cast<int>(next), overlay, 0.0F,
                   largest * 1.05F, ImVec2(ImGui::GetContentRegionAvail().x - 60.0F, 44.0F));
}

// Draws the two controls that trade detail for time.
void edit_detail(GuiState& state, Widgets& widgets) {
  ImGui::SetNextItemWidth(140.0F);
  ImGui::SliderFloat("Resolution scale", &state.resolution_scale, 0.25F, 2.0F, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  widgets.place("resolution_scale");
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "Width of the picture divided by the width of the window.\nDefault: 1, or 0.5 on devices without a GPU.");
  }
  const char* details[] = {"full", "half", "quarter"};
  int detail = state.coarseness == 4 ? 2 : state.coarseness == 2 ? 1 : 0;
  ImGui::SetNextItemWidth(140.0F);
  if (ImGui::BeginCombo("Detail of the ground", details[detail])) {
    for (int i = 0; i < 3; ++i) {
      if (ImGui::Selectable(details[i], i == detail)) detail = i;
      widgets.place("coarseness." + std::to_string(i));
    }
    ImGui::EndCombo();
  }
  widgets.place("coarseness");
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Resolution of the terrain's grid.\nDefault: full, or a quarter on devices without a GPU.");
  }
  state.coarseness = 1 << detail;
}

void show_times(const FrameTimes& times) {
  plot("passes", times.gpu, times.next);
  plot("frame", times.whole, times.next);
  if (!ImGui::BeginTable("passes", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  const auto row = [](const char* indent, const char* name, double ms) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::Text("%s%s", indent, name);
    ImGui::TableNextColumn();
    ImGui::Text("%8.2f ms", ms);
  };
  double effect = 0.0;
  for (const scene::PassTime& pass : times.passes) {
    row(pass.in_effect ? "  " : "", pass.name.c_str(), pass.ms);
    if (pass.in_effect) effect += pass.ms;
  }
  row("", "effect, total", effect);
  ImGui::EndTable();
}

void show_memory(const scene::Scene::Memory& memory) {
  if (!ImGui::BeginTable("memory", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const ResourceMemory& resource : memory.effect_resources) text_bytes(resource.name, resource.bytes);
  text_bytes("effect, persistent", memory.effect_persistent);
  text_bytes("effect, while tables are built", memory.effect_transient);
  text_bytes("effect, host", memory.effect_host);
  text_bytes("scene: pictures, shadows, terrain", memory.scene);
  ImGui::EndTable();
}

}  // namespace

void draw_performance(GuiState& state, Widgets& widgets, const GuiFacts& facts) {
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(ImVec2(viewport->Size.x, ImGui::GetFrameHeight()), ImGuiCond_FirstUseEver,
                          ImVec2(1.0F, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(std::min(340.0F, 0.5F * viewport->WorkSize.x),
                                  std::clamp(viewport->WorkSize.y - kViewsHeight, 200.0F, 620.0F)),
                           ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Performance", &state.performance, ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::TextWrapped("%s", facts.device.c_str());
    ImGui::Text("Window %u x %u, picture %u x %u, %s", facts.window.width, facts.window.height, facts.picture.width,
                facts.picture.height, facts.present_mode.c_str());
    edit_detail(state, widgets);
    if (facts.times != nullptr) show_times(*facts.times);
    const bool exposure_open = ImGui::CollapsingHeader("Histogram and exposure", ImGuiTreeNodeFlags_DefaultOpen);
    widgets.place("histogram");
    if (exposure_open && facts.scene != nullptr && facts.scene->can_render) histogram(*facts.scene);
    const bool memory_open = ImGui::CollapsingHeader("Memory");
    widgets.place("memory");
    if (memory_open && facts.scene != nullptr) show_memory(facts.scene->memory);
    if (facts.scene != nullptr && !facts.scene->pipelines.complete()) {
      const Progress& pipelines = facts.scene->pipelines;
      ImGui::TextDisabled("Pipelines created: %u of %u", pipelines.done, pipelines.total);
    }
    if (!facts.shader_message.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0F, 0.45F, 0.35F, 1.0F));
      ImGui::TextWrapped("%s", facts.shader_message.c_str());
      ImGui::PopStyleColor();
    }
  }
  ImGui::End();
}

void draw_views(GuiState& state, Widgets& widgets, const GuiFacts& facts, GuiRequests& requests) {
  const ImGuiViewport* viewport = ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(
      ImVec2(viewport->WorkPos.x + viewport->WorkSize.x, viewport->WorkPos.y + viewport->WorkSize.y),
      ImGuiCond_FirstUseEver, ImVec2(1.0F, 1.0F));
  ImGui::SetNextWindowSize(ImVec2(std::min(340.0F, 0.5F * viewport->WorkSize.x), kViewsHeight), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Views and comparison", &state.views, ImGuiWindowFlags_NoSavedSettings)) {
    PictureOptions& p = state.picture;
    ImGui::SetNextItemWidth(190.0F);
    if (ImGui::BeginCombo("Show", name_of(p.shown), ImGuiComboFlags_HeightLarge)) {
      for (int i = 0; i < kShownCount; ++i) {
        const auto shown = static_cast<Shown>(i);
        if (ImGui::Selectable(name_of(shown), shown == p.shown)) p.shown = shown;
        widgets.place("shown." + std::to_string(i));
      }
      ImGui::EndCombo();
    }
    widgets.place("shown");
    ImGui::TextWrapped("%s", meaning_of(p.shown));
    const int layers = facts.scene != nullptr ? facts.scene->shadow_layers : 1;
    p.layer = std::clamp(p.layer, 0, layers - 1);
    ImGui::SetNextItemWidth(190.0F);
    if (p.shown == Shown::shadow_map) ImGui::SliderInt("Cascade", &p.layer, 0, layers - 1);
    ImGui::SetNextItemWidth(190.0F);
    if (p.shown >= Shown::single_rayleigh && p.shown <= Shown::high_orders)
      ImGui::SliderFloat("Slice", &p.slice, 0.0F, 1.0F);
    ImGui::SetNextItemWidth(190.0F);
    if (p.shown != Shown::picture || p.difference) {
      ImGui::SliderFloat("Gain", &p.gain, 0.01F, 1000.0F, "%.3g", ImGuiSliderFlags_Logarithmic);
    }
    ImGui::Separator();
    if (ImGui::Checkbox("Compare two settings", &p.compare) && p.compare) requests.copy_to_right = true;
    widgets.place("compare");
    if (p.compare) {
      if (ImGui::Button("Copy left to right")) requests.copy_to_right = true;
      widgets.place("compare.copy");
      ImGui::SameLine();
      ImGui::Checkbox("Difference", &p.difference);
      widgets.place("compare.difference");
      ImGui::TextWrapped(
          "The controls change the side that is selected above them. Both sides share the camera and the sun.");
    }
  }
  ImGui::End();
}

}  // namespace tyndall::viewer
