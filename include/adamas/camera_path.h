#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

/// The path of a camera that goes once round the data, with z upwards, as near as all of the data is in
/// sight.
struct Orbit {
  int frames = 36;  ///< number of viewpoints, 1 to 100,000
  bool operator==(const Orbit&) const = default;
};

/// The viewpoints of pictures, one after the other: an orbit; or a text file with a viewpoint on each line:
/// the coordinates of the eye, of the target and of the upward direction, nine numbers between commas or
/// spaces. Text after # is a comment.
using CameraPath = std::variant<Orbit, std::filesystem::path>;

/// Reads "orbit:N", or the name of a file. Throws Error where N is no number of frames.
CameraPath parse_camera_path(const std::string& text);

/// The place of a camera: its eye, the point in the middle of its picture, and the direction that is upwards
/// in it, which is not along the line of sight.
struct CameraPlace {
  Vec3 eye, target, up{0, 0, 1};
  bool operator==(const CameraPlace&) const = default;
};

/// Reads nine numbers, as in a line of such a file. Throws Error (kUsage), which begins with `name`, where
/// the text is something else, or no camera can be there.
CameraPlace parse_camera_place(const std::string& name, const std::string& text);

}  // namespace adamas
