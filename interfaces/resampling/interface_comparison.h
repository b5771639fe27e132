#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "core/distance/hausdorff.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/input/resampling_source.h"

namespace adamas::interfaces {

/// Two-sided distance between parts of the input's interfaces and of the approximated ones; infinite where
/// one of the two has none.
struct InterfaceDistance {
  double upper = 0;  ///< certified: no point of either is further from the other
  double lower = 0;  ///< the distance of `worst`, a point of either, from the other
  Vec3 worst;
};

/// The measured distances between the input's interfaces and those of a mesh.
struct InterfaceCertificate {
  InterfaceDistance networks;   ///< all interfaces together
  InterfaceDistance materials;  ///< the greatest of the materials' own boundaries
  MaterialId worst_material;    ///< the material with that boundary
  /// The distance of the lines where three materials or more meet; none where the input has no such lines and
  /// none are shown, or where they are not known because its interfaces are open.
  std::optional<InterfaceDistance> junctions;
  std::size_t triangles = 0;  ///< number of triangles of the mesh's interfaces

  /// The greatest of the certified distances.
  [[nodiscard]] double upper() const {
    const double parts = std::max(networks.upper, materials.upper);
    return junctions ? std::max(parts, junctions->upper) : parts;
  }
};

/// The input's interfaces beside those that a mesh shows: the distances of the whole networks, of each
/// material's own boundary, and of the junction lines, where three materials or more meet. A material's
/// boundary may be far off where the whole networks are close: near a third material.
class InterfaceComparison {
 public:
  /// `target`: the distance wanted.
  InterfaceComparison(const ResamplingSource& source, double target);
  /// The input is a welded mesh of interfaces, and only what lies in the box counts. `closed`: all interfaces
  /// end at each other or at the box, so that junction lines are known.
  InterfaceComparison(InterfaceMesh input, const Box3& box, bool closed, double target);

  /// Changes the distance wanted of what is measured from now on.
  void set_target(double target) { target_ = target; }
  /// Measures the interfaces shown by a mesh, whose materials are those of the source. With `each`, each
  /// triangle's distance is then known to be within the target or not; else only the greatest is known.
  void measure(const InterfaceMesh& shown, const Progress& progress, bool each = true);
  /// The greatest measured distance of any part, an upper bound.
  [[nodiscard]] double greatest() const;
  /// Whether everything measured is within the target.
  [[nodiscard]] bool within() const;
  /// Makes the bounds as tight as reports want them, and measures the whole networks.
  [[nodiscard]] InterfaceCertificate finish(const InterfaceMesh& shown, const Progress& progress);

  /// Whether the shown boundary of the material on a side of a triangle of the network is, or may be, too far
  /// from some point of the triangle.
  [[nodiscard]] bool too_far(std::uint32_t triangle, std::size_t side) const {
    return far_[side][triangle] > target_;
  }
  /// Whether a corner or the middle of the triangle's part in a cell is too far from that boundary.
  [[nodiscard]] bool has_far_point(std::uint32_t triangle, std::size_t side, const Tetrahedron& cell) const;
  /// The shown triangles with points that are, or may be, too far from the input's.
  [[nodiscard]] const std::vector<std::uint32_t>& far_shown() const { return far_shown_; }
  /// Points of the input's junction lines, and of those shown, that are too far from the others.
  [[nodiscard]] const std::array<std::vector<Vec3>, 2>& far_junctions() const { return far_junctions_; }

 private:
  /// The triangles of a mesh that bound a material; or its junction lines, as triangles whose last two points
  /// are the same.
  struct Part {
    std::vector<Vec3> points;
    std::vector<ClosestPointTree::Triangle> triangles;
    std::vector<std::uint32_t> numbers;  ///< of the triangles in the mesh; none for lines
    ClosestPointTree tree;
  };
  /// All parts of a mesh; the last one is that of the junction lines.
  using Parts = std::vector<Part>;
  struct Bounds {
    DistanceBound input_to_shown, shown_to_input;
    [[nodiscard]] InterfaceDistance distance() const;
  };

  [[nodiscard]] Parts split_into_parts(const InterfaceMesh& mesh) const;
  void tighten(std::size_t part, double seen, const Progress& progress);
  void clear_far();
  void find_far();
  [[nodiscard]] std::vector<Vec3> far_points(const Part& lines, const DistanceBound& bound,
                                             const ClosestPointTree& others) const;
  [[nodiscard]] InterfaceDistance measure_networks(const InterfaceMesh& shown,
                                                   const Progress& progress) const;
  [[nodiscard]] InterfaceCertificate summary() const;
  /// The certified distance: what was seen at any point may differ by round-off from what is seen at the same
  /// point otherwise.
  [[nodiscard]] InterfaceDistance certified(InterfaceDistance distance) const;

  InterfaceMesh mesh_;  ///< the input's interfaces
  Box3 box_;
  double target_;
  /// By material. Two materials that share all their triangles have one part.
  IdVector<MaterialId, std::uint32_t> part_of_;
  std::size_t material_parts_ = 0;
  bool junctions_known_;  ///< the input's interfaces are closed
  Parts input_, shown_;
  std::vector<Bounds> bounds_;
  std::array<std::vector<double>, 2> far_;
  std::vector<std::uint32_t> far_shown_;
  std::array<std::vector<Vec3>, 2> far_junctions_;
};

}  // namespace adamas::interfaces
