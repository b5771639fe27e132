#pragma once

#include <string>

#include "adamas/picture.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options of a picture of surfaces in space: its file, the camera, and the interfaces that it shows.
struct PictureOptions {
  std::string file;       ///< the file; empty: there is no picture
  bool own_file = true;   ///< whether the option `--picture` names the file
  bool has_size = false;  ///< whether a size was given
  DrawingOptions drawing;

  /// Throws Error (kUsage) for invalid values, and for options of a picture where there is none.
  void check() const;
};

/// Adds the options of a picture. `subject`: what the picture shows, for the help text. Without `own_file`
/// the program chooses the files.
void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file = true);

/// Adds the options of a picture of interfaces. Without `own_file` the program chooses the files.
void add_surface_picture_options(const Command& command, PictureOptions& options, bool own_file = true);

}  // namespace adamas::cli
