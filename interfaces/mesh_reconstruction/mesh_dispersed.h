#pragma once

#include <vector>

#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Finds dispersed fractions, as take_dispersed() does on grids, and gives them to the other materials of
/// their cells, of whose entries those that are gone are dropped. Cells that share a point are neighbours.
/// `widths`: of the steps of each material, by its number (Steps). Returns the volume of each material that
/// was given away, in the order of the data.
std::vector<double> take_dispersed(const std::vector<double>& widths, MeshValues& values);

}  // namespace adamas::interfaces
