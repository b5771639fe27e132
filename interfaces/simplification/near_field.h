#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/geometry/vec3.h"
#include "interfaces/network/closest_point_tree.h"

namespace adamas {

/// Tells whether whole triangles are near a surface. What is known of the surface round a point is kept, so
/// that neighbouring questions cost little. For one thread.
class NearField {
 public:
  /// `reach`: the greatest limit that is asked for. The tree must outlive this object.
  NearField(const ClosestPointTree& tree, double reach);

  /// Whether no point of the triangle, which may be without area, is farther from the surface than `limit`:
  /// true only where that is proved, for pieces of it by the distance of their centre or by that of their
  /// corners from one triangle, to which distances are convex.
  [[nodiscard]] bool within(const std::array<Vec3, 3>& corners, double limit);

 private:
  /// The surface as seen from the centre of a cube.
  struct Seen {
    double distance;
    std::uint32_t triangle;
  };
  struct Piece {
    std::array<Vec3, 3> corners;
  };
  enum class Verdict { kNear, kFar, kOpen };

  [[nodiscard]] const Seen& seen_from(const Vec3& p, Vec3& center);
  [[nodiscard]] Verdict judge(const Piece& piece, double limit);
  [[nodiscard]] bool near_triangle(const Piece& piece, std::uint32_t triangle, double limit) const;

  const ClosestPointTree& tree_;
  double reach_, cell_;
  Vec3 origin_;
  std::unordered_map<std::uint64_t, Seen> cells_;
  std::vector<Piece> open_;
};

}  // namespace adamas
