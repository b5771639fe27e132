#pragma once

#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Divides each cell between the owners of its corners, with a point on each edge between two owners, on each
/// face with three and in each cell with four. Neighbours divide their common faces equally. All volumes are
/// positive if these points lie inside their edges, faces and cells.
LabelledMesh divide_cells(const BisectedCells& cells);

}  // namespace adamas::interfaces
