#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/picture/raster.h"

namespace adamas::picture {

/// The extensions of films: .mp4 (H.264), .webm (VP9) and .gif.
const std::vector<const char*>& film_endings();
/// Whether a file has the extension of a film.
bool is_film(const std::filesystem::path& path);
/// Throws Error, which names the film, unless ffmpeg, the program that makes films, is on PATH.
void require_film_maker(const std::filesystem::path& path);

/// A film that is made frame by frame by the program ffmpeg, which receives frames through a pipe. It gets
/// its name only when it is complete. The same frames give the same bytes with the same ffmpeg.
class Film {
 public:
  /// All frames have this size in pixels; a film's own sides are rounded to even numbers. Throws Error for a
  /// name without the extension of a film, for sides and rates that a film cannot have, and if ffmpeg is not
  /// on PATH or cannot be started.
  Film(std::filesystem::path path, int width, int height, double frames_per_second);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Adds a frame at the upper left corner of the film: missing parts are white, parts outside the film are
  /// cut off. Opacity is ignored. Throws Error with ffmpeg's message if ffmpeg has ended.
  void add(const Raster& frame);
  /// Waits for the film, reads it again and gives it its name. Throws Error if there was no frame, if ffmpeg
  /// failed or printed anything, and if the film does not contain all frames, as on a full disk.
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace adamas::picture
