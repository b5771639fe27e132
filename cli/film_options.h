#pragma once

#include <string>

#include "adamas/resample_series.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options of a film of the meshes of a series.
struct FilmOptions {
  std::string file;               ///< empty where none is wanted
  std::string plane, frame_rate;  ///< as text, since they are first checked for having an effect
  std::string show;               ///< the field; empty: the materials

  /// The options as the library takes them. Throws Error (kUsage) for a rate without a film, and for values
  /// that are none.
  [[nodiscard]] SeriesFilmOptions to_library() const;
};
void add_film_options(const Command& command, FilmOptions& options);

}  // namespace adamas::cli
