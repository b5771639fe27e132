#pragma once

#include <functional>
#include <vector>

#include "core/geometry/vec3.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas::isosurface {

// Cells of the mesh that comes from a root diamond by splitting some diamonds, found from the root down. No
// diamond between samples may be split.

/// Whether the diamond of a point is split.
using IsSplit = std::function<bool(LatticePoint)>;

/// The point of the diamond to which the cell belongs that holds a place.
LatticePoint diamond_at(const Diamond& root, const Domain& domain, const Vec3& place,
                        const IsSplit& is_split);

/// What the cells are in a plane: polygons, within a box.
std::vector<std::vector<Vec3>> cells_in(const Diamond& root, const Domain& domain, const Plane& plane,
                                        const Box3& box, const IsSplit& is_split);

}  // namespace adamas::isosurface
