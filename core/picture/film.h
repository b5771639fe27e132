#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/picture/raster.h"

namespace adamas::picture {

/// The endings of films: .mp4 (H.264), .webm (VP9) and .gif.
const std::vector<const char*>& film_endings();
/// Whether a file's name ends like a film's.
bool is_film(const std::filesystem::path& path);
/// Requires the program ffmpeg, which makes films: throws Error, in the name of the film, where it is not on
/// PATH.
void require_film_maker(const std::filesystem::path& path);

/// A film that is made frame by frame by the program ffmpeg, which gets them through a pipe. It has its name
/// only when it is whole. The same frames give the same bytes by the same ffmpeg.
class Film {
 public:
  /// All frames have this size in pixels; a film's own sides are even. Throws Error for a name that is no
  /// film's, sides and rates that no film has, and where ffmpeg is not on PATH or cannot be started.
  Film(std::filesystem::path path, int width, int height, double frames_per_second);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Adds a frame, whose upper left corner is that of the film: missing parts are white, parts beyond the
  /// film are cut off. Opacity is ignored. Throws Error with ffmpeg's message where ffmpeg has ended.
  void add(const Raster& frame);
  /// Waits for the film, reads it again and gives it its name. Throws Error where there was no frame, ffmpeg
  /// failed or said anything, and where the film has not all frames, as on a full disk.
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace adamas::picture
