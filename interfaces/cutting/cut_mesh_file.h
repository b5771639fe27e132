#pragma once

#include "core/data/solver_mesh.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// Returns the fields at the points of a cut mesh, for each body that has a tetrahedron there. They come from
/// the linear functions of the mesh that was cut or, if snapping has moved a point out of its body, from
/// those of the nearest cell that has the body.
std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& cut, const ResampledMesh& mesh);

/// Whether a point on interfaces is one point for all bodies there or one for each of them.
enum class PointsOfBodies { kShared, kSplit };

/// Converts a cut mesh to a mesh for solvers, with a block for each material, the fields' means in its cells,
/// and named groups of faces: the sides of the box ("x min" and so on) and the interfaces ("FIRST | SECOND"),
/// as sides of the first material's cells. With split points it also has the fields of the bodies at points,
/// and each interface as sides of the second material's cells ("SECOND | FIRST").
SolverMesh to_solver_mesh(const ConformingMesh& cut, const ResampledMesh& mesh,
                          PointsOfBodies points = PointsOfBodies::kShared);

}  // namespace adamas::interfaces
