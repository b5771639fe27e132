#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/lattice/diamond_type.h"

namespace adamas::isosurface {

/// Octants of a cube of 16^3 cells whose corner is a multiple of 16. They are mirror images of each other,
/// with the diagonal of each one's first split running from the cube's corner to its centre: seen from their
/// corner of the cube all eight are cut by bisection in the same way, as the cube from (0, 0, 0) to (8, 8, 8)
/// is. That way is worked out here once, and measured in all eight at a time: for the diamonds of scales 2
/// and 4.
class OctantStencils {
 public:
  static constexpr int kSide = 9;  ///< points
  static constexpr int kPoints = kSide * kSide * kSide;
  static constexpr int kOctants = 8;
  static constexpr int kCube = 17;      ///< points of the whole cube per axis
  static constexpr int kLeastBits = 1;  ///< the least scale is 2 to this

  /// `depth` is that of the lattice, which may be smaller than an octant.
  OctantStencils(int depth, const Vec3& spacing);

  /// A sample in a tetrahedron, and how the corners' values are interpolated there.
  struct Point {
    std::int32_t offset;  ///< in points, from the diamond's place
    std::array<float, 4> weights;
  };
  /// A tetrahedron as seen from its diamond. Its corners stand in this order: phase 0, along three edges of
  /// the cube from end to end of the split edge; phase 1, one end, the corner of the face, the other end, the
  /// cube's centre; phase 2, the ends, the face's centre, the cube's centre.
  struct Shape {
    std::array<std::int32_t, 4> corners;
    std::array<std::int32_t, 3> axes;  ///< along which the steps from corner to corner lead
    std::uint32_t first, last;         ///< the samples in it, in points()
    float diameter;                    ///< the square of its ratio to the scale's greatest error
  };
  struct SmallDiamond {
    std::int32_t place;
    int phase;
    std::uint32_t first, last;  ///< its tetrahedra, in shape_indices()
  };

  [[nodiscard]] const std::vector<SmallDiamond>& diamonds() const { return diamonds_; }
  [[nodiscard]] const std::vector<std::uint16_t>& shape_indices() const { return shape_indices_; }
  [[nodiscard]] const std::vector<Shape>& shapes() const { return shapes_; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// The number of octants in the lattice: 8, or 1 where it has the first one alone.
  [[nodiscard]] int octants() const { return octants_; }

  static constexpr std::int32_t place(LatticePoint p) { return p.i + kSide * (p.j + kSide * p.k); }

 private:
  void add_shapes(int scale_bits, const Vec3& spacing);
  /// Adds the points in the tetrahedron, without its corners.
  void add_points(const std::array<LatticePoint, 4>& corners, std::int32_t scale);
  void add_diamonds(int bits);

  std::vector<SmallDiamond> diamonds_;
  std::vector<std::uint16_t> shape_indices_;
  std::vector<Shape> shapes_;  ///< by scale, type, slot
  std::vector<Point> points_;
  int octants_;
};

}  // namespace adamas::isosurface
