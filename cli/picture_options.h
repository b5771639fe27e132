#pragma once

#include <string>

#include "cli/command.h"
#include "core/picture/interface_picture.h"

namespace adamas {

/// The options of a picture of surfaces in space: its file, and the camera.
struct PictureOptions {
  std::string file;      ///< empty where none is wanted
  bool own_file = true;  ///< whether the option `--picture` names the file
  std::string direction = "-0.62,0.72,-0.42", projection = "perspective", focus, size;

  /// Gives a picture its camera. Throws UsageError.
  void aim(InterfacePicture& picture) const;
  /// Width and height. Throws UsageError.
  [[nodiscard]] InterfacePictureOptions sizes() const;
  /// Throws UsageError for values that say nothing, and where there is no picture for them.
  void check() const;
};

/// `subject`: what the picture shows, for the help text. Without `own_file` the program chooses the files.
void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file = true);

}  // namespace adamas
