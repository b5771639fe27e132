#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/tetrahedron_contour.h"
#include "core/geometry/vec3.h"
#include "core/lattice/domain.h"
#include "core/lattice/lattice_point.h"
#include "core/lattice/point_numbers.h"
#include "isosurface/hierarchy/indexed_hierarchy.h"

namespace adamas {

/// Where a contour crosses an edge of the mesh.
struct EdgePoint {
  LatticePoint first, second;  ///< the ends, in ascending order
  double parameter;            ///< 0 at the first end, 1 at the second

  bool operator==(const EdgePoint&) const = default;
};

/// Where the border of the data cuts a contour inside a tetrahedron: a mean of the tetrahedron's vertices. A
/// vertex of weight 0 may be any point.
struct BorderPoint {
  std::array<LatticePoint, 4> vertices{};
  std::array<double, 4> weights{};  ///< 1 in all

  bool operator==(const BorderPoint&) const = default;
};

/// A triangle surface with shared points: every edge inside the data has two triangles, which run along it in
/// opposite directions.
struct Contour {
  std::vector<Vec3> points;                             ///< in space: first edge points, then border points
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals point to values below the isovalue
  std::vector<EdgePoint> edge_points;                   ///< of the first points, in the same order
  std::vector<BorderPoint> border_points;               ///< of the points after these

  bool operator==(const Contour&) const = default;
};

struct ContourOptions {
  /// Parameters of edge points are kept in [least_parameter, 1 - least_parameter]. With 0 the triangles at
  /// samples equal to the isovalue have no area; with more, all have one, but for what clipping may leave of
  /// them. Less than 1/2.
  double least_parameter = 0;
  /// The lattice point of the data's last sample, where the domain is larger than the data: the contour is
  /// clipped to the box from the origin to it.
  std::optional<LatticePoint> last_sample;
};

/// A tetrahedron of the mesh that a contour crosses.
struct CrossedTetrahedron {
  LatticePoint diamond;
  std::uint8_t slot, above;  ///< above: the vertices whose values are not below the isovalue, as bits
  std::array<double, 4> values;
};

/// Whether the tetrahedron has at most a face in the data's box.
bool is_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample);

/// A contour that grows by a tetrahedron at a time. Points are numbered as they are first met.
class ContourBuilder {
 public:
  ContourBuilder(const Domain& domain, double isovalue, const ContourOptions& options);

  /// Throws Error where the surface has more points than 32 bits can number.
  void add(const CrossedTetrahedron& tetrahedron);
  /// The number of the point on an edge of the mesh between two finite values, one of them below the isovalue
  /// and one not. Throws as `add` does.
  std::uint32_t edge_point(LatticePoint a, LatticePoint b, double value_a, double value_b);
  /// By the numbers of its points.
  void add_triangle(const std::array<std::uint32_t, 3>& points) { contour_.triangles.push_back(points); }
  /// The contour, clipped; the builder is not to be used then.
  [[nodiscard]] Contour finish();

 private:
  Domain domain_;
  double isovalue_;
  ContourOptions options_;
  Contour contour_;
  PointNumbers numbers_;
};

/// Those that the contour crosses, in any order; see extract_contour.
template <class Values>
std::vector<CrossedTetrahedron> find_crossed(const IndexedHierarchy& hierarchy, const Values& values,
                                             double isovalue, const std::optional<LatticePoint>& last_sample);

/// The contour through these tetrahedra; their order does not matter.
Contour triangulate_crossed(const Domain& domain, std::vector<CrossedTetrahedron> crossed, double isovalue,
                            const ContourOptions& options);

/// The contour of the piecewise linear function on the current mesh with the given values at its vertices.
/// `values(p)` gives the value at the lattice point p as a double; it is asked once for each vertex of a
/// diamond, so several times for a vertex of the mesh, in no order that means anything, and not for diamonds
/// beyond the last sample. A value equal to the isovalue counts as above it. Tetrahedra with a value that is
/// not finite have no surface. The result depends on the mesh alone, not on how the hierarchy came to it.
/// Throws Error where the surface has more points than 32 bits can number.
template <class Values>
Contour extract_contour(const IndexedHierarchy& hierarchy, const Values& values, double isovalue,
                        const ContourOptions& options = {}) {
  return triangulate_crossed(
      hierarchy.domain(), find_crossed(hierarchy, values, isovalue, options.last_sample), isovalue, options);
}

/// Whether the diamond lies wholly beyond the last sample: it reaches by its scale to all sides of its point.
inline bool is_beyond(const Diamond& diamond, LatticePoint last_sample) {
  const LatticePoint p = diamond.point();
  const std::int32_t s = diamond.scale();
  return p.i - s >= last_sample.i || p.j - s >= last_sample.j || p.k - s >= last_sample.k;
}

template <class Values>
std::vector<CrossedTetrahedron> find_crossed(const IndexedHierarchy& hierarchy, const Values& values,
                                             double isovalue,
                                             const std::optional<LatticePoint>& last_sample) {
  std::vector<CrossedTetrahedron> crossed;
  hierarchy.for_each_diamond([&](const Diamond& diamond, std::uint8_t slots) {
    if (last_sample && is_beyond(diamond, *last_sample)) return;
    const std::size_t count = static_cast<std::size_t>(diamond.tetrahedron_count());
    // Tetrahedron `slot` has the vertices `slot` and `slot` + 1 of the ring.
    const unsigned used = slots | unsigned{slots} << 1 | unsigned{slots} >> (count - 1);
    const auto [a, b] = diamond.split_edge();
    const double value_a = values(a), value_b = values(b);
    const unsigned axis_above = unsigned{value_a >= isovalue} | unsigned{value_b >= isovalue} << 1;
    std::array<double, 9> ring;
    unsigned ring_above = 0;
    for (std::size_t r = 0; r < count; ++r) {
      if ((used >> r & 1) == 0) continue;
      ring[r] = values(diamond.ring(static_cast<int>(r)));
      ring_above |= unsigned{ring[r] >= isovalue} << r;
    }
    ring[count] = ring[0];
    ring_above |= (ring_above & 1) << count;
    for (std::size_t slot = 0; slot < count; ++slot) {
      const unsigned above = axis_above | (ring_above >> slot & 3) << 2;
      if ((slots >> slot & 1) == 0 || kTetrahedronContours[above].triangle_count == 0) continue;
      crossed.push_back({diamond.point(),
                         static_cast<std::uint8_t>(slot),
                         static_cast<std::uint8_t>(above),
                         {value_a, value_b, ring[slot], ring[slot + 1]}});
    }
  });
  return crossed;
}

}  // namespace adamas
