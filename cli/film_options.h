#pragma once

#include <optional>
#include <string>

#include "adamas/resample_series.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options of a film of the meshes of a series.
struct FilmOptions {
  std::string file;  ///< empty where none is wanted
  std::optional<Plane> plane;
  std::string show;  ///< the field; empty: the materials
  std::optional<double> frame_rate;

  /// The options as the library takes them. Throws Error (kUsage) for a rate without a film.
  [[nodiscard]] SeriesFilmOptions to_library() const;
};
void add_film_options(const Command& command, FilmOptions& options);

}  // namespace adamas::cli
