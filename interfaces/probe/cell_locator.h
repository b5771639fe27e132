#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/ownership_problem.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/network/box_tree.h"

namespace adamas::interfaces {

/// Finds the cell of a mesh that holds a point. Queries may run on several threads at once.
class CellLocator {
 public:
  /// The mesh must outlive the locator.
  explicit CellLocator(const ResampledMesh& mesh);

  struct Location {
    std::uint32_t cell;
    /// The barycentric coordinates of the point in the cell; at its boundary they may be below 0 by
    /// round-off.
    Weights weights;
  };
  /// Finds the cell of a point; none for a point outside the mesh's box. If cells share the point, it is the
  /// one with the lowest number in which no weight is negative.
  [[nodiscard]] std::optional<Location> locate(const Vec3& p) const;
  /// Finds the accepted cell that holds the point or is near it: the one whose least weight is the greatest.
  /// There is none if no cell is accepted or the point lies outside the box.
  [[nodiscard]] std::optional<Location> nearest(const Vec3& p,
                                                const std::function<bool(std::uint32_t)>& accept) const;
  /// Sets `cells` to those whose boxes are at most so far from the point, in ascending order.
  void cells_near(const Vec3& p, double distance, std::vector<std::uint32_t>& cells) const {
    tree_.near(p, distance, cells);
  }

 private:
  [[nodiscard]] std::optional<Location> nearest_within(
      const Vec3& p, double radius, const std::function<bool(std::uint32_t)>& accept) const;

  const ResampledMesh& mesh_;
  BoxTree tree_;
};

}  // namespace adamas::interfaces
