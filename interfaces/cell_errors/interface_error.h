#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// How far the approximation of the interfaces in one cell is from the input's (docs/method.md, Errors); an
/// estimate.
struct InterfaceError {
  double distance = 0;  ///< at most the cell's diameter, but for lost interfaces
  bool lost = false;    ///< the input has an interface here, further than the target from any the cell shows
};

/// Estimates the distance both ways: at the corners of the input's triangles clipped to the cell, by the
/// linear functions; and at the corners of the cell's own interfaces, by the distance to the input's.
/// `triangles`: the triangles of the network that meet the cell. Where there are very many, only some are
/// looked at first, which can make the estimate of a coarse cell smaller; but all are looked at before an
/// error within `target` is returned. An interface that the cell does not show may be shown just outside,
/// where its linear function vanishes; in cells with a diameter above `trusted` that is not believed, and the
/// interface counts as lost.
InterfaceError estimate_interface_error(const InterfaceNetwork& network, const Tetrahedron& cell,
                                        const CellOwnership& ownership,
                                        std::span<const std::uint32_t> triangles, double target,
                                        double trusted = std::numeric_limits<double>::infinity());

}  // namespace adamas::interfaces
