#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::interfaces {

/// Decides whether whole triangles are near a surface. It stores closest points, so that queries near earlier
/// ones are fast. It must be used by one thread only.
class NearField {
 public:
  /// `reach`: the greatest limit of queries. The tree must outlive this object.
  NearField(const ClosestPointTree& tree, double reach);

  /// Returns whether no point of the triangle, which may be without area, is farther from the surface than
  /// `limit`. It is true only if this is proved for pieces of the triangle, by the distance of their centre
  /// or by the distances of their corners from one triangle of the surface, as that distance is a convex
  /// function.
  [[nodiscard]] bool within(const std::array<Vec3, 3>& corners, double limit);

 private:
  /// The closest point of the surface from the centre of a cube.
  struct Seen {
    std::uint64_t cube = kNoCube;
    double distance = 0;
    std::uint32_t triangle = 0;
  };
  static constexpr std::uint64_t kNoCube = ~std::uint64_t{0};
  struct Piece {
    std::array<Vec3, 3> corners;
  };
  enum class Verdict { kNear, kFar, kOpen };

  [[nodiscard]] const Seen& seen_from(const Vec3& p, Vec3& center);
  [[nodiscard]] std::size_t slot_of(std::uint64_t cube) const;
  void grow();
  [[nodiscard]] Verdict judge(const Piece& piece, double limit, std::uint32_t& triangle);
  [[nodiscard]] bool cut(const Piece& piece, const std::array<Vec3, 3>& triangle);
  void halve(const Piece& piece);
  [[nodiscard]] bool near_triangle(const Piece& piece, std::uint32_t triangle, double limit) const;

  const ClosestPointTree& tree_;
  double reach_, cell_;
  Vec3 origin_;
  std::vector<Seen> cubes_;  ///< a hash table with linear probing; its size is a power of two, and it is at
                             ///< most half full
  std::size_t cube_count_ = 0;
  std::vector<Piece> open_;
};

}  // namespace adamas::interfaces
