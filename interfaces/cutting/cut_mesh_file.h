#pragma once

#include "core/data/solver_mesh.h"
#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas {

/// The fields at the points of a cut mesh, for each body that has a tetrahedron there: by the linear
/// functions of the mesh that was cut, and where snapping has moved a point out of its body, by those of the
/// nearest cell that has it.
std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& cut, const ResampledMesh& mesh);

/// A cut mesh with `material` and `body` of cells, and the fields of the cell's own material at points: a
/// point on an interface comes once for each of its bodies.
UnstructuredMesh to_unstructured_mesh(const ConformingMesh& cut, const ResampledMesh& mesh);

/// A cut mesh with a block for each material, the fields' means in its cells, and named groups of faces: the
/// sides of the box ("x min" and so on) and the interfaces ("FIRST | SECOND"), seen from the first.
SolverMesh to_solver_mesh(const ConformingMesh& cut, const ResampledMesh& mesh);

}  // namespace adamas
