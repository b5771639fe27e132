#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "datasets/scene.h"

namespace adamas::datasets {

/// A grid of equal cells over a box. Throws Error if a dimension is zero.
RectilinearGrid uniform_grid(const Box3& box, const std::array<std::size_t, 3>& cells);

/// The cells of a grid in blocks of eight along each axis. Cells are visited block by block, so that
/// functions that cannot matter are dropped once for all cells of a block.
class CellBlocks {
 public:
  using Cell = std::array<std::size_t, 3>;

  explicit CellBlocks(const RectilinearGrid& grid);
  [[nodiscard]] std::size_t count() const { return blocks_[0] * blocks_[1] * blocks_[2]; }
  /// The first cell of a block, and the end of its cells along each axis.
  [[nodiscard]] std::pair<Cell, Cell> cells(std::size_t block) const;

 private:
  Cell sites_{}, blocks_{};
};

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
