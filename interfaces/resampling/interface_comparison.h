#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/distance/hausdorff.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/resampling/material_boundaries.h"

namespace adamas::interfaces {

/// The two-sided distance between parts of the input's interfaces and of the approximated ones; infinite if
/// one of the two has none.
struct InterfaceDistance {
  double upper = 0;  ///< certified: no point of either is farther from the other
  double lower = 0;  ///< the distance of `worst`, a point of one of them, from the other
  Vec3 worst;
};

/// The measured distances between the input's interfaces and those of a mesh.
struct InterfaceCertificate {
  InterfaceDistance networks;   ///< all interfaces together
  InterfaceDistance materials;  ///< the greatest distance of the materials' own boundaries
  MaterialId worst_material;    ///< the material with that boundary
  /// The distance of the junction lines, where at least three materials meet; none if neither the input nor
  /// the mesh has such lines, or if they are unknown because the input's interfaces are open.
  std::optional<InterfaceDistance> junctions;
  std::size_t triangles = 0;  ///< the number of triangles of the mesh's interfaces

  /// Returns the greatest of the certified distances.
  [[nodiscard]] double upper() const {
    const double parts = std::max(networks.upper, materials.upper);
    return junctions ? std::max(parts, junctions->upper) : parts;
  }
};

/// Compares the input's interfaces with those that a mesh shows: the distances of the whole networks, of each
/// material's own boundary, and of the junction lines, where at least three materials meet. Near a third
/// material, a material's boundary may be far off where the whole networks are close.
class InterfaceComparison {
 public:
  /// `target`: the wanted distance.
  InterfaceComparison(const ResamplingSource& source, double target);
  /// The input is a welded mesh of interfaces, of which only the part in the box counts. `closed`: whether
  /// all interfaces end at each other or at the box, so that junction lines are known.
  InterfaceComparison(const InterfaceMesh& input, const Box3& box, bool closed, double target);

  /// Changes the wanted distance for later measurements.
  void set_target(double target) { target_ = target; }
  /// Returns the items that LoopProgress counts while these interfaces are measured; nearly so.
  [[nodiscard]] double work_of_measuring(const InterfaceMesh& shown) const;
  /// Measures the interfaces shown by a mesh, whose materials are those of the source. With `each`, it is
  /// determined for each triangle whether its distance is within the target; else only the greatest distance
  /// is. If the last measurement was of each triangle too, only triangles near changes are measured.
  void measure(const InterfaceMesh& shown, const Progress& progress, bool each = true);
  /// Measures the interfaces after their points have moved, and nothing else has changed. Bounds follow the
  /// moves; only triangles that may be too far by it are measured. The last measurement must have been of
  /// each triangle.
  void measure_moved(const InterfaceMesh& shown, const Progress& progress);
  /// The number of a point that was not there before.
  static constexpr std::uint32_t kNoPoint = 0xffffffffu;
  /// The same where some triangles have come or gone besides. `points_before`: by shown point, the number
  /// that it had in the last measurement, or kNoPoint. Triangles with the same points have moved.
  void measure_moved(const InterfaceMesh& shown, const std::vector<std::uint32_t>& points_before,
                     const Progress& progress);
  /// Returns how far the points of each shown triangle may move, `most` at most, so that what is within the
  /// target, or would be if they moved by less than `most`, stays so. The last measurement must have been of
  /// each triangle.
  [[nodiscard]] std::vector<double> slack(double most) const;
  /// Returns the input's interfaces.
  [[nodiscard]] const MaterialBoundaries& input() const { return input_; }
  [[nodiscard]] const MaterialParts& parts() const { return parts_; }
  [[nodiscard]] double target() const { return target_; }
  /// Returns whether junction lines are compared.
  [[nodiscard]] bool knows_junctions() const { return junctions_known_; }
  /// Returns whether the last measurement was of each triangle.
  [[nodiscard]] bool knows_each() const { return each_; }
  /// Returns an upper bound of the greatest measured distance of any part.
  [[nodiscard]] double greatest() const;
  /// Returns an upper bound of the greatest measured distance of a material's boundary.
  [[nodiscard]] double greatest_of_materials() const;
  /// Returns an upper bound of the greatest measured distance of the parts that are in the input and the
  /// mesh.
  [[nodiscard]] double greatest_of_shown() const;
  /// Returns whether all measured distances are within the target.
  [[nodiscard]] bool within() const;
  /// Tightens the bounds for reports, and measures the whole networks.
  [[nodiscard]] InterfaceCertificate finish(const Progress& progress);

