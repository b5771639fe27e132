#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/partition.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

/// Signed distance of a vertex from an interface near it, positive towards the interface's first body.
struct NearDistance {
  InterfaceId interface;
  double distance = 0;
};

/// The interfaces near a vertex, with their distances (docs/method.md, Signed distances at vertices).
struct VertexDistances {
  BodyId body;  ///< the body that the vertex lies in
  /// The body or a sign is doubtful, because it depends on an open border of the input.
  bool flagged = false;
  double radius = 0;               ///< the greatest diameter of a cell round the vertex, at least; called R
  std::vector<NearDistance> near;  ///< the interfaces within R, ascending
  std::vector<BodyId> bodies;      ///< the vertex's body and those of the near interfaces, ascending
};

/// Sets `bodies` of a vertex from its other members.
void list_known_bodies(const InterfaceTable& table, VertexDistances& vertex);

/// Who owns what of one tetrahedron (docs/method.md, Who owns a point of a cell). Each interface has two
/// linear functions. At a vertex near the interface they have its signed distance, at a vertex far from it a
/// value so great that it does not matter.
struct CellOwnership {
  struct Interface {
    InterfaceId id;
    std::uint32_t towards_first, towards_second;  ///< its two functions in the problem
  };
  /// The candidates are bodies in the order of their ids; `owner` is a body's id. A cell that lies in one
  /// body has one candidate without functions.
  OwnershipProblem problem;
  /// Ascending; their functions are gone once the problem has been reduced.
  std::vector<Interface> interfaces;

  [[nodiscard]] bool pure() const { return problem.candidates.size() == 1; }
  /// Position of a body among the candidates, or the number of candidates.
  [[nodiscard]] std::size_t candidate(BodyId body) const;
};

/// Divides a cell into parts of one owner each and replaces `parts` by them. Removes candidates that own
/// nothing from the problem.
void partition_cell(CellOwnership& ownership, std::vector<OwnedTetrahedron>& parts);

/// Finds the ownership of the cell with the given vertices and replaces `ownership` by it.
void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership);

}  // namespace adamas::interfaces
