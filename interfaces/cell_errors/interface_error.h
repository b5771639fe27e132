#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/ownership_problem.h"
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
  /// Whether the estimate ended as soon as it was above the target: the distance is the cell's diameter then,
  /// and `lost` is not known.
  bool partial = false;
};

struct InterfaceErrorOptions {
  double target = 0;  ///< the wanted distance
  /// In cells with a greater diameter, an interface that the cell does not show counts as lost. In others it
  /// may be shown just outside, where its linear function vanishes.
  double trusted = std::numeric_limits<double>::infinity();
  /// Whether the estimate may end as soon as it is above the target.
  bool may_be_partial = false;
};

/// The interfaces that a cell shows: the contact polygons of its bodies, and the ownership problem that they
/// are found for, reduced to the bodies that own a part of the cell.
struct ShownContacts {
  OwnershipProblem owners;
  std::vector<ContactPolygon> polygons;
};

/// Returns the interfaces of triangles of the network, ascending. The ownership of a cell that is compared
/// with its triangles needs them.
std::vector<InterfaceId> interfaces_of(const InterfaceNetwork& network,
                                       std::span<const std::uint32_t> triangles);

/// Returns whether these triangles bound more bodies than a cell can show accurately unless their interfaces
/// happen to be planes, so that the cell may be split without an estimate.
bool holds_crowd(const InterfaceNetwork& network, std::span<const std::uint32_t> triangles);

/// Estimates the distance both ways: at the corners of the input's triangles clipped to the cell, by the
/// linear functions; and at the corners of the cell's own interfaces, by the distance to the input's.
/// `triangles`: the triangles of the network that meet the cell. If there are very many, only some are used
/// at first, which can make the estimate of a coarse cell smaller; but all are used before an error within
/// the target is returned. `shown`, if it is not null, gets what the cell shows where the error is within the
/// target.
InterfaceError estimate_interface_error(const InterfaceNetwork& network, const Tetrahedron& cell,
                                        const CellOwnership& ownership,
                                        std::span<const std::uint32_t> triangles,
                                        const InterfaceErrorOptions& options, ShownContacts* shown = nullptr);

}  // namespace adamas::interfaces
