#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/ownership_problem.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

/// The signed distance of a vertex from an interface near it, positive towards the interface's first body.
struct NearDistance {
  InterfaceId interface;
  double distance = 0;
};

/// The interfaces near a vertex, with their distances (docs/method.md, Signed distances at vertices).
struct VertexDistances {
  BodyId body;  ///< the body in which the vertex lies
  /// Whether the body or a sign is uncertain because it depends on an open border of the input.
  bool flagged = false;
  double radius = 0;               ///< a bound of the diameters of the cells round the vertex; called R
  std::vector<NearDistance> near;  ///< the interfaces within R, ascending
  std::vector<BodyId> bodies;      ///< the vertex's body and those of the near interfaces, ascending
};

/// Sets `bodies` of a vertex from its other members.
void list_known_bodies(const InterfaceTable& table, VertexDistances& vertex);

/// The ownership in one tetrahedron (docs/method.md, Who owns a point of a cell). Each interface has two
/// linear functions. At a vertex near the interface they have its signed distance, at a vertex far from it a
/// value so great that it has no effect.
struct CellOwnership {
  struct Interface {
    InterfaceId id;
    std::uint32_t towards_first, towards_second;  ///< the interface's two functions in the problem
  };
  /// The candidates are bodies in the order of their ids; `owner` is a body's id. A cell that lies in one
  /// body has one candidate without functions.
  OwnershipProblem problem;
  /// The interfaces between two candidates that are near a vertex or were needed, ascending; their function
  /// indices become invalid when the problem is reduced.
  std::vector<Interface> interfaces;

  [[nodiscard]] bool pure() const { return problem.candidates.size() == 1; }
  /// Returns an interface of the cell; null if it is not among `interfaces`.
  [[nodiscard]] const Interface* find(InterfaceId id) const {
    const auto found = std::ranges::lower_bound(interfaces, id, {}, &Interface::id);
    return found == interfaces.end() || found->id != id ? nullptr : &*found;
  }
  /// Returns the position of a body among the candidates, or the number of candidates if it is none.
  [[nodiscard]] std::size_t candidate(BodyId body) const;
};

/// Sets `parts` to the parts of a cell with one owner each. Removes candidates that own nothing from the
/// problem.
void partition_cell(CellOwnership& ownership, std::vector<OwnedTetrahedron>& parts);

/// The bodies that an ownership is to have besides those that may own a part of the cell.
struct OwnershipNeeds {
  std::span<const BodyId> bodies{};  ///< these, ascending, as far as a vertex knows them
  /// The two bodies of each of these interfaces, ascending, and the interface, if vertices know both bodies.
  std::span<const InterfaceId> interfaces{};
  /// Those whose value may come as close as this to the owner's, in units of length; all that the vertices
  /// know if it is infinite.
  double reach = 0;
};

/// Sets `ownership` to the ownership of the cell with the given vertices. Bodies whose value is everywhere
/// below another one's are left out unless they are needed. The time grows with the number of interfaces near
/// the vertices, and the problem only with the bodies that it has.
void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership, const OwnershipNeeds& needs = {});

}  // namespace adamas::interfaces
