#include "viewer/gui/widgets.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <functional>

#include "files/text.hpp"

namespace tyndall::viewer {
namespace {

using config::Row;
using config::Settings;

constexpr ImGuiSliderFlags kSlider = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

template <typename T>
T* at(const Row& row, Settings& settings) {
  std::byte* const base = row.owner == config::Owner::effect ? reinterpret_cast<std::byte*>(&settings.effect)
                                                             : reinterpret_cast<std::byte*>(&settings.scene);
  return reinterpret_cast<T*>(base + row.info.offset);
}

int component_count(const Row& row) { return static_cast<int>(config::component_count(row.info.type)); }

// Returns whether the range spans several powers of ten, so that the slider is logarithmic.
bool is_wide(const Row& row) { return row.info.max - row.info.min > 500.0 && row.info.min >= 0.0; }

bool is_boundless(const Row& row) { return row.info.max > 1.0e6; }

const char* float_format(const Row& row, float value) {
  static std::string text;  // ImGui uses the text before the next call replaces it
  const bool fine = row.info.max - row.info.min <= 2.0 && (value == 0.0F || std::abs(value) >= 0.001F);
  text = fine ? "%.3f" : "%.4g";
  if (!row.info.unit.empty() && row.info.unit != "1") text.append(" ").append(row.info.unit);
  return text.c_str();
}

bool edit_float(const Row& row, const char* id, float* values, int count) {
  const auto min = static_cast<float>(row.info.min);
  const auto max = static_cast<float>(row.info.max);
  // For coefficients and positions no slider is fine enough: a drag changes them by a fraction of the value.
  const bool tiny = count == 3 && row.info.max <= 1.0;
  if (is_boundless(row) || tiny) {
    float largest = 0.0F;
    for (int i = 0; i < count; ++i) largest = std::max(largest, std::abs(values[i]));
    const float speed = tiny ? std::max(0.01F * largest, 1.0e-8F) : std::max(0.005F * largest, 0.01F);
    return ImGui::DragScalarN(id, ImGuiDataType_Float, values, count, speed, &min, &max,
                              count > 1 ? "%.3g" : float_format(row, values[0]), kSlider);
  }
  const ImGuiSliderFlags flags = kSlider | (is_wide(row) ? ImGuiSliderFlags_Logarithmic : 0);
  return ImGui::SliderScalarN(id, ImGuiDataType_Float, values, count, &min, &max,
                              count > 1 ? "%.3g" : float_format(row, values[0]), flags);
}

// Draws the widget of a position. Double precision resolves metres at any distance from the origin.
bool edit_place(const Row& row, const char* id, double* values) {
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(values[i]));
  const auto speed = static_cast<float>(std::max(0.005 * largest, 0.01));
  return ImGui::DragScalarN(id, ImGuiDataType_Double, values, 3, speed, &row.info.min, &row.info.max, "%.8g", kSlider);
}

// Draws the widget of one or more whole numbers. If it is a list of choices, `place` records where each of them is.
bool edit_whole(const Row& row, const char* id, std::uint32_t* values, int count,
                const std::function<void(std::uint32_t)>& place) {
  const auto min = static_cast<std::uint32_t>(row.info.min);
  const auto max = static_cast<std::uint32_t>(row.info.max);
  if (row.info.group == "shadows" && row.info.name == "resolution") {
    // The sizes of the demo of Yusov (2013); scene files allow others.
    bool changed = false;
    if (ImGui::BeginCombo(id, std::to_string(*values).c_str())) {
      for (std::uint32_t size = 512; size <= 4096; size *= 2) {
        if (ImGui::Selectable(std::to_string(size).c_str(), *values == size)) {
          changed = *values != size;
          *values = size;
        }
        place(size);
      }
      ImGui::EndCombo();
    }
    return changed;
  }
  if (max > 100000 || count > 1) {
    const float speed = std::max(0.01F * static_cast<float>(*values), 0.2F);
    return ImGui::DragScalarN(id, ImGuiDataType_U32, values, count, speed, &min, &max, "%u",
                              ImGuiSliderFlags_AlwaysClamp);
  }
  const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (is_wide(row) ? ImGuiSliderFlags_Logarithmic : 0);
  return ImGui::SliderScalar(id, ImGuiDataType_U32, values, &min, &max, "%u", flags);
}

bool edit_choice(const Row& row, const char* id, std::uint32_t* value,
                 const std::function<void(std::uint32_t)>& place) {
  bool changed = false;
  const std::string shown(files::part(row.info.choices, '|', *value));
  if (!ImGui::BeginCombo(id, shown.c_str(), ImGuiComboFlags_HeightLarge)) return false;
  for (std::uint32_t i = 0; i < files::count_parts(row.info.choices, '|'); ++i) {
    const std::string name(files::part(row.info.choices, '|', i));
    if (ImGui::Selectable(name.c_str(), i == *value)) {
      changed = i != *value;
      *value = i;
    }
    place(i);
  }
  ImGui::EndCombo();
  return changed;
}

void clamp_whole(const Row& row, std::uint32_t* values, int count) {
  for (int i = 0; i < count; ++i) {
    values[i] =
        std::clamp(values[i], static_cast<std::uint32_t>(row.info.min), static_cast<std::uint32_t>(row.info.max));
  }
}

void show_tooltip(const std::string& text) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28.0F);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace

