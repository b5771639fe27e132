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

/// What a vertex knows of the interfaces (docs/method.md, Signed distances at vertices).
struct VertexDistances {
  BodyId body;           ///< that the vertex lies in
  bool flagged = false;  ///< the body or a sign is doubtful: it rests on an open border of the input
  double radius = 0;     ///< R: no cell round the vertex has a greater diameter
  std::vector<NearDistance> near;  ///< by interface: those within R
  std::vector<BodyId> bodies;      ///< ascending: its own, and those of the near interfaces
};

/// Works out `bodies` of a vertex from the rest.
void list_known_bodies(const InterfaceTable& table, VertexDistances& vertex);

/// Who owns what of one tetrahedron (docs/method.md, Who owns a point of a cell). The functions of an
/// interface that is near a vertex interpolate its signed distance there; at a vertex it is far from, a value
/// that does not bind.
struct CellOwnership {
  struct Interface {
    InterfaceId id;
    std::uint32_t towards_first, towards_second;  ///< its two functions in the problem
  };
  /// Candidates are bodies, by id, owner = body index. One candidate without functions where the cell lies in
  /// one body.
  OwnershipProblem problem;
  std::vector<Interface> interfaces;  ///< by id; their functions are gone once the problem has been reduced

  [[nodiscard]] bool pure() const { return problem.candidates.size() == 1; }
  /// Position of a body among the candidates, or the number of candidates.
  [[nodiscard]] std::size_t candidate(BodyId body) const;
};

/// Divides a cell into parts of one owner; replaces `parts`, and leaves candidates without hope out of the
/// problem.
void partition_cell(CellOwnership& ownership, std::vector<OwnedTetrahedron>& parts);

/// Works out the ownership of the cell with the given vertices.
void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership);

}  // namespace adamas::interfaces
