#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/multi_material_data.h"

namespace adamas::bench {

/// The surfaces that a method makes of volume fractions on cells.
struct MaterialSurfaces {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// fractions[material][cell] is the part of a cell that the surfaces leave to a material.
  std::vector<std::vector<double>> fractions;
  double seconds = 0;  ///< time to make the surfaces, on one thread
};

/// Returns the material with the greatest fraction in each cell, the first one of equal ones.
std::vector<std::uint16_t> greatest_material(const MultiMaterialData& data);

/// Returns piecewise linear interfaces (PLIC) by vtkYoungsMaterialInterface: one plane after the other per
/// cell, with normals by central differences of the fractions, weighted 1, 2, 1 across (Youngs).
MaterialSurfaces youngs_interfaces(const MultiMaterialData& data);

/// Runs vtkDiscreteFlyingEdges3D on the greatest material of each cell, each material separately, and then
/// `smoothing_iterations` of vtkWindowedSincPolyDataFilter.
MaterialSurfaces discrete_flying_edges(const MultiMaterialData& data, int smoothing_iterations);

/// The cost of surfaces of labels.
struct LabelSurfaceCost {
  double seconds = 0, smoothed_seconds = 0;  ///< without smoothing, and with it, on one thread
  std::uint64_t triangles = 0;               ///< those between two labels count for both
};

/// Runs vtkDiscreteFlyingEdges3D on all labels at once, and then 20 iterations of
/// vtkWindowedSincPolyDataFilter. The data must have labels.
LabelSurfaceCost label_flying_edges(const MultiMaterialData& data);

/// Runs vtkFlyingEdges3D on each material's fractions separately, at one half.
MaterialSurfaces fraction_contours(const MultiMaterialData& data);

}  // namespace adamas::bench
