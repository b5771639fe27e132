#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/picture/film.h"
#include "core/picture/raster.h"

namespace adamas::viewer {

/// The outputs of a flight; an output with an empty name is not written.
struct FramePlaces {
  std::filesystem::path folder;  ///< an existing folder, for frame0001.png and so on
  std::filesystem::path film;
  double frames_per_second = 10;  ///< the speed of the film
};

/// Writes pictures one after another, as files and as a film.
class FrameFiles {
 public:
  explicit FrameFiles(FramePlaces places) : places_(std::move(places)) {}

  /// Adds a picture. Throws Error if it cannot be written. The first picture starts the film; the thread of
  /// that call has to live on for it.
  void add(const picture::Raster& picture);
  /// Skips a picture that cannot be drawn: no file gets its number, and the film continues without it.
  void leave_out() { ++count_; }
  /// Waits for the film. Throws Error if it failed.
  void finish();

 private:
  FramePlaces places_;
  std::unique_ptr<picture::Film> film_;
  std::size_t count_ = 0;
};

}  // namespace adamas::viewer
