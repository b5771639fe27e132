#pragma once

#include <memory>

#include "core/picture/raster.h"
#include "isosurface/view/depth_pyramid.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"
#include "viewer/window/panel_context.h"

namespace adamas::viewer {

/// The present contents of a picture of a session.
PictureContents session_picture(ViewSession& session);

/// The depths of a picture that was drawn from a viewpoint.
std::shared_ptr<const isosurface::DepthPyramid> depths_of(const PictureTarget& target,
                                                          const isosurface::Viewpoint& viewpoint,
                                                          const DrawFigures& figures);

/// Draws such contents with the overlay and without panels, as a screenshot.
DrawFigures draw_session(const ViewSession& session, const PictureContents& contents, Renderer& renderer,
                         const PictureTarget& target, PanelContext& panels);

/// Draws pictures of sessions into memory with the OpenGL context that is current when this is made.
class SessionPictures {
 public:
  /// `scale`: the scale of texts as in PanelContext. Throws Error if the context cannot make pictures of this
  /// size.
  SessionPictures(int width, int height, double scale = 1);

  [[nodiscard]] int width() const { return target_.width(); }
  [[nodiscard]] int height() const { return target_.height(); }
  /// Draws what the session shows now, as a screenshot.
  picture::Raster draw(ViewSession& session);
  /// The figures of drawing the last picture, and the seconds that it took.
  [[nodiscard]] const DrawFigures& figures() const { return figures_; }
  [[nodiscard]] double seconds() const { return seconds_; }
  /// The depths of a picture of what the session shows now.
  std::shared_ptr<const isosurface::DepthPyramid> depths(ViewSession& session);

 private:
  Renderer renderer_;
  PictureTarget target_;
  PanelContext panels_;
  DrawFigures figures_;
  double seconds_ = 0;
};

}  // namespace adamas::viewer
