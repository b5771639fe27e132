#pragma once

#include <string>

#include "adamas/picture.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options of a picture of surfaces in space: its file, the camera, and which interfaces it shows.
struct PictureOptions {
  std::string file;       ///< empty where none is wanted
  bool own_file = true;   ///< whether the option `--picture` names the file
  bool has_size = false;  ///< whether a size was given
  DrawingOptions drawing;

  /// Throws Error (kUsage) for values that say nothing, and where there is no picture for them.
  void check() const;
};

/// `subject`: what the picture shows, for the help text. Without `own_file` the program chooses the files.
void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file = true);

/// The options of a picture of interfaces. Without `own_file` the program chooses the files.
void add_surface_picture_options(const Command& command, PictureOptions& options, bool own_file = true);

}  // namespace adamas::cli
