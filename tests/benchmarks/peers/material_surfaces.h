#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/multi_material_data.h"

namespace adamas::bench {

/// What a method makes of volume fractions on cells.
struct MaterialSurfaces {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// fractions[material][cell]: what the surfaces leave of each cell to each material.
  std::vector<std::vector<double>> fractions;
  double seconds = 0;  ///< to make the surfaces, one thread
};

/// The material with the greatest fraction in each cell, the first of equal ones.
std::vector<std::uint16_t> greatest_material(const MultiMaterialData& data);

/// Piecewise linear interfaces (PLIC): vtkYoungsMaterialInterface, one plane after the other per cell, with
/// normals by central differences of the fractions, weighted 1, 2, 1 across (Youngs).
MaterialSurfaces youngs_interfaces(const MultiMaterialData& data);

/// vtkDiscreteFlyingEdges3D on the greatest material of each cell, each material apart. With
/// `smoothing_iterations` of vtkWindowedSincPolyDataFilter.
MaterialSurfaces discrete_flying_edges(const MultiMaterialData& data, int smoothing_iterations);

/// vtkFlyingEdges3D of each material's fractions, apart, at one half.
MaterialSurfaces fraction_contours(const MultiMaterialData& data);

}  // namespace adamas::bench