  /// Returns whether the shown boundary of the material on a side of a triangle of the input is, or may be,
  /// too far from some point of the triangle.
  [[nodiscard]] bool too_far(std::uint32_t triangle, std::size_t side) const {
    return (far_[triangle] >> side & 1) != 0;
  }
  /// Returns whether a corner or the middle of the triangle's part in a cell is too far from that boundary.
  [[nodiscard]] bool has_far_point(std::uint32_t triangle, std::size_t side, const Tetrahedron& cell) const;
  /// Returns the shown triangles with points that are, or may be, too far from the input's.
  [[nodiscard]] const std::vector<std::uint32_t>& far_shown() const { return far_shown_; }
  /// Returns these triangles and those that are as close to a triangle of the input that is too far as what
  /// is shown there at all.
  [[nodiscard]] std::vector<std::uint32_t> shown_near_far() const;
  /// Returns the numbers of triangles of a mesh, which need not be welded, with points that are, or may be,
  /// too far from the input's.
  [[nodiscard]] std::vector<std::uint32_t> far_among(const InterfaceMesh& triangles,
                                                     const Progress& progress) const;
  /// Returns points of the input's junction lines, and of the shown ones, that are too far from the others.
  [[nodiscard]] const std::array<std::vector<Vec3>, 2>& far_junctions() const { return far_junctions_; }

 private:
  struct Bounds {
    DistanceBound input_to_shown, shown_to_input;
    [[nodiscard]] InterfaceDistance distance() const;
  };

  InterfaceComparison(const IdVector<MaterialId, char>& used, const Box3& box, double target);
  /// The triangles of both sides, by part, and the places of those that are left to be bounded.
  struct Unfinished {
    struct Direction {
      explicit Direction(const MaterialBoundaries& boundaries);

      std::vector<TriangleList> lists;
      std::vector<std::vector<std::uint32_t>> left;
    };
    Unfinished(const MaterialBoundaries& input_boundaries, const MaterialBoundaries& shown_boundaries);

    Direction input, shown;
  };
  [[nodiscard]] DistanceBound& bound(std::size_t part, bool of_input) {
    return of_input ? bounds_[part].input_to_shown : bounds_[part].shown_to_input;
  }
  /// Finds the places of shown triangles, or of junction lines, among those before.
  using PlacesBefore =
      std::function<std::vector<std::uint32_t>(const TriangleList& before, const TriangleList& now)>;
  [[nodiscard]] MaterialBoundaries exchange_shown(const InterfaceMesh& shown);
  void measure_shown(const MaterialBoundaries& before, const PlacesBefore& places_before,
                     const HausdorffOptions& options, const Progress& progress);
  [[nodiscard]] bool begin_changes(std::size_t part, const ClosestPointTree& before,
                                   const std::vector<std::uint32_t>& places_before, Unfinished& unfinished,
                                   const HausdorffOptions& options, const Progress& progress);
  void finish_bounds(Unfinished& unfinished, const HausdorffOptions& options, const Progress& progress);
  void bound_in_both_parts(bool of_input, const std::vector<TriangleList>& lists,
                           std::vector<std::vector<std::uint32_t>>& left, const HausdorffOptions& options,
                           const Progress& progress);
  [[nodiscard]] HausdorffOptions measuring_options() const;
  void tighten_in_both_parts(double seen, const Progress& progress);
  void tighten(std::size_t part, double seen, const Progress& progress);
  void clear_far();
  void find_far();
  [[nodiscard]] std::vector<Vec3> far_points(const TriangleList& lines, const DistanceBound& bound,
                                             const ClosestPointTree& others) const;
  [[nodiscard]] DistanceBound bound_of_materials(bool of_input) const;
  [[nodiscard]] InterfaceDistance measure_networks(const Progress& progress) const;
  [[nodiscard]] InterfaceCertificate summary() const;
  /// Returns the distance with a margin for round-off, by which the measured distance of a point may vary.
  [[nodiscard]] InterfaceDistance certified(InterfaceDistance distance) const;

  Box3 box_;
  double target_;
  MaterialParts parts_;
  bool junctions_known_ = false;  ///< whether the input's interfaces are closed
  MaterialBoundaries input_, shown_;
  std::vector<Bounds> bounds_;     ///< by part; the last ones are those of the junction lines
  bool each_ = false;              ///< whether the bounds are those of each triangle
  std::vector<std::uint8_t> far_;  ///< by triangle of the input: bits 0 and 1 of its sides that are too far
  std::vector<std::uint32_t> far_shown_;
  std::array<std::vector<Vec3>, 2> far_junctions_;
};

}  // namespace adamas::interfaces
