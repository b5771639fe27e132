#pragma once

#include <memory>

#include "core/picture/raster.h"
#include "isosurface/view/depth_pyramid.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"
#include "viewer/window/panel_context.h"

namespace adamas::viewer {

/// What a session shows by now.
PictureContents session_picture(ViewSession& session);

/// What a picture hides that was drawn from a viewpoint.
std::shared_ptr<const isosurface::DepthPyramid> depths_of(const PictureTarget& target,
                                                          const isosurface::Viewpoint& viewpoint,
                                                          const DrawFigures& figures);

/// Draws that with what explains it, and without the panels: a screenshot.
DrawFigures draw_session(const ViewSession& session, const PictureContents& contents, Renderer& renderer,
                         const PictureTarget& target, PanelContext& panels);

/// Pictures of sessions in memory, by the OpenGL context that is current when this is made.
class SessionPictures {
 public:
  /// `scale`: of texts, as PanelContext has it. Throws Error where there is no picture of this size.
  SessionPictures(int width, int height, double scale = 1);

  [[nodiscard]] int width() const { return target_.width(); }
  [[nodiscard]] int height() const { return target_.height(); }
  /// What the session shows by now, as a screenshot.
  picture::Raster draw(ViewSession& session);
  /// What drawing the last one came to, in how many seconds.
  [[nodiscard]] const DrawFigures& figures() const { return figures_; }
  [[nodiscard]] double seconds() const { return seconds_; }
  /// What a picture of now hides.
  std::shared_ptr<const isosurface::DepthPyramid> depths(ViewSession& session);

 private:
  Renderer renderer_;
  PictureTarget target_;
  PanelContext panels_;
  DrawFigures figures_;
  double seconds_ = 0;
};

}  // namespace adamas::viewer
