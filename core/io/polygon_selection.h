#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// Polygons on some of the points of a mesh. A point is taken once, when the first polygon has it.
class PolygonSelection {
 public:
  /// `points`: those of the mesh; they must outlive the selection.
  explicit PolygonSelection(const std::vector<Vec3>& points)
      : points_(points), places_(points.size(), kUnused) {
    mesh.kind = CellKind::kPolygons;
  }

  void add(std::span<const std::uint32_t> polygon) {
    for (const std::uint32_t p : polygon) {
      if (places_[p] == kUnused) {
        places_[p] = static_cast<std::uint32_t>(taken.size());
        taken.push_back(static_cast<std::int32_t>(p));
        mesh.points.push_back(points_[p]);
      }
      mesh.connectivity.push_back(places_[p]);
    }
    mesh.offsets.push_back(mesh.connectivity.size());
  }

  UnstructuredMesh mesh{};
  std::vector<std::int32_t> taken{};  ///< the numbers that the points of `mesh` have among all

 private:
  static constexpr std::uint32_t kUnused = ~std::uint32_t{0};

  const std::vector<Vec3>& points_;
  std::vector<std::uint32_t> places_;
};

}  // namespace adamas::io
