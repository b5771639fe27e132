#pragma once

#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// Draws explanations over the picture: a cross of the axes, the colour bar with its field, the names of
/// materials, the handle of the plane, the work in progress. It has to be called between PanelContext's
/// begin() and end().
void draw_overlay(const ViewSession& session);

}  // namespace adamas::viewer
