#include "viewer/window/offscreen_pictures.h"

#include <chrono>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/picture_target.h"
#include "viewer/window/overlay.h"
#include "viewer/window/panel_context.h"
#include "viewer/window/session_picture.h"

namespace adamas {

struct OffscreenPictures::Parts {
  OffscreenContext context;
  Renderer renderer;
  PictureTarget target;
  PanelContext panels;

  Parts(int width, int height) : target(width, height) { panels.use_opengl(); }
};

OffscreenPictures::OffscreenPictures(ViewSession& session, int width, int height)
    : session_(session), parts_(std::make_unique<Parts>(width, height)) {
  session.has_panels = false;
}

OffscreenPictures::~OffscreenPictures() = default;

const std::string& OffscreenPictures::drawn_by() const { return parts_->context.name(); }

void OffscreenPictures::find_depths() {
  const PictureContents last = session_picture(session_);
  const DrawFigures figures = parts_->renderer.draw(last, parts_->target.framebuffer(),
                                                    parts_->target.width(), parts_->target.height());
  session_.set_depths(depths_of(parts_->target, session_.state().viewpoint, figures));
}

void OffscreenPictures::find_depths_of_culled_view() {
  const std::optional<Viewpoint> from = std::exchange(session_.state().culled_from, std::nullopt);
  session_.state().viewpoint = *from;
  session_.set_size(parts_->target.width(), parts_->target.height());
  session_.finish();
  find_depths();
  session_.state().culled_from = session_.state().viewpoint;
}

Raster OffscreenPictures::draw(const Viewpoint& viewpoint) {
  if (session_.state().leaves_out_hidden && session_.state().culled_from && !session_.state().depths)
    find_depths_of_culled_view();
  session_.state().viewpoint = viewpoint;
  session_.set_size(parts_->target.width(), parts_->target.height());
  // The last surface, seen from here, tells what is hidden.
  if (session_.wants_depths()) find_depths();
  session_.finish();
  report_ = session_.report();
  if (!report_.problem.empty()) fail("{}", report_.problem);
  const PictureContents contents = session_picture(session_);
  const auto before = std::chrono::steady_clock::now();
  drawn_ = draw_session(session_, contents, parts_->renderer, parts_->target, parts_->panels);
  Raster raster = parts_->target.read();
  draw_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return raster;
}

}  // namespace adamas
