#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// Returns the solid angle, in (-2 pi, 2 pi], of the spherical triangle whose corners lie in the given
/// directions (van Oosterom and Strackee 1983). It is positive if they turn clockwise as seen from the
/// centre, so that a surface's triangles are positive as seen from behind. Lengths do not matter.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// Computes the solid angle of a set of triangles (generalized winding numbers, Jacobson, Kavan and
/// Sorkine-Hornung 2013). Far parts are approximated by the first three terms of their expansion (Barill et
/// al. 2018), near ones are summed triangle by triangle.
class WindingTree {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  WindingTree() = default;
  /// Points must be finite, indices within range.
  WindingTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  /// Returns the solid angle relative to the whole sphere, within about 0.01 of the exact sum. For a closed
  /// surface with outward normals it is 1 inside and 0 outside.
  [[nodiscard]] double at(const Vec3& p) const;

 private:
  struct Node {
    Vec3 center;        ///< the centre of the triangles, weighted by area
    double radius = 0;  ///< the radius of a ball round the centre that holds the triangles
    Vec3 normal;        ///< the sum of the triangles' normals, whose lengths are the areas
    /// Row i: the i-th component of those normals times the offsets from the centre.
    std::array<Vec3, 3> moments;
    /// Two sums over normals n and offsets d, averaged over each triangle: 2 d (d . n) + n (d . d), and the
    /// coefficients of (n . r) (d . r)^2 for xxx, yyy, zzz, xxy, xxz, xyy, yyz, xzz, yzz and xyz.
    Vec3 second;
    std::array<double, 10> cubic{};
    std::uint32_t first, count;  ///< the triangles of a leaf; another node has the children first and first +
                                 ///< 1, and count 0
  };
  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
  void summarize(Node& node, std::uint32_t begin, std::uint32_t end) const;
  static void add_second(Node& node, double weight, const Vec3& normal, const Vec3& offset);
  [[nodiscard]] static double far_angle(const Node& node, const Vec3& r);

  std::vector<Node> nodes_;
  std::vector<std::array<Vec3, 3>> corners_;  ///< in the order of the leaves
};

}  // namespace adamas::interfaces
