#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/label_interfaces.h"

namespace adamas::interfaces {

/// The interfaces of labels, without smoothing, in parts of the grid: they are made of the cells there, and
/// are to the last bit those that LabelInterfaces makes of all cells.
class LabelParts {
 public:
  /// Returns null where parts do not suffice: where the grid's spacing differs by more than round-off, where
  /// the offsets that close totals are great, and where a material may own a piece of a tetrahedron alone at
  /// the border.
  static std::unique_ptr<LabelParts> make(const MultiMaterialData& data, Progress& progress);

  /// Makes the interfaces in the lattice cells that a plane meets, and in some beside them. `data`: those
  /// that this was made of. Throws Error as PlaneSides does.
  [[nodiscard]] InterfaceMesh near_plane(const MultiMaterialData& data, const Plane& plane) const;
  /// Returns the distance of a point from the nearest interface, which is NaN if there are no interfaces;
  /// none if many cells round the point would have to be looked at.
  [[nodiscard]] std::optional<double> interface_distance(const Vec3& p) const;
  /// The body that owns each point, and the materials of bodies; there are no triangles.
  [[nodiscard]] const LabelInterfaces& bodies() const { return *bodies_; }

 private:
  explicit LabelParts(std::unique_ptr<LabelInterfaces> bodies) : bodies_(std::move(bodies)) {}

  std::unique_ptr<LabelInterfaces> bodies_;
};

}  // namespace adamas::interfaces
