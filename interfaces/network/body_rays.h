#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/vec3.h"

namespace adamas::interfaces {

/// Finds which connected parts of a region's boundary see each other through the region. A *side* is twice
/// the number of a triangle, plus 1 for its back.
class BodyRays {
 public:
  static constexpr std::uint32_t kInfinity = 0xffffffffu;
  struct Result {
    std::vector<std::uint32_t>
        seen;                      ///< sides of the same material, or kInfinity: what all see that reach it
    std::size_t inconsistent = 0;  ///< rays that arrived at a side of another material
  };

  /// The arguments must outlive this object; `domain` may be null.
  BodyRays(const InterfaceMesh& mesh, const ClosestPointTree& tree, const Box3* domain)
      : mesh_(mesh), tree_(tree), domain_(domain) {}
  /// Sends rays from a part, given by its sides.
  [[nodiscard]] Result shoot(const std::vector<std::uint32_t>& part) const;

 private:
  [[nodiscard]] MaterialId material(std::uint32_t side) const {
    const InterfaceTriangle& t = mesh_.triangles[side / 2];
    return side % 2 == 0 ? t.front : t.back;
  }
  [[nodiscard]] Vec3 normal(std::uint32_t side) const;
  [[nodiscard]] Vec3 corner(std::uint32_t side, std::size_t i) const {
    return mesh_.points[mesh_.triangles[side / 2].points[i]];
  }
  [[nodiscard]] bool flat(std::uint32_t side) const {
    return is_flat({corner(side, 0), corner(side, 1), corner(side, 2)});
  }
  void shoot_from_extremes(const std::vector<std::uint32_t>& part, Result& result) const;
  /// Follows a ray from a side; where it leaves the domain, on along the domain's walls to the greatest
  /// corner, which counts as infinity.
  void follow(std::uint32_t side, Vec3 origin, Vec3 direction, Result& result) const;
  void arrive(std::uint32_t side, const Vec3& direction, const RayHit& hit, Result& result) const;

  const InterfaceMesh& mesh_;
  const ClosestPointTree& tree_;
  const Box3* domain_;
};

}  // namespace adamas::interfaces
