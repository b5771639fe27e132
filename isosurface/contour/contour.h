#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/geometry/tetrahedron_contour.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "core/lattice/lattice_point.h"
#include "core/lattice/point_numbers.h"

namespace adamas::isosurface {

/// A point where a contour crosses an edge of the mesh.
struct EdgePoint {
  LatticePoint first, second;  ///< the ends, in ascending order
  double parameter;            ///< 0 at the first end, 1 at the second

  [[nodiscard]] LatticePoint nearer_end() const { return parameter < 0.5 ? first : second; }
  /// Returns the greatest power of two that divides the edge: the spacing of the finest samples at the ends
  /// of such edges.
  [[nodiscard]] std::int32_t step() const {
    const LatticePoint way = second - first;
    const std::int32_t bits = way.i | way.j | way.k;
    return bits & -bits;
  }
  bool operator==(const EdgePoint&) const = default;
};

/// The common place of joined points on edges of one vertex. The vertices at the other ends of these edges
/// are at least `step` lattice units away from it along some axis.
struct VertexPoint {
  LatticePoint vertex;
  std::int32_t step;

  bool operator==(const VertexPoint&) const = default;
};

/// A point where the border of the data cuts a contour inside a tetrahedron, as a mean of vertices whose
/// edges are `step` lattice units long along some axis. A vertex of weight 0 may be any point.
struct MeanPoint {
  std::array<LatticePoint, 4> vertices{};
  std::array<double, 4> weights{};  ///< weights with the sum 1
  std::int32_t step = 0;

  bool operator==(const MeanPoint&) const = default;
};

/// A triangle surface with shared points: every edge inside the data belongs to two triangles, which run
/// along it in opposite directions.
struct Contour {
  std::vector<Vec3> points;                             ///< points of all three kinds, in space
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals point to values below the isovalue
  std::vector<EdgePoint> edge_points;                   ///< the edges of the first points, in the same order
  std::vector<VertexPoint> vertex_points;               ///< the vertices of the points after these
  std::vector<MeanPoint> mean_points;                   ///< the means of the last points

  bool operator==(const Contour&) const = default;
};

/// Returns the parameter of the isovalue between two finite values, one of them below it and one not.
inline double edge_parameter(double first, double second, double isovalue) {
  // Differences of halves cannot overflow; those of small values lose no bits.
  const double scale = std::max(std::abs(first), std::abs(second)) > 1 ? 0.5 : 1;
  return (scale * isovalue - scale * first) / (scale * second - scale * first);
}

/// Removes the points that no triangle has; the others keep their order.
void remove_unused_points(Contour& contour);

struct ContourOptions {
  /// Parameters of edge points are kept in [least_parameter, 1 - least_parameter]. With 0 the triangles at
  /// samples equal to the isovalue have no area; with more, all have one, except some that clipping makes. It
  /// is less than 1/2.
  double least_parameter = 0;
  /// The lattice point of the data's last sample, if the domain is larger than the data: the contour is
  /// clipped to the box from the origin to it.
  std::optional<LatticePoint> last_sample;
  /// The spacing of samples in space; see clip_contour.
  Vec3 spacing{};
  /// Whether the points next to a vertex of the mesh are joined (join_points).
  bool join = false;
};

/// Returns whether the tetrahedron has at most a face in the data's box.
bool is_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample);
/// Returns whether a part of the tetrahedron lies beyond the data's box.
inline bool reaches_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample) {
  return std::ranges::any_of(vertices, [&](LatticePoint p) {
    return p.i > last_sample.i || p.j > last_sample.j || p.k > last_sample.k;
  });
}

/// Returns the point at parameter t from a to b. Rounding never puts it beyond them; a coordinate that they
/// share stays.
inline Vec3 point_between(const Vec3& a, const Vec3& b, double t) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = a[axis], q = b[axis];
    result[axis] = std::clamp(p + t * (q - p), std::min(p, q), std::max(p, q));
  }
  return result;
}

/// Builds a contour triangle by triangle. Points are numbered in the order of their first use.
class ContourBuilder {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;  ///< the number of no point

  ContourBuilder(const Domain& domain, double isovalue, const ContourOptions& options);

