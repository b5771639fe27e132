#pragma once

#include "core/data/solver_mesh.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// The fields at the points of a cut mesh, for each body that has a tetrahedron there: by the linear
/// functions of the mesh that was cut, and where snapping has moved a point out of its body, by those of the
/// nearest cell that has it.
std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& cut, const ResampledMesh& mesh);

/// Whose the points on interfaces are: one point for all bodies there, or one for each of them.
enum class PointsOfBodies { kShared, kSplit };

/// A cut mesh with a block for each material, the fields' means in its cells, and named groups of faces: the
/// sides of the box ("x min" and so on) and the interfaces ("FIRST | SECOND"), seen from the first. With
/// split points there are the fields of the body at points too, and each interface also as the second sees it
/// ("SECOND | FIRST").
SolverMesh to_solver_mesh(const ConformingMesh& cut, const ResampledMesh& mesh,
                          PointsOfBodies points = PointsOfBodies::kShared);

}  // namespace adamas::interfaces
