#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/network/box_tree.h"
#include "interfaces/simplification/near_field.h"

namespace adamas::interfaces {

/// A change of adjacent triangles: some are removed, some get other corners, or a point moves. Triangles and
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
  std::vector<std::uint32_t> old_faces;  ///< the triangles that are removed or change
  std::vector<Face> faces;               ///< the triangles that stay, after the change
  std::optional<std::uint32_t> dropped;  ///< a point that is removed
  std::optional<Move> move;
  /// An edge that replaces edges of a line: it may lie in a side of the domain.
  std::optional<std::array<std::uint32_t, 2>> line;
  /// Triangles may have angles below this, in degrees, only if they replace such triangles and are fewer or
  /// have no smaller angle.
  double least_angle = 0;
  /// The least angle, in degrees, of all triangles after the change, regardless of earlier angles.
  double angle_above = 0;
};

/// Checks changes of an interface network's triangles: the network stays near the original one, no further
/// triangles come in contact, and no triangle passes through another, turns over or lies in a side of the
/// domain. It must be used by one thread only.
class SurfaceGuard {
 public:
  struct Options {
    double limit = 0;  ///< the greatest distance from the original interfaces
    Box3 domain;
  };

  /// Starts with the present network: for each triangle its corners, its interface and its patch; triangles
  /// of one patch may share edges. `fields`: the near fields of the original interfaces; they must outlive
  /// this object.
  SurfaceGuard(std::vector<Vec3> points, std::vector<ClosestPointTree::Triangle> triangles,
               std::vector<std::uint32_t> interfaces, std::vector<std::uint32_t> patches,
               std::vector<NearField>& fields, const Options& options);

  /// Sets for each point the part of the limit that holds round it; at first it is 1 for all.
  void set_limit_parts(std::vector<double> parts) { limit_parts_ = std::move(parts); }

  [[nodiscard]] bool allows(const SurfaceChange& change);
  /// Makes the change that allows() has allowed last.
  void apply(const SurfaceChange& change);

  [[nodiscard]] const Vec3& point(std::uint32_t p) const { return points_[p]; }
  /// Returns the sides of the domain on which a point lies, as bits.
  [[nodiscard]] unsigned sides(std::uint32_t p) const { return sides_[p]; }
  /// Returns the smallest angle of the present triangles, in degrees.
  [[nodiscard]] double smallest_angle(std::span<const std::uint32_t> faces) const;
  [[nodiscard]] double limit() const { return options_.limit; }
  /// Returns the limit that holds round all corners of these triangles.
  [[nodiscard]] double limit_at(std::span<const std::uint32_t> faces) const;
  /// Returns the original place of a point.
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
  [[nodiscard]] bool turns_over(const SurfaceChange& change) const;
  [[nodiscard]] bool stays_off_domain_sides(const SurfaceChange& change) const;
  [[nodiscard]] bool stays_near_original(const SurfaceChange& change, double limit);
  [[nodiscard]] bool original_stays_near(const SurfaceChange& change, double limit);
  [[nodiscard]] bool free_of_contact(const SurfaceChange& change) const;
  [[nodiscard]] bool passes_through_no_triangle(const SurfaceChange& change) const;
  [[nodiscard]] bool is_old_edge(const SurfaceChange& change, std::uint32_t patch, std::uint32_t a,
                                 std::uint32_t b) const;
  [[nodiscard]] bool has_no_contact(const SurfaceChange& change, const SurfaceChange::Face& face,
                                    std::uint32_t other) const;

  Options options_;
  std::vector<Vec3> points_;
  std::vector<Vec3> originals_;  ///< the original points, followed by other points of the original surface
  std::vector<ClosestPointTree::Triangle> faces_;
  std::vector<std::uint32_t> interfaces_, patches_;
  std::vector<NearField>& fields_;  ///< by interface
  std::vector<double> limit_parts_;
  std::vector<unsigned char> sides_;
  std::vector<char> moved_;
  BoxTree boxes_;
  /// By triangle: the points of the original surface, other than its corners, to which the triangle must stay
  /// close.
  std::vector<std::vector<std::uint32_t>> covered_;
  /// The covered points of each triangle after the change that was allowed last.
  std::vector<std::vector<std::uint32_t>> covered_after_;
};

/// Returns the smallest angle of a triangle in degrees; 0 for one without area.
double smallest_angle(const std::array<Vec3, 3>& corners);

}  // namespace adamas::interfaces
