#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"

namespace adamas::interfaces {

/// Interfaces and the sides of a box as triangles on shared points, which divide the box into bodies: what
/// mesh generators take (docs/method.md, Reference meshes).
struct PiecewiseLinearComplex {
  /// Triangles with the same body on either side, on one side of the box or on none.
  struct Patch {
    BodyId front;  ///< where normals point to; invalid outside of the box
    BodyId back;
    int box_side = -1;  ///< 2 axis + (0: least, 1: greatest coordinate); -1: an interface
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

  /// Throws Error, naming the source, where a body's boundary is not closed: at every edge it has to go one
  /// way as often as the other.
  void check_closed() const;
  /// Volume inside the boundary of each of so many bodies.
  [[nodiscard]] IdVector<BodyId, double> enclosed_volumes(std::size_t bodies) const;
};

}  // namespace adamas::interfaces
