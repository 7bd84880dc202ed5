// The window "Controls": basic and additional settings, tone mapping, the atmosphere, and every parameter. What a
// control looks like comes from the table of parameters; the panels choose which are shown and when they have an
// effect.
#pragma once

#include "config/settings.hpp"
#include "viewer/gui/gui_state.hpp"
#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {

void draw_controls(GuiState& state, Widgets& widgets, config::Settings& settings);

}  // namespace tyndall::viewer
