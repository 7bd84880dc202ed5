// The window "Controls": basic and additional settings, tone mapping, the atmosphere, and every parameter. The
// appearance of a control follows from the table of parameters. The panels select the controls, and grey out those that
// have no effect.
#pragma once

#include "config/settings.hpp"
#include "viewer/gui/gui_state.hpp"
#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {

void draw_controls(GuiState& state, Widgets& widgets, config::Settings& settings);

}  // namespace tyndall::viewer
