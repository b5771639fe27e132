#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"

namespace adamas::interfaces {

/// Interfaces and the sides of a box as triangles on shared points, which divide the box into bodies. This is
/// the input of mesh generators (docs/method.md, Reference meshes).
struct PiecewiseLinearComplex {
  /// A set of triangles with the same bodies on their two sides, all on one side of the box or on none.
  struct Patch {
    BodyId front;  ///< the body to which normals point; invalid outside the box
    BodyId back;
    int box_side = -1;  ///< 2 axis + (0: least, 1: greatest coordinate); -1 for an interface
    auto operator<=>(const Patch&) const = default;
  };
  struct Triangle {
    std::array<std::uint32_t, 3> points;
    std::uint32_t patch;
  };

  std::string source;  ///< for messages
  Box3 box;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Patch> patches;

  /// Throws Error that names the source if a body's boundary is not closed: its triangles must run along
  /// every edge equally often in both directions.
  void check_closed() const;
};

}  // namespace adamas::interfaces