// With `with_group`, the group's name is added to a single word, which may be ambiguous: "Sun elevation".
std::string label_of(const Row& row, bool with_group) {
  std::string text(row.info.name);
  for (const std::string_view unit : {"_m", "_deg", "_nm", "_mib"}) {
    if (text.size() > unit.size() && text.ends_with(unit)) text.resize(text.size() - unit.size());
  }
  if (with_group && text.find('_') == std::string::npos) text = std::string(row.info.group) + ' ' + text;
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string tooltip_of(const Row& row) {
  static const Settings kDefaults;
  std::string text = files::concat({row.info.doc, "\n\n", row.key(), ": ", config::allowed_text(row)});
  text += "\nDefault: " + config::value_text(row, kDefaults) + ". A right click resets the value.";
  if (row.info.affects == Affects::Tables) text += "\nA change rebuilds the scattering tables, which takes a while.";
  return text;
}

void set_to_end(const Row& row, Settings& settings, bool largest) {
  const double end = largest ? row.info.max : row.info.min;
  const int count = component_count(row);
  switch (row.info.type) {
    case ParamType::float32:
    case ParamType::vec3: std::fill_n(at<float>(row, settings), count, static_cast<float>(end)); break;
    case ParamType::dvec3: std::fill_n(at<double>(row, settings), count, end); break;
    case ParamType::uint32:
    case ParamType::uvec4: std::fill_n(at<std::uint32_t>(row, settings), count, static_cast<std::uint32_t>(end)); break;
    case ParamType::flag: *at<std::uint32_t>(row, settings) = largest ? 1 : 0; break;
    case ParamType::enumeration:
      *at<std::uint32_t>(row, settings) =
          largest ? static_cast<std::uint32_t>(files::count_parts(row.info.choices, '|') - 1) : 0;
      break;
    case ParamType::string: break;
  }
}

void Widgets::begin_frame() {
  places_.clear();
  dragging_ = false;
}

void Widgets::place(std::string name) {
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  if (ImGui::IsItemVisible()) places_.push_back({std::move(name), min.x, min.y, max.x - min.x, max.y - min.y});
}

// Records the places KEY.0, KEY.1 and so on of the components, which divide the width evenly.
void Widgets::place_components(const Row& row, const std::string& key, float width) {
  const int count = component_count(row);
  if (count == 1 || !ImGui::IsItemVisible()) return;
  const ImVec2 min = ImGui::GetItemRectMin();
  const float height = ImGui::GetItemRectMax().y - min.y;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float each = (width - gap * static_cast<float>(count - 1)) / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    places_.push_back(
        {key + "." + std::to_string(i), min.x + static_cast<float>(i) * (each + gap), min.y, each, height});
  }
}

