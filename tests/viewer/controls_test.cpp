// Every control of two panels to both of its ends, by the mouse and the keyboard; memory_test.cpp takes every parameter there by a
// script.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "config/text.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;
using config::Row;

// The value that a control shows at an end of its range.
std::string end_text(const Row& row, bool largest) {
  const double end = largest ? row.info.max : row.info.min;
  const bool whole = row.info.type == ParamType::uint32 || row.info.type == ParamType::uvec4;
  const std::string one = whole ? std::to_string(static_cast<std::uint32_t>(end)) : config::number_text(static_cast<float>(end));
  const int count = row.info.type == ParamType::vec3 ? 3 : row.info.type == ParamType::uvec4 ? 4 : 1;
  std::string text = one;
  for (int i = 1; i < count; ++i) text.append(",").append(one);
  config::Settings settings;
  return config::set(settings, row.key(), text, "test").ok() ? config::value_text(row, settings) : "";
}

bool was_set(Desk& desk, const Row& row, const std::string& text, std::size_t from) {
  // Values on the way there begin with the same digits.
  for (int i = 0; i < 100; ++i) {
    const std::optional<std::string> line = desk.wait_for({" set " + row.key() + "=" + text}, from, 15.0);
    if (!line) return false;
    if (line->ends_with("=" + text)) return true;
    ++from;
  }
  return false;
}

// Types a value into each component: Ctrl and click opens the first, Tab the next.
bool type_end(Desk& desk, const Row& row, bool largest) {
  const std::string text = end_text(row, largest);
  const std::string one = text.substr(0, text.find(','));
  const std::size_t from = desk.lines();
  desk.hands("keydown ctrl");
  const bool clicked = desk.click(row.key(), 0.05);
  desk.hands("keyup ctrl");
  if (!clicked) return false;
  const int count = row.info.type == ParamType::vec3 ? 3 : row.info.type == ParamType::uvec4 ? 4 : 1;
  for (int i = 0; i < count; ++i) {
    desk.hands("key --delay 40 ctrl+a");
    desk.hands("type --delay 40 " + one);
    desk.hands(i + 1 < count ? "key --delay 40 Tab" : "key --delay 40 Return");
  }
  return was_set(desk, row, text, from);
}

bool choose(Desk& desk, const Row& row, std::size_t index, const std::string& text) {
  const std::size_t from = desk.lines();
  return desk.click(row.key(), 0.2) && desk.click(row.key() + "." + std::to_string(index), 0.2) && was_set(desk, row, text, from);
}

bool choose_both_ends(Desk& desk, const Row& row) {
  if (row.info.type == ParamType::uint32) return choose(desk, row, 4096, "4096") && choose(desk, row, 512, "512") && choose(desk, row, 1024, "1024");
  const std::size_t last = config::count_parts(row.info.choices, '|') - 1;
  const auto name = [&](std::size_t i) { return std::string(config::part(row.info.choices, '|', i)); };
  // From wherever it stands: an end that it stands at is no change.
  (void)(desk.click(row.key(), 0.2) && desk.click(row.key() + ".0", 0.2));
  return choose(desk, row, last, name(last)) && choose(desk, row, 0, name(0));
}

bool both_ends(Desk& desk, const Row& row) {
  const std::string key = row.key();
  if (row.info.type == ParamType::enumeration || key == "shadows.resolution") return choose_both_ends(desk, row);
  if (row.info.type == ParamType::flag) {
    const std::size_t from = desk.lines();
    return desk.click(key, 0.04) && desk.click(key, 0.04) && was_set(desk, row, "true", from) && was_set(desk, row, "false", from);
  }
  // Numbers without a slider: a drag has no end.
  const bool typed = row.info.max > 1.0e6 || row.info.type == ParamType::uvec4 ||
                     (row.info.type == ParamType::uint32 && row.info.max > 100000) ||
                     (row.info.type == ParamType::vec3 && row.info.max <= 1.0);
  std::size_t from = 0;
  if (typed) {
    if (!type_end(desk, row, true) || !type_end(desk, row, false)) return false;
  } else {
    from = desk.lines();
    if (!pull(desk, key, {-0.02}) || !pull(desk, key, {1.1})) return false;
    if (!was_set(desk, row, end_text(row, true), from)) return false;
    from = desk.lines();
    if (!pull(desk, key, {-0.02}) || !was_set(desk, row, end_text(row, false), from)) return false;
  }
  // A right click brings the default back.
  const std::string usual = config::value_text(row, config::Settings());
  if (usual == end_text(row, false)) return true;
  from = desk.lines();
  return desk.click(key, 0.3, 3) && was_set(desk, row, usual, from);
}

class Controls : public testing::TestWithParam<const char*> {};

TEST_P(Controls, GoToBothEnds) {
  NEEDS_A_DESK();
  std::string name = GetParam();
  std::replace(name.begin(), name.end(), ' ', '_');
  Desk desk("controls_" + name, 900, 1000);
  // Small, and with what would be grey otherwise in effect.
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "900x1000", "--no-first-steps", "--set", "scattering.light_shafts=off", "--set",
                                              "scattering.single=integration", "--set", "epipolar.correct_depth_breaks=on", "--set",
                                              "atmosphere.custom_coefficients=on"})))
      << desk.errors();
  ASSERT_TRUE(desk.click("menu.Windows"));
  ASSERT_TRUE(desk.click("item.Performance"));
  ASSERT_TRUE(pull(desk, "resolution_scale", {-0.02}));
  ASSERT_TRUE(desk.click(std::string("tab.") + GetParam()));
  ASSERT_TRUE(desk.wait_for({"frame left"}, desk.lines() - 1));
  std::vector<const Row*> rows;
  for (const std::string& place : desk.place_names()) {
    if (const Row* row = config::find_row(place); row != nullptr) rows.push_back(row);
  }
  EXPECT_GE(rows.size(), 8U) << "controls in sight";
  for (const Row* row : rows) EXPECT_TRUE(both_ends(desk, *row)) << row->key();
  desk.picture("after");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

INSTANTIATE_TEST_SUITE_P(Window, Controls, testing::Values("Basic", "Tone mapping"), [](const auto& tested) {
  std::string name = tested.param;
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  return name;
});

}  // namespace
}  // namespace tyndall
