#pragma once

#include "core/data/mesh_data.h"
#include "core/data/solver_mesh.h"

namespace adamas::interfaces {

/// Adds the side sets of the input to the groups of faces of its cut mesh: a face that is in a group already,
/// on the boundary or on an interface, is in a set too if, of the input's boundary and of the sides of all
/// sets, one of the set is the nearest to the face's centre, within `tolerance` and within 60 degrees of its
/// direction. A set with the name of another group is called "NAME (input)"; one without faces is left out.
void add_input_sets(const MeshData& data, double tolerance, SolverMesh& mesh);

}  // namespace adamas::interfaces
