#pragma once

#include <array>
#include <string>

#include "core/geometry/vec3.h"
#include "core/io/grid_file.h"

namespace adamas {

/// How far off, relative to its length, a parallel direction may be: headers state rotations in single
/// precision.
inline constexpr double kParallelAxes = 1e-4;

/// Where the axes of a file's array lie in space: `t` along axis a leads to origin + t * directions[a].
struct GridAxes {
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
};

/// Lays a grid out along x, y and z, where its nodes still are places along the array's axes: axes are
/// exchanged and reversed with the arrays, so that positions are right and nodes ascend. Throws Error with
/// `name` where the axes are not parallel to x, y and z, one to each.
void lay_out(const std::string& name, const GridAxes& axes, GridFile& file);

}  // namespace adamas
