#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "datasets/scene.h"

namespace adamas::datasets {

/// A grid of equal cells over a box. Throws Error if a dimension is zero.
RectilinearGrid uniform_grid(const Box3& box, const std::array<std::size_t, 3>& cells);

/// The volumes of a scene's materials in its box.
struct SceneIntegral {
  IdVector<MaterialId, double> volumes;
  /// Sums over the cells of the differences between the last two depths: zero, to round-off, for planes.
  IdVector<MaterialId, double> errors;
};

/// Integrates the materials' volume fractions over each cell of a grid (see CellFractions) and passes them to
/// `sink(site, fractions)`; calls for different sites come from several threads. The result is the same on
/// any number of threads.
SceneIntegral integrate_scene(const Scene& scene, const RectilinearGrid& grid, int depth,
                              const std::function<void(std::size_t, const std::vector<double>&)>& sink,
                              Progress& progress = SilentProgress::instance());

}  // namespace adamas::datasets
