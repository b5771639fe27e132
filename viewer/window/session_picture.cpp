#include "viewer/window/session_picture.h"

#include "viewer/window/overlay.h"

namespace adamas {

PictureContents session_picture(ViewSession& session) {
  PictureContents contents;
  contents.parts = session.parts();
  contents.viewpoint = session.state().viewpoint;
  contents.shading = session.state().shading;
  contents.colour_map = session.state().colour_map;
  contents.clip = session.clip();
  return contents;
}

std::shared_ptr<const DepthPyramid> depths_of(const PictureTarget& target, const Viewpoint& viewpoint,
                                              const DrawFigures& figures) {
  return std::make_shared<const DepthPyramid>(viewpoint, target.depths(viewpoint, figures.far));
}

DrawFigures draw_session(const ViewSession& session, const PictureContents& contents, Renderer& renderer,
                         const PictureTarget& target, PanelContext& panels) {
  const DrawFigures figures = renderer.draw(contents, target.framebuffer(), target.width(), target.height());
  panels.begin(target.width(), target.height(), 1e-3);
  draw_overlay(session);
  panels.end();
  panels.draw();
  return figures;
}

}  // namespace adamas
