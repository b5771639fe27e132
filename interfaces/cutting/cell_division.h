#pragma once

#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Divides each cell between the owners of its corners, with a point on each edge between two owners, on each
/// face of three and in each cell of four. Neighbours divide their common faces in the same way. All volumes
/// are positive wherever these points lie inside of their edges, faces and cells.
LabelledMesh divide_cells(const BisectedCells& cells);

}  // namespace adamas::interfaces
