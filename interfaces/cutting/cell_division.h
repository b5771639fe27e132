#pragma once

#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas {

/// Divides each cell between the owners of its corners: one cut on each edge between two owners, one point on
/// each face of three, one in each cell of four. Neighbours divide what they share alike, and all volumes are
/// positive, wherever these points are inside of what they lie on.
LabelledMesh divide_cells(const BisectedCells& cells);

}  // namespace adamas
