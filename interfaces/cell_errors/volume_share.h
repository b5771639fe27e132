#pragma once

#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// The change of a body's volume in the mesh by one cell (docs/method.md, Building).
struct VolumeShare {
  BodyId body;
  /// An estimate of the body's volume in the cell minus that in the input, at most the cell's volume.
  double gained = 0;
  double area = 0;  ///< the area of the body's boundary in the input, within the cell
};

/// Estimates the changes of bodies' volumes by a cell. For a body with a boundary in the input there, the
/// change is the boundary's area times the distance by which the linear functions move its middle. A body
/// without a boundary there has all or nothing of the cell in the input, so its change is known. `triangles`:
/// the triangles of the network that meet the cell. The ownership is reduced to the bodies that own
/// something.
std::vector<VolumeShare> estimate_volume_shares(const InterfaceNetwork& network, const Tetrahedron& cell,
                                                CellOwnership& ownership,
                                                std::span<const std::uint32_t> triangles);

}  // namespace adamas::interfaces
