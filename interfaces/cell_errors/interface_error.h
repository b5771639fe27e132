#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// An estimate of the distance of the approximated interfaces in one cell from the input's (docs/method.md,
/// Errors).
struct InterfaceError {
  double distance = 0;  ///< at most the cell's diameter, except for lost interfaces
  bool lost = false;    ///< whether the input has an interface here that is farther than the target from any
                        ///< that the cell shows
};

/// Estimates the distance both ways: at the corners of the input's triangles clipped to the cell, by the
/// linear functions; and at the corners of the cell's own interfaces, by the distance to the input's.
/// `triangles`: the triangles of the network that meet the cell. If there are very many, only some are used
/// at first, which can make the estimate of a coarse cell smaller; but all are used before an error within
/// `target` is returned. An interface that the cell does not show may be shown just outside, where its linear
/// function vanishes. In cells with a diameter above `trusted` this is not assumed, and the interface counts
/// as lost.
InterfaceError estimate_interface_error(const InterfaceNetwork& network, const Tetrahedron& cell,
                                        const CellOwnership& ownership,
                                        std::span<const std::uint32_t> triangles, double target,
                                        double trusted = std::numeric_limits<double>::infinity());

}  // namespace adamas::interfaces
