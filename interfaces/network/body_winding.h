#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "interfaces/ownership/interface_table.h"

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
  static void add_second_order(Node& node, double weight, const Vec3& normal, const Vec3& offset);
  [[nodiscard]] static double far_angle(const Node& node, const Vec3& r);

  std::vector<Node> nodes_;
  std::vector<std::array<Vec3, 3>> corners_;  ///< in the order of the leaves
};

class InterfaceNetwork;

/// Generalized winding numbers of the bodies of a network (docs/method.md, Gaps): 1 in a body and 0 elsewhere
/// if the interfaces are closed; values between these if they have gaps.
class BodyWinding {
 public:
  /// `domain`: the box at whose faces the interfaces may end.
  BodyWinding(const InterfaceNetwork& network, const std::optional<Box3>& domain);

  struct Answer {
    BodyId body;        ///< the body with the greatest number, among those of the material with the greatest
                        ///< sum
    double number = 0;  ///< the sum over that material's bodies; near 1 if the answer is certain
  };
  [[nodiscard]] Answer at(const Vec3& p) const;
  /// Sets `numbers` to the winding number of each body.
  void numbers_at(const Vec3& p, IdVector<BodyId, double>& numbers) const;

 private:
  /// An edge on the domain's boundary or beyond, where an interface ends. The interface is continued from
  /// there away from the domain's centre.
  struct Strip {
    InterfaceId interface;
    Vec3 from, to;  ///< in the direction of the triangle's corners
  };
  void find_strips(const InterfaceNetwork& network, const Box3& domain);
  void find_offsets(const InterfaceNetwork& network, const std::optional<Box3>& domain);
  void sum_angles(const Vec3& p, IdVector<BodyId, double>& numbers) const;

  InterfaceTable table_;
  IdVector<InterfaceId, WindingTree> trees_;
  std::vector<Strip> strips_;
  Vec3 center_;                       ///< the centre of the domain
  IdVector<BodyId, double> offsets_;  ///< each body's part of the sphere at infinity
};

}  // namespace adamas::interfaces
