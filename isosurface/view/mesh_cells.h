#pragma once

#include <functional>
#include <vector>

#include "adamas/geometry.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas::isosurface {

// These functions find cells of the mesh that comes from a root diamond by splitting some diamonds, from the
// root down. No diamond between samples may be split.

/// Returns whether the diamond of a point is split.
using IsSplit = std::function<bool(LatticePoint)>;

/// Returns the point of the diamond whose cell contains a place.
LatticePoint diamond_at(const Diamond& root, const Domain& domain, const Vec3& place,
                        const IsSplit& is_split);

/// Returns the cells' sections in a plane, as polygons, clipped to a box.
std::vector<std::vector<Vec3>> cells_in(const Diamond& root, const Domain& domain, const Plane& plane,
                                        const Box3& box, const IsSplit& is_split);

}  // namespace adamas::isosurface
