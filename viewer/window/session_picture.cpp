#include "viewer/window/session_picture.h"

#include <chrono>

#include "viewer/window/overlay.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

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

SessionPictures::SessionPictures(int width, int height, double scale)
    : target_(width, height), panels_(scale) {
  panels_.use_opengl();
}

Raster SessionPictures::draw(ViewSession& session) {
  const PictureContents contents = session_picture(session);
  const auto before = std::chrono::steady_clock::now();
  figures_ = draw_session(session, contents, renderer_, target_, panels_);
  Raster raster = target_.read();
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return raster;
}

std::shared_ptr<const DepthPyramid> SessionPictures::depths(ViewSession& session) {
  const PictureContents contents = session_picture(session);
  const DrawFigures figures = renderer_.draw(contents, target_.framebuffer(), width(), height());
  return depths_of(target_, session.state().viewpoint, figures);
}

}  // namespace adamas::viewer
