#pragma once

#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// How much of the picture's lower edge the panel of steps takes: nothing where no series is open, or panels
/// are put away.
float step_panel_height(const ViewSession& session);

/// Shows it: playing, how fast, and a slider over the steps on which those are marked that are in memory.
void show_step_panel(ViewSession& session);

}  // namespace adamas::viewer
