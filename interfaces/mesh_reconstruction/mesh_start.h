#pragma once

#include <vector>

#include "interfaces/mesh_reconstruction/mesh_films.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"
#include "interfaces/mesh_reconstruction/mesh_walls.h"

namespace adamas::interfaces {

/// The steps of the fractions of materials.
struct Steps {
  /// By number of a material: the width in extents of cells along the gradient, the cells included, so that
  /// that of a plane sharp interface is some 0.3; 0 where no cell shows it.
  std::vector<double> widths;
  /// By entry of active cells: the extent of the cell along the gradient of the fraction, or the size of the
  /// cell where there is no gradient.
  std::vector<double> extents;
};
/// Cells that walls fill do not count, and films are no steps.
Steps find_steps(const MeshWalls& walls, const MeshFilms& films, MeshValues& values);

/// Sets the values from which correction starts. Values of sharp materials, whose width in `widths` is 0, are
/// distances from the planes that cut off the fractions of mixed cells, and their continuation beside these;
/// those of blurred ones are the width times the normal quantile of the fraction.
/// Where materials are blurred, those of walls and in them are set as MeshWalls does.
/// In and beside films, values are those of their layers.
void set_start_values(const std::vector<double>& widths, const std::vector<double>& extents,
                      const MeshFilms& films, MeshWalls& walls, MeshValues& values);

}  // namespace adamas::interfaces
