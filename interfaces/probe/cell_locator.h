#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/partition.h"
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
    Weights weights;  ///< of the point in the cell; those on its boundary may be below zero by round-off
  };
  /// None for a point outside the mesh's box. Of cells that share the point, the one with the lowest number
  /// that the weights put it into.
  [[nodiscard]] std::optional<Location> locate(const Vec3& p) const;
  /// Among the cells that are accepted the one that holds the point, or is near it: the one whose least
  /// weight is the greatest. None where none is accepted, or the point lies outside of the box.
  [[nodiscard]] std::optional<Location> nearest(const Vec3& p,
                                                const std::function<bool(std::uint32_t)>& accept) const;

 private:
  [[nodiscard]] std::optional<Location> best_within(const Vec3& p, double radius,
                                                    const std::function<bool(std::uint32_t)>& accept) const;

  const ResampledMesh& mesh_;
  BoxTree tree_;
};

}  // namespace adamas::interfaces
