#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/material_boundaries.h"

namespace adamas::interfaces {

/// Finds places where what a part of a mesh shows is too far from the input's interfaces, by sample points
/// where InterfaceComparison would bound every point. It serves to refine without measuring all interfaces
/// again.
class NearbyComparison {
 public:
  /// `comparison` must outlive this object, and knows the input, the parts and the target. `shown`: what the
  /// mesh shows, at least within the target of all places that are asked for.
  NearbyComparison(const InterfaceComparison& comparison, const InterfaceMesh& shown);

  /// Returns whether a corner or the middle of the input's triangle's part in a cell is too far from what is
  /// shown of the boundary of a material beside it.
  [[nodiscard]] bool has_far_point(std::uint32_t triangle, const Tetrahedron& cell) const;
  /// Returns points of the input's junction lines in a box that are too far from those that are shown.
  [[nodiscard]] std::vector<Vec3> far_input_junctions(const Box3& box) const;
  /// Returns points in a box of the junction lines that are shown that are too far from those of the input.
  [[nodiscard]] std::vector<Vec3> far_shown_junctions(const Box3& box) const;

 private:
  const InterfaceComparison& comparison_;
  MaterialBoundaries shown_;
};

}  // namespace adamas::interfaces
