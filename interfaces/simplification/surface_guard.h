#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/box_tree.h"
#include "interfaces/simplification/near_field.h"

namespace adamas::interfaces {

/// A change of triangles that lie together: some go, some get other corners, or a point moves. Triangles and
/// points are numbered as in the mesh that is simplified.
struct SurfaceChange {
  struct Face {
    std::uint32_t face;
    std::array<std::uint32_t, 3> corners;
  };
  struct Move {
    std::uint32_t point;
    Vec3 to;
  };
  std::vector<std::uint32_t> old_faces;  ///< those that go or change
  std::vector<Face> faces;               ///< those that stay, as they will be
  std::optional<std::uint32_t> dropped;  ///< a point that goes
  std::optional<Move> move;
  /// An edge that replaces edges of a line: it may lie in a side of the domain.
  std::optional<std::array<std::uint32_t, 2>> line;
  /// Triangles may have angles below this, in degrees, only where they replace such triangles: with a
  /// smallest angle no less, or fewer of them.
  double least_angle = 0;
  /// Every angle has to be at least that, whatever was there; in degrees.
  double angle_above = 0;
};

/// Watches over an interface network while its triangles are changed: it stays near the original one, with no
/// triangles in contact that were not before, none that has passed through another or turned over, and none
/// in a side of the domain. For one thread.
class SurfaceGuard {
 public:
  struct Options {
    double limit = 0;  ///< greatest distance from the original interfaces
    Box3 domain;
  };

  /// The network as it is: for each triangle its corners, its interface, and its patch, within which edges
  /// are shared by right. `fields`: of the original interfaces; they must outlive this object.
  SurfaceGuard(std::vector<Vec3> points, std::vector<ClosestPointTree::Triangle> triangles,
               std::vector<std::uint32_t> interfaces, std::vector<std::uint32_t> patches,
               std::vector<NearField>& fields, const Options& options);

  /// Of each point, the part of the limit that holds round it; 1 for all at first.
  void set_limit_parts(std::vector<double> parts) { limit_parts_ = std::move(parts); }

  [[nodiscard]] bool allows(const SurfaceChange& change);
  /// Has to be a change that was allowed right before.
  void apply(const SurfaceChange& change);

  [[nodiscard]] const Vec3& point(std::uint32_t p) const { return points_[p]; }
  /// Bits of the sides of the domain that a point lies on.
  [[nodiscard]] unsigned sides(std::uint32_t p) const { return sides_[p]; }
  /// Smallest angle of triangles as they are, in degrees.
  [[nodiscard]] double smallest_angle(std::span<const std::uint32_t> faces) const;
  [[nodiscard]] double limit() const { return options_.limit; }
  /// The limit round all corners of these triangles.
  [[nodiscard]] double limit_at(std::span<const std::uint32_t> faces) const;
  /// The place a point had in the beginning.
  [[nodiscard]] const Vec3& original(std::uint32_t p) const { return originals_[p]; }

 private:
  using Corners = std::array<Vec3, 3>;
  struct Shapes;
  [[nodiscard]] Vec3 place(std::uint32_t p, const SurfaceChange& change) const {
    return change.move && change.move->point == p ? change.move->to : points_[p];
  }
  void cover_edges();
  [[nodiscard]] Corners corners_after(const SurfaceChange::Face& face, const SurfaceChange& change) const;
  [[nodiscard]] Corners corners_now(std::uint32_t face) const;
  [[nodiscard]] bool shapes_allowed(const SurfaceChange& change) const;
  [[nodiscard]] bool turned_over(const SurfaceChange& change) const;
  [[nodiscard]] bool leaves_domain_sides(const SurfaceChange& change) const;
  [[nodiscard]] bool near_original(const SurfaceChange& change, double limit);
  [[nodiscard]] bool original_near(const SurfaceChange& change, double limit);
  [[nodiscard]] bool free_of_contact(const SurfaceChange& change) const;
  [[nodiscard]] bool passes_nothing(const SurfaceChange& change) const;
  [[nodiscard]] bool is_old_edge(const SurfaceChange& change, std::uint32_t patch, std::uint32_t a,
                                 std::uint32_t b) const;
  [[nodiscard]] bool clear_of(const SurfaceChange& change, const SurfaceChange::Face& face,
                              std::uint32_t other) const;

  Options options_;
  std::vector<Vec3> points_;
  std::vector<Vec3> originals_;  ///< the points in the beginning, and then others of the original surface
  std::vector<ClosestPointTree::Triangle> faces_;
  std::vector<std::uint32_t> interfaces_, patches_;
  std::vector<NearField>& fields_;  ///< by interface
  std::vector<double> limit_parts_;
  std::vector<unsigned char> sides_;
  std::vector<char> moved_;
  BoxTree boxes_;
  /// Points of the original that each triangle is near, beside its corners: the surface may not leave them.
  std::vector<std::vector<std::uint32_t>> covered_;
  std::vector<std::vector<std::uint32_t>> covered_after_;  ///< by the last change that was allowed
};

/// Smallest angle of a triangle in degrees; 0 without area.
double smallest_angle(const std::array<Vec3, 3>& corners);

}  // namespace adamas::interfaces
