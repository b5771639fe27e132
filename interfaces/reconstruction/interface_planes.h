#pragma once

#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/vec3.h"

namespace adamas {

class SiteValues;

/// The plane that cuts a material's fraction off a mixed cell.
struct InterfacePlane {
  Vec3 towards;         ///< unit normal into the material; zero where no plane is known
  double distance = 0;  ///< of the cell's centre, positive in the material

  [[nodiscard]] bool known() const { return squared_norm(towards) > 0; }
};

/// The planes of all entries of mixed sites. Normals are gradients of the fractions (Youngs) at first, then
/// those of the planes through the middles of the pieces in the cells round them, again and again (Swartz;
/// Mosso and Clancy, 1994), so that planes come out as they are.
std::vector<InterfacePlane> interface_planes(const MultiMaterialData& data, const SiteValues& values);

}  // namespace adamas
