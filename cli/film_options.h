#pragma once

#include <string>

#include "adamas/resample_series.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options of a film of the meshes of a series.
struct FilmOptions {
  std::string file;               ///< the file; empty: there is no film
  std::string plane, frame_rate;  ///< texts, since they are first checked for having an effect
  std::string show;               ///< the field; empty: the materials

  /// Returns the options of the library. Throws Error (kUsage) for a rate without a film, and for invalid
  /// values.
  [[nodiscard]] SeriesFilmOptions to_library() const;
};
void add_film_options(const Command& command, FilmOptions& options);

}  // namespace adamas::cli
