#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "core/distance/hausdorff.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

/// Two-sided distance between parts of the input's interfaces and of the approximated ones; infinite where
/// one of the two has none.
struct InterfaceDistance {
  double upper = 0;  ///< certified: no point of either is further from the other
  double lower = 0;  ///< attained at `worst`
  Vec3 worst;        ///< a point of either
};

/// What is known in the end of how far the input's interfaces and those of a mesh are from each other.
struct InterfaceCertificate {
  InterfaceDistance networks;   ///< all interfaces together
  InterfaceDistance materials;  ///< the greatest of the materials' own boundaries
  MaterialId worst_material;    ///< whose that is
  /// Of the lines where three materials or more meet; none where the input has no such lines and none are
  /// shown, or where they are not known because its interfaces are open.
  std::optional<InterfaceDistance> junctions;
  std::size_t triangles = 0;  ///< of what is shown

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
  /// The same for a mesh of interfaces, welded. Only what lies in the box counts. `closed`: all interfaces
  /// end at each other or at the box, so that junction lines are known.
  InterfaceComparison(InterfaceMesh input, const Box3& box, bool closed, double target);

  /// Another distance is wanted of what is measured from now on.
  void set_target(double target) { target_ = target; }
  /// Measures what is shown now, with `each` so well that each triangle's distance is known to be within the
  /// target or not; else only the greatest is known. The mesh's materials are those of the source.
  void measure(const InterfaceMesh& shown, const Progress& progress, bool each = true);
  /// No part is farther off than this, as it was measured.
  [[nodiscard]] double greatest() const;
  /// Whether everything measured is within the target.
  [[nodiscard]] bool within() const;
  /// Makes the bounds as tight as reports want them, and measures the whole networks.
  [[nodiscard]] InterfaceCertificate finish(const InterfaceMesh& shown, const Progress& progress);

  /// For each side of a triangle of the network: whether the boundary of the material there, as it is shown,
  /// is or may be too far from some point of the triangle.
  [[nodiscard]] bool too_far(std::uint32_t triangle, std::size_t side) const {
    return far_[side][triangle] > target_;
  }
  /// The shown boundary of the material on a side of a triangle of the network.
  [[nodiscard]] const ClosestPointTree& shown_boundary(std::uint32_t triangle, std::size_t side) const;
  /// Triangles of what is shown with points that are or may be too far from the input's.
  [[nodiscard]] const std::vector<std::uint32_t>& far_shown() const { return far_shown_; }
  /// Points of the input's junction lines, and of those shown, that are too far from the others.
  [[nodiscard]] const std::array<std::vector<Vec3>, 2>& far_junctions() const { return far_junctions_; }

 private:
  /// Triangles of a mesh that bound a material, or its junction lines: triangles whose last two points are
  /// one.
  struct Part {
    std::vector<Vec3> points;
    std::vector<ClosestPointTree::Triangle> triangles;
    std::vector<std::uint32_t> numbers;  ///< in the mesh; of triangles only
    ClosestPointTree tree;
  };
  /// All parts of a mesh; the last one is that of the junction lines.
  using Parts = std::vector<Part>;
  struct Bounds {
    DistanceBound of_input, of_shown;
    [[nodiscard]] InterfaceDistance distance() const;
  };

  [[nodiscard]] Parts take_apart(const InterfaceMesh& mesh) const;
  void tighten(std::size_t part, double seen, const Progress& progress);
  void forget_far();
  void find_far();
  [[nodiscard]] std::vector<Vec3> far_points(const Part& lines, const DistanceBound& bound,
                                             const ClosestPointTree& others) const;
  [[nodiscard]] InterfaceDistance measure_networks(const InterfaceMesh& shown,
                                                   const Progress& progress) const;
  [[nodiscard]] InterfaceCertificate summary() const;
  /// The certified distance: what was seen at any point may differ by round-off from what is seen at the same
  /// point otherwise.
  [[nodiscard]] InterfaceDistance certified(InterfaceDistance distance) const;

  InterfaceMesh mesh_;  ///< of the input
  Box3 box_;
  double target_;
  IdVector<MaterialId, std::uint32_t> part_of_;  ///< where two materials share all their triangles, one part
  std::size_t material_parts_ = 0;
  bool junctions_known_;  ///< the input's interfaces are closed
  Parts input_, shown_;
  std::vector<Bounds> bounds_;
  std::array<std::vector<double>, 2> far_;
  std::vector<std::uint32_t> far_shown_;
  std::array<std::vector<Vec3>, 2> far_junctions_;
};

}  // namespace adamas::interfaces
