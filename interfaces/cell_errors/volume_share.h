#pragma once

#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// How one cell changes a body's volume in the mesh (docs/method.md, Building).
struct VolumeShare {
  BodyId body;
  /// The volume that the cell gives the body beyond what the input gives it: an estimate, at most the cell's
  /// volume.
  double gained = 0;
  double area = 0;  ///< area of the body's boundary in the input, within the cell
};

/// Estimates by how much a cell changes the volumes of bodies, by body. Where the input has a part of the
/// body's boundary, it is this part's area times how far the cell moves its middle, by the linear functions.
/// To a body without a boundary there the input gives all of the cell or nothing of it, so what the cell
/// gives it is known. `triangles`: the triangles of the network that meet the cell. The ownership is reduced
/// to the bodies that own something.
std::vector<VolumeShare> estimate_volume_shares(const InterfaceNetwork& network, const Tetrahedron& cell,
                                                CellOwnership& ownership,
                                                std::span<const std::uint32_t> triangles);

}  // namespace adamas::interfaces
