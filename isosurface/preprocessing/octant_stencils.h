#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/lattice/diamond_type.h"

namespace adamas::isosurface {

/// Octants of a cube of 16^3 cells whose corner is a multiple of 16. They are mirror images of each other,
/// with the diagonal of each one's first split running from the cube's corner to its centre: seen from their
/// corner of the cube all eight are bisected in the same way, that of the cube from (0, 0, 0) to (8, 8, 8).
/// This way is computed here once, for the diamonds of scales 2 and 4, and errors are measured in all eight
/// octants at a time.
class OctantStencils {
 public:
  static constexpr int kSide = 9;  ///< number of points
  static constexpr int kPoints = kSide * kSide * kSide;
  static constexpr int kOctants = 8;
  static constexpr int kCube = 17;      ///< number of points of the whole cube per axis
  static constexpr int kLeastBits = 1;  ///< the least scale is 2 to this power

  /// Computes the stencils. `depth` is that of the lattice, which may be smaller than an octant.
  OctantStencils(int depth, const Vec3& spacing);

  /// A sample in a tetrahedron, and the weights of the corners' values in the interpolation there.
  struct Point {
    std::int32_t offset;  ///< offset in points from the diamond's place
    std::array<float, 4> weights;
  };
  /// A tetrahedron as seen from its diamond. Its corners are in this order: phase 0, along three edges of the
  /// cube from one end of the split edge to the other; phase 1, one end, the corner of the face, the other
  /// end, the cube's centre; phase 2, the ends, the face's centre, the cube's centre.
  struct Shape {
    std::array<std::int32_t, 4> corners;
    std::array<std::int32_t, 3> axes;  ///< axes of the steps from corner to corner
    std::uint32_t first, last;         ///< range of its samples in points()
    float diameter;                    ///< squared ratio of the diameter to the scale's greatest error
  };
  struct SmallDiamond {
    std::int32_t place;
    int phase;
    std::uint32_t first, last;  ///< range of its tetrahedra in shape_indices()
  };

  [[nodiscard]] const std::vector<SmallDiamond>& diamonds() const { return diamonds_; }
  [[nodiscard]] const std::vector<std::uint16_t>& shape_indices() const { return shape_indices_; }
  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// Returns the number of octants in the lattice: 8, or 1 if it has only the first one.
  [[nodiscard]] int octants() const { return octants_; }

  static constexpr std::int32_t place(LatticePoint p) { return p.i + kSide * (p.j + kSide * p.k); }

 private:
  void add_shapes(int scale_bits, const Vec3& spacing);
  /// Adds the points in the tetrahedron, without its corners.
  void add_points(const std::array<LatticePoint, 4>& corners, std::int32_t scale);
  void add_diamonds(int bits);

  std::vector<SmallDiamond> diamonds_;
  std::vector<std::uint16_t> shape_indices_;
  std::vector<Shape> shapes_;  ///< indexed by scale, type, slot
  std::vector<Point> points_;
  int octants_;
};

}  // namespace adamas::isosurface
