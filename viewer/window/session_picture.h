#pragma once

#include <memory>

#include "isosurface/view/depth_pyramid.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/scene/view_session.h"
#include "viewer/window/panel_context.h"

namespace adamas {

/// What a session shows by now.
PictureContents session_picture(ViewSession& session);

/// What a picture hides that was drawn from a viewpoint.
std::shared_ptr<const DepthPyramid> depths_of(const PictureTarget& target, const Viewpoint& viewpoint,
                                              const DrawFigures& figures);

/// Draws that with what explains it, and without the panels: a screenshot.
DrawFigures draw_session(const ViewSession& session, const PictureContents& contents, Renderer& renderer,
                         const PictureTarget& target, PanelContext& panels);

}  // namespace adamas