bool Widgets::edit(std::string_view key, Settings& settings) {
  const Row* const row = config::find_row(key);
  return row != nullptr && edit(*row, settings);
}

bool Widgets::edit(const Row& row, Settings& settings) {
  const std::string key = row.key();
  ImGui::PushID(key.c_str());
  bool changed = false;
  const std::string label = label_of(row, with_group);
  // The label is on the right and takes the space that it needs; the widget takes the rest.
  const float width = ImGui::GetContentRegionAvail().x * 0.52F;
  if (row.info.type != ParamType::flag) ImGui::SetNextItemWidth(width);
  const char* const id = label.c_str();
  const auto place_choice = [&](std::uint32_t i) { place(key + "." + std::to_string(i)); };
  switch (row.info.type) {
    case ParamType::float32: changed = edit_float(row, id, at<float>(row, settings), 1); break;
    case ParamType::vec3: changed = edit_float(row, id, at<float>(row, settings), 3); break;
    case ParamType::dvec3: changed = edit_place(row, id, at<double>(row, settings)); break;
    case ParamType::uint32: {
      auto* const value = at<std::uint32_t>(row, settings);
      changed = edit_whole(row, id, value, 1, place_choice);
      clamp_whole(row, value, 1);
      break;
    }
    case ParamType::uvec4: {
      auto* const values = at<std::uint32_t>(row, settings);
      changed = edit_whole(row, id, values, 4, place_choice);
      clamp_whole(row, values, 4);
      break;
    }
    case ParamType::flag: {
      auto* const value = at<std::uint32_t>(row, settings);
      bool on = *value != 0;
      changed = ImGui::Checkbox(id, &on);
      *value = on ? 1 : 0;
      break;
    }
    case ParamType::enumeration: changed = edit_choice(row, id, at<std::uint32_t>(row, settings), place_choice); break;
    case ParamType::string: {
      std::string text = *at<std::string>(row, settings);
      if (ImGui::InputText(id, &text, ImGuiInputTextFlags_EnterReturnsTrue)) {
        changed = config::store(settings, row, {text}, key).ok();
      }
      break;
    }
  }
  place(key);
  place_components(row, key, width);
  dragging_ = dragging_ || ImGui::IsItemActive();
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) show_tooltip(tooltip_of(row));
  if (ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right)) {
    static const Settings kDefaults;
    changed = config::set(settings, key, config::value_text(row, kDefaults), key).ok() || changed;
  }
  ImGui::PopID();
  return changed;
}

bool Widgets::edit_color(std::string_view key, Settings& settings, float scale) {
  const Row* const row = config::find_row(key);
  if (row == nullptr || row->info.type != ParamType::vec3) return false;
  auto* const values = at<float>(*row, settings);
  std::array<float, 3> color = {values[0] / scale, values[1] / scale, values[2] / scale};
  const std::string id = label_of(*row, with_group) + "##" + std::string(key) + "_color";
  const bool changed = ImGui::ColorEdit3(
      id.c_str(), color.data(), ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_HDR);
  place(std::string(key) + "_color");
  dragging_ = dragging_ || ImGui::IsItemActive();
  if (ImGui::IsItemHovered()) {
    show_tooltip(files::concat(
        {"The coefficient as a colour. Full brightness is ", files::number_text(scale), " 1/m. ", row->info.doc}));
  }
  if (!changed) return false;
  for (int i = 0; i < 3; ++i) {
    values[i] = std::clamp(color[static_cast<std::size_t>(i)] * scale, static_cast<float>(row->info.min),
                           static_cast<float>(row->info.max));
  }
  return true;
}

}  // namespace tyndall::viewer
