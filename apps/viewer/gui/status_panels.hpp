// The windows "Performance", with times, memory and exposure, and "Views and comparison", with intermediate images and
// tables.
#pragma once

#include "viewer/gui/gui_state.hpp"
#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {

void draw_performance(GuiState& state, Widgets& widgets, const GuiFacts& facts);
void draw_views(GuiState& state, Widgets& widgets, const GuiFacts& facts, GuiRequests& requests);

}  // namespace tyndall::viewer
