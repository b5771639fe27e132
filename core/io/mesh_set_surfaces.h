#pragma once

#include "core/data/mesh_data.h"
#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// Returns the surfaces of all sets of a mesh as polygons: the sides of each side set, and the faces all of
/// whose points are in a node set. `side_set` of cells is the number of the set among `side_set_names`; a
/// face is there once for each set that has it.
UnstructuredMesh mesh_set_surfaces(const MeshData& data);

}  // namespace adamas::io