  /// Returns the number of the point on an edge of the mesh between two finite values, one of them below the
  /// isovalue and one not. Throws Error where the surface has more points than 32 bits can number.
  std::uint32_t edge_point(LatticePoint a, LatticePoint b, double value_a, double value_b);
  /// Returns the number of a point on an edge of the mesh, which lies at `position` in space.
  std::uint32_t edge_point(const EdgePoint& point, const Vec3& position);
  /// Adds a triangle by the numbers of its points.
  void add_triangle(const std::array<std::uint32_t, 3>& points) { contour_.triangles.push_back(points); }
  /// Reserves memory for about so many triangles.
  void reserve(std::size_t triangles);
  /// Appends the contours of other builders, one after another, as if their triangles had been added here:
  /// points that are here already keep their numbers. The others must not be used after this.
  void append(std::span<const std::unique_ptr<ContourBuilder>> others);
  /// Returns the contour, clipped to the data's box. The builder must not be used after this.
  [[nodiscard]] Contour finish();

 private:
  /// Appends one contour. `numbers`: the numbers of its points in this contour, kNone where they are new.
  void append(const Contour& other, std::vector<std::uint32_t>& numbers);
  /// Returns the entry for the number of the point on an edge, and whether it is new.
  auto number_of_edge(LatticePoint first, LatticePoint second) {
    // No two edges of a mesh have the same midpoint, and midpoints are lattice points: those at which the
    // edges would be split.
    const LatticePoint way = second - first;
    return numbers_.insert(first + LatticePoint{way.i / 2, way.j / 2, way.k / 2});
  }
  /// Returns the number of the next point that is appended.
  [[nodiscard]] std::uint32_t next_number() const;

  Domain domain_;
  double isovalue_;
  ContourOptions options_;
  Contour contour_;
  PointNumbers numbers_;
};

/// Adds the triangles of one diamond after another to a contour.
class DiamondContour {
 public:
  /// Makes the object. The builder must outlive it, and have the same isovalue and last sample.
  DiamondContour(ContourBuilder& builder, double isovalue, const std::optional<LatticePoint>& last_sample)
      : builder_(builder), isovalue_(isovalue), last_sample_(last_sample) {}

  /// Adds the triangles in the tetrahedra of the diamond with these slots, as bits. `values(p)` is the value
  /// at a lattice point.
  template <class Values>
  void add(const Diamond& diamond, unsigned slots, const Values& values);

 private:
  static constexpr std::size_t kMembers = 10;  ///< the ends of the split edge, and the ring

  void add_tetrahedron(int slot);
  std::uint32_t edge_point(std::size_t a, std::size_t b);

  ContourBuilder& builder_;
  double isovalue_;
  std::optional<LatticePoint> last_sample_;
  // The following members belong to the present diamond.
  std::size_t ring_ = 0;  ///< number of points of the ring
  std::array<LatticePoint, kMembers> points_;
  std::array<double, kMembers> values_;
  std::array<bool, kMembers> above_;
  /// Numbers of points, indexed by the ends of their edges, the lesser end first.
  std::array<std::array<std::uint32_t, kMembers>, kMembers> edge_points_;
};

/// Returns whether the diamond lies wholly beyond the last sample: it extends by its scale from its point in
/// all directions.
inline bool is_beyond(const Diamond& diamond, LatticePoint last_sample) {
  const LatticePoint p = diamond.point();
  const std::int32_t s = diamond.scale();
  return p.i - s >= last_sample.i || p.j - s >= last_sample.j || p.k - s >= last_sample.k;
}

template <class Values>
void DiamondContour::add(const Diamond& diamond, unsigned slots, const Values& values) {
  constexpr unsigned kEnds = 2;
  ring_ = static_cast<std::size_t>(diamond.tetrahedron_count());
  // Tetrahedron `slot` has the vertices `slot` and `slot` + 1 of the ring.
  const unsigned used = (slots | slots << 1 | slots >> (ring_ - 1)) << kEnds | 3;
  const auto [a, b] = diamond.split_edge();
  bool any_above = false, any_below = false;
  for (std::size_t m = 0; m < kEnds + ring_; ++m) {
    if ((used >> m & 1) == 0) continue;
    points_[m] = m == 0 ? a : m == 1 ? b : diamond.ring(static_cast<int>(m - kEnds));
    values_[m] = values(points_[m]);
    above_[m] = values_[m] >= isovalue_;
    (above_[m] ? any_above : any_below) = true;
  }
  if (!any_above || !any_below) return;
  for (auto& row : edge_points_) row.fill(ContourBuilder::kNone);
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((slots >> slot & 1) != 0) add_tetrahedron(slot);
  }
}

}  // namespace adamas::isosurface
