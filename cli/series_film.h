#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "workflow/slices/slice_panels.h"
#include "workflow/slices/slice_scale.h"

namespace adamas::cli {

/// The film of a slice of the meshes of a series, which are cut as they are made.
class SeriesFilm {
 public:
  /// `show`: the field, or empty for the materials. `name`: of the series. Throws Error where there is no
  /// ffmpeg.
  SeriesFilm(const std::filesystem::path& file, const Plane& plane, const std::string& show,
             std::string name);

  /// Cuts the mesh of the next step. Throws Error where the plane does not cut it or there is no such field.
  void add(double time, interfaces::ResampledMesh& mesh);
  /// Draws all steps with one scale of colours.
  void write(const std::filesystem::path& path, double frames_per_second, Progress& progress);

 private:
  workflow::SliceStyle style_;
  std::string name_;
  workflow::SliceScale scale_;
  std::vector<double> times_;
  std::vector<picture::SlicePicture> pictures_;
};

/// The options that ask for such a film.
struct SeriesFilmText {
  std::string file, plane, show, frame_rate;

  /// Throws Error (kUsage), also for options without effect.
  void check() const;
  [[nodiscard]] double rate() const;
};
void add_film_options(const Command& command, SeriesFilmText& text);

}  // namespace adamas::cli
