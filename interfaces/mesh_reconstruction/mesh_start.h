#pragma once

#include <vector>

#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Returns, by number of a material, how wide its steps are in sizes of cells, the cells included, so that
/// those of a plane sharp interface are some 0.3; 0 where no cell shows it.
std::vector<double> step_widths(const MeshData& data, MeshValues& values);

/// Sets the values from which correction starts. Values of sharp materials, whose width is 0, are distances
/// from the planes that cut off the fractions of mixed cells, and their continuation beside these; those of
/// blurred ones are the width times the normal quantile of the fraction.
void set_start_values(const MeshData& data, const std::vector<double>& widths, MeshValues& values);

}  // namespace adamas::interfaces
