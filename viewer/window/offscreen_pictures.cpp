#include "viewer/window/offscreen_pictures.h"

#include <optional>
#include <utility>

#include "viewer/gl/offscreen_context.h"
#include "viewer/window/session_picture.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

struct OffscreenPictures::Parts {
  OffscreenContext context;
  SessionPictures pictures;

  Parts(int width, int height) : pictures(width, height) {}
};

OffscreenPictures::OffscreenPictures(ViewSession& session, int width, int height)
    : session_(session), parts_(std::make_unique<Parts>(width, height)) {
  session.has_panels = false;
}

OffscreenPictures::~OffscreenPictures() = default;

const std::string& OffscreenPictures::drawn_by() const { return parts_->context.name(); }

void OffscreenPictures::find_depths() { session_.set_depths(parts_->pictures.depths(session_)); }

void OffscreenPictures::find_depths_of_culled_view() {
  const std::optional<Viewpoint> from = std::exchange(session_.state().culled_from, std::nullopt);
  session_.state().viewpoint = *from;
  session_.set_size(parts_->pictures.width(), parts_->pictures.height());
  session_.finish();
  find_depths();
  session_.state().culled_from = session_.state().viewpoint;
}

std::optional<Raster> OffscreenPictures::draw(const Viewpoint& viewpoint) {
  if (session_.state().leaves_out_hidden && session_.state().culled_from && !session_.state().depths)
    find_depths_of_culled_view();
  session_.state().viewpoint = viewpoint;
  session_.set_size(parts_->pictures.width(), parts_->pictures.height());
  // The last surface, seen from here, shows what is hidden.
  if (session_.wants_depths()) find_depths();
  session_.finish();
  report_ = session_.report();
  if (!report_.problem.empty()) return std::nullopt;
  return parts_->pictures.draw(session_);
}

const DrawFigures& OffscreenPictures::drawn() const { return parts_->pictures.figures(); }

double OffscreenPictures::draw_seconds() const { return parts_->pictures.seconds(); }

}  // namespace adamas::viewer
