#pragma once

#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// Draws upon the picture what explains it: a cross of the axes, the colour bar with its field, the names of
/// materials, the handle of the plane, what is being worked out. Between PanelContext's begin() and end().
void draw_overlay(const ViewSession& session);

}  // namespace adamas::viewer
