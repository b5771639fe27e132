#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "adamas/meshes.h"

namespace adamas::io {

/// What the header of a .ply tells that write_surface writes: binary, little endian.
struct SurfacePly {
  std::size_t points = 0, triangles = 0;
  bool single = true;                       ///< whether coordinates are floats; otherwise they are doubles
  bool normals = false;                     ///< whether points have normals, as floats
  std::optional<std::string> value_name{};  ///< the name of the points' values, as floats; none: no values

  /// The number of bytes of a point.
  [[nodiscard]] std::size_t point_bytes() const;
  [[nodiscard]] std::string header() const;
};

/// Returns whether a .ply begins with such a header. False if the file does not exist.
bool is_surface_ply(const std::filesystem::path& path);

/// Reads such a surface from the bytes of a file; `name` is the file's name, for messages. Throws Error for
/// other contents, truncated files and indices out of range.
TriangleSurface parse_surface_ply(const std::string& bytes, const std::string& name);

}  // namespace adamas::io
