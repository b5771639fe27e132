#include "viewer/window/frame_files.h"

#include <fmt/format.h>

#include "core/picture/canvas.h"

namespace adamas::viewer {

using namespace picture;

void FrameFiles::add(const Raster& picture) {
  ++count_;
  if (!places_.folder.empty()) write_png(places_.folder / fmt::format("frame{:04}.png", count_), picture);
  if (places_.film.empty()) return;
  if (!film_)
    film_ =
        std::make_unique<Film>(places_.film, picture.width(), picture.height(), places_.frames_per_second);
  film_->add(picture);
}

void FrameFiles::finish() {
  if (film_) film_->finish();
}

}  // namespace adamas::viewer
