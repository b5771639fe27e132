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
#include "core/geometry/ownership_problem.h"
#include "datasets/local_scene.h"
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

/// Integrates the volumes of a scene's materials over boxes. A box is divided in eight as long as it has no
/// certain owner and its functions are not linear; at the last depth its six tetrahedra are cut along linear
/// interpolations. The result is exact for planes, to round-off; for curved surfaces the results of two
/// depths are extrapolated to a spacing of zero.
class CellFractions {
 public:
  /// `depth` >= 1 is the number of divisions.
  CellFractions(const Scene& scene, int depth);
  /// Fractions of the box by material, adding up to 1. `parent` must cover the box.
  const std::vector<double>& integrate(const LocalScene& parent, const Box3& box);
  /// For each material the difference between the last two depths in the last box: in practice a bound of the
  /// error of its fraction.
  [[nodiscard]] const std::vector<double>& errors() const { return errors_; }

 private:
  void visit(const LocalScene& parent, const Box3& box, int level, double weight, bool on_coarse);
  void cut(const LocalScene& local, const Box3& box, double weight, std::vector<double>& sums);
  void cut_pair(const LocalScene& local, double weight, std::vector<double>& sums) const;
  void combine();

  int depth_;
  std::vector<LocalScene> levels_;
  CubeValues cube_;
  OwnershipProblem problem_;
  std::vector<OwnedTetrahedron> parts_;
  std::vector<double> fine_, coarse_, errors_;
};

/// Fraction of a tetrahedron where a linear function, given at the vertices, is positive.
double positive_fraction(const std::array<double, 4>& values);

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
