#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/resample_series.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "workflow/slices/slice_panels.h"
#include "workflow/slices/slice_scale.h"

namespace adamas::workflow {

/// Throws Error (kUsage) for a file that is no film, where there is no plane for it, and for options without
/// a file.
void check_film(const SeriesFilmOptions& options);

/// A film of slices of the meshes of a series, which are cut as they are made.
class SeriesFilm {
 public:
  /// Prepares the film. `name`: the name of the series. Throws Error where there is no ffmpeg.
  SeriesFilm(const SeriesFilmOptions& options, std::string name);

  /// Cuts the mesh of the next step. Throws Error where the plane does not cut it or there is no such field.
  /// `colours`: those that materials have.
  void add(double time, interfaces::ResampledMesh& mesh, const MaterialColours& colours);
  /// Draws all steps with one scale of colours.
  void write(const std::filesystem::path& path, Progress& progress);

 private:
  SliceStyle style_;
  double frames_per_second_;
  std::string name_;
  SliceScale scale_;
  std::vector<double> times_;
  std::vector<picture::SlicePicture> pictures_;
};

}  // namespace adamas::workflow
