#pragma once

#include <optional>
#include <string>

#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"
#include "core/picture/slice_picture.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/source.h"

namespace adamas::demo {

/// The input's interfaces as a mesh, as they are kept for queries.
InterfaceMesh input_interfaces(const ResamplingSource& source);

/// Three cross sections beside each other: the input, plain linear interpolation in the cells, and each
/// material's own field up to its interfaces; with cells, original and approximated interfaces (D
/// figures 3.7, 3.8).
class DemoSlices {
 public:
  /// `field` as find_field takes it.
  DemoSlices(const MultiMaterialData& data, const ResampledMesh& mesh, const InterfaceMesh& original,
             const Plane& plane, const std::string& field);
  /// A PNG file of all, or of a part in the plane's coordinates; the same colours in both.
  [[nodiscard]] std::string png(const std::optional<Box2>& window) const;

 private:
  SlicePicture picture_;
};

/// PNG of interfaces in the domain. Each has the colour of the smaller of its two materials, by `volumes`,
/// and lets the greatest material be seen through.
std::string interfaces_png(const InterfaceMesh& mesh, const Box3& box,
                           const IdVector<MaterialId, double>& volumes, const std::string& title,
                           bool triangle_edges);

}  // namespace adamas::demo
