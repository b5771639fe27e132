#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::io {

/// Points and polygons of any size.
struct PolygonSoup {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> corners;
  std::vector<std::size_t> offsets{0};  ///< polygon p has the corners [offsets[p], offsets[p + 1])
};

/// Reads .obj, .off, .ply or .stl in a child process. Throws Error at what is not a complete file of its
/// kind, at points that are not finite and at indices out of range.
PolygonSoup read_polygon_soup(const std::filesystem::path& path);

/// Divides a polygon into triangles by ear clipping in the plane of its mean normal. Returns the corners'
/// indices, in the polygon's orientation. A polygon that is not simple gets a fan.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<Vec3>& points,
                                                              const std::uint32_t* corners,
                                                              std::size_t count);

}  // namespace adamas::io
