// Whether settings are the same, parameter by parameter.
#pragma once

#include "config/settings.hpp"

namespace tyndall::viewer {

[[nodiscard]] bool same_value(const config::Row& row, const config::Settings& a, const config::Settings& b);
[[nodiscard]] bool same_settings(const config::Settings& a, const config::Settings& b);
// Whether nothing but tonemap.* differs.
[[nodiscard]] bool same_but_for_tone(const config::Settings& a, const config::Settings& b);
// Takes from `had` what is still as in `asked`, which could not be had: what was changed since then stays.
void go_back(config::Settings& settings, const config::Settings& asked, const config::Settings& had);
// Makes what ranges alone cannot say hold: shadows.first_marched below shadows.cascades.
void make_consistent(config::Settings& settings);

}  // namespace tyndall::viewer
