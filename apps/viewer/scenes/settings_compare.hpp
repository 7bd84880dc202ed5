// Compares settings parameter by parameter.
#pragma once

#include "config/settings.hpp"

namespace tyndall::viewer {

[[nodiscard]] bool same_value(const config::Row& row, const config::Settings& a, const config::Settings& b);
[[nodiscard]] bool same_settings(const config::Settings& a, const config::Settings& b);
// Returns whether only tonemap.* differs.
[[nodiscard]] bool same_but_for_tone(const config::Settings& a, const config::Settings& b);
// Resets to `current` every parameter that still has its value in `requested`, which could not be applied. Parameters
// that have changed since then stay.
void go_back(config::Settings& settings, const config::Settings& requested, const config::Settings& current);
// Corrects what the ranges of single parameters cannot express: shadows.first_marched below shadows.cascades.
void make_consistent(config::Settings& settings);

}  // namespace tyndall::viewer
