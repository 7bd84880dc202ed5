// Sets every control of two panels to both ends of its range with mouse and keyboard. memory_test.cpp does so for all
// parameters with a script.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "files/text.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;
using config::Row;

int components_of(const Row& row) { return static_cast<int>(config::component_count(row.info.type)); }

// Returns a number of the row in the format of the log.
std::string text_of(const Row& row, double value) {
  const bool whole = row.info.type == ParamType::uint32 || row.info.type == ParamType::uvec4;
  return whole ? std::to_string(static_cast<std::uint32_t>(value)) : files::number_text(static_cast<float>(value));
}

// Waits until the viewer has set the row or one of its components to this text.
bool was_set(Desk& desk, const Row& row, const std::string& text, std::size_t from, std::size_t component = 0) {
  const std::string before = " set " + row.key() + "=";
  while (const std::optional<LogLine> line = desk.wait_for_line({before}, from, 15.0)) {
    const std::string value = line->text.substr(line->text.find(before) + before.size());
    if (components_of(row) == 1 ? value == text : files::part(value, ',', component) == text) return true;
    from = line->number + 1;
  }
  return false;
}

// Returns the names that xdotool has for the keys of a number and for the final Enter.
std::string keys_of(const std::string& number) {
  std::string keys = "key --delay 15";
  for (const char c : number) {
    keys += c == '.' ? " period" : c == '-' ? " minus" : c == '+' ? " plus" : std::string(" ") + c;
  }
  return keys + " Return";
}

// Types a number into a control. Ctrl and click opens it for typing.
bool type_into(Desk& desk, const Row& row, const std::string& place, const std::string& text, std::size_t component) {
  const std::size_t from = desk.lines();
  desk.input("keydown ctrl");
  const bool clicked = desk.click(place, 0.3);
  desk.input("keyup ctrl " + keys_of(text));
  return clicked && was_set(desk, row, text, from, component);
}

bool choose(Desk& desk, const Row& row, std::size_t index, const std::string& text) {
  const std::size_t from = desk.lines();
  return desk.click(row.key(), 0.2) && desk.click(row.key() + "." + std::to_string(index), 0.2) &&
         was_set(desk, row, text, from);
}

bool choose_both_ends(Desk& desk, const Row& row) {
  if (row.info.type == ParamType::uint32)
    return choose(desk, row, 4096, "4096") && choose(desk, row, 512, "512") && choose(desk, row, 1024, "1024");
  // The last phase function, a table, is refused without a file.
  const bool refused = row.key() == "atmosphere.mie_phase";
  const std::size_t last = files::count_parts(row.info.choices, '|') - (refused ? 2 : 1);
  const auto name = [&](std::size_t i) { return std::string(files::part(row.info.choices, '|', i)); };
  // The control is set to another value first, because the log shows only changes.
  (void)(desk.click(row.key(), 0.2) && desk.click(row.key() + ".0", 0.2));
  return choose(desk, row, last, name(last)) && choose(desk, row, 0, name(0));
}

bool both_ends(Desk& desk, const Row& row) {
  const std::string key = row.key();
  if (row.info.type == ParamType::string) return true;  // a text has no ends
  if (row.info.type == ParamType::enumeration || key == "shadows.resolution") return choose_both_ends(desk, row);
  if (row.info.type == ParamType::flag) {
    const std::size_t from = desk.lines();
    return desk.click(key, 0.04) && desk.click(key, 0.04) && was_set(desk, row, "true", from) &&
           was_set(desk, row, "false", from);
  }
  // Numbers without a slider are typed, because dragging has no end.
  const bool typed = row.info.max > 1.0e6 || row.info.type == ParamType::uvec4 ||
                     (row.info.type == ParamType::uint32 && row.info.max > 100000) ||
                     (row.info.type == ParamType::vec3 && row.info.max <= 1.0);
  const std::string minimum = text_of(row, row.info.min);
  const std::string maximum = text_of(row, row.info.max);
  const int count = components_of(row);
  std::size_t from = 0;
  for (int i = 0; i < count; ++i) {
    const auto component = static_cast<std::size_t>(i);
    const std::string place = count > 1 ? key + "." + std::to_string(i) : key;
    if (typed) {
      if (!type_into(desk, row, place, maximum, component)) return false;
      // Tables of that size may be refused, which restores the old value. Another value is set first, so that the next
      // one is a change in any case.
      if (row.info.type == ParamType::uvec4 && !type_into(desk, row, place, "6", component)) return false;
      if (!type_into(desk, row, place, minimum, component)) return false;
      continue;
    }
    from = desk.lines();
    if (!pull(desk, place, {-0.02, 1.1, -0.02})) return false;
    if (!was_set(desk, row, maximum, from, component) || !was_set(desk, row, minimum, from, component)) return false;
  }
  // A right click restores the default.
  const config::Settings usual;
  std::string lowest = minimum;
  for (int i = 1; i < count; ++i) lowest += "," + minimum;
  if (config::value_text(row, usual) == lowest) return true;  // it has that value already
  from = desk.lines();
  return desk.click(key, 0.3, 3) &&
         desk.wait_for({" set " + key + "=" + config::value_text(row, usual)}, from, 15.0).has_value();
}

class Controls : public testing::TestWithParam<const char*> {};

TEST_P(Controls, GoToBothEnds) {
  NEEDS_A_DESK();
  std::string name = GetParam();
  std::replace(name.begin(), name.end(), ' ', '_');
  Desk desk("controls_" + name, 900, 1000);
  // Small settings, with which no control is greyed out.
  const std::vector<std::string> few = {"--set", "epipolar.slices=64", "--set", "epipolar.samples=64"};
  ASSERT_TRUE(desk.open(joined(joined(kSmallTables, few),
                               {"--size", "900x1000", "--no-first-steps", "--set", "scattering.light_shafts=off",
                                "--set", "scattering.single=integration", "--set", "epipolar.correct_depth_breaks=on",
                                "--set", "atmosphere.custom_coefficients=on"})))
      << desk.errors();
  ASSERT_TRUE(desk.click("menu.Windows"));
  ASSERT_TRUE(desk.click("item.Performance"));
  ASSERT_TRUE(desk.click("resolution_scale", 0.005));
  ASSERT_TRUE(desk.wait_for({" 225 250 "}));
  ASSERT_TRUE(desk.click(std::string("tab.") + GetParam()));
  ASSERT_TRUE(desk.wait_for_place(key_of(GetParam())));
  std::vector<const Row*> rows;
  for (const std::string& place : desk.place_names()) {
    if (const Row* row = config::find_row(place); row != nullptr) rows.push_back(row);
  }
  EXPECT_GE(rows.size(), 8U) << "controls in sight";
  for (const Row* row : rows) EXPECT_TRUE(both_ends(desk, *row)) << row->key();
  desk.picture("after");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

INSTANTIATE_TEST_SUITE_P(Window, Controls, testing::Values("Basic", "Additional", "Tone mapping", "Atmosphere"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                           return name;
                         });

}  // namespace
}  // namespace tyndall
