#include "datasets/scene_integral.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "datasets/cell_fractions.h"

namespace adamas::datasets {

namespace {

constexpr std::size_t kBlock = 8;
constexpr std::size_t kBlocksPerStep = 512;

using Cell = CellBlocks::Cell;

Box3 cell_box(const RectilinearGrid& grid, const Cell& first, const Cell& last) {
  return {{grid.nodes[0][first[0]], grid.nodes[1][first[1]], grid.nodes[2][first[2]]},
          {grid.nodes[0][last[0]], grid.nodes[1][last[1]], grid.nodes[2][last[2]]}};
}

class Integration {
 public:
  using Sink = std::function<void(std::size_t, const std::vector<double>&)>;

  Integration(const Scene& scene, const RectilinearGrid& grid, int depth, const Sink& sink)
      : scene_(scene), grid_(grid), depth_(depth), sink_(sink), blocks_(grid), sums_(blocks_.count()) {}

  [[nodiscard]] std::size_t block_count() const { return blocks_.count(); }

  void run_blocks(std::size_t begin, std::size_t end) {
    CellFractions fractions(scene_, depth_);
    const LocalScene whole(scene_);
    LocalScene local(scene_);
    for (std::size_t b = begin; b < end; ++b) run_block(b, whole, local, fractions);
  }

  [[nodiscard]] SceneIntegral total() const {
    SceneIntegral result;
    result.volumes.resize(scene_.materials().size());
    result.errors.resize(scene_.materials().size());
    for (const SceneIntegral& sum : sums_) {
      for (MaterialId m(0); m.value < result.volumes.size(); ++m.value) {
        result.volumes[m] += sum.volumes[m];
        result.errors[m] += sum.errors[m];
      }
    }
    return result;
  }

 private:
  void run_block(std::size_t block, const LocalScene& whole, LocalScene& local, CellFractions& fractions) {
    const auto [first, last] = blocks_.cells(block);
    local.restrict_to(whole, cell_box(grid_, first, last));
    SceneIntegral& sum = sums_[block];
    sum.volumes.resize(scene_.materials().size());
    sum.errors.resize(scene_.materials().size());
    for (std::size_t k = first[2]; k < last[2]; ++k) {
      for (std::size_t j = first[1]; j < last[1]; ++j) {
        for (std::size_t i = first[0]; i < last[0]; ++i) {
          const Box3 box = cell_box(grid_, {i, j, k}, {i + 1, j + 1, k + 1});
          const auto& values = fractions.integrate(local, box);
          const double volume = box.volume();
          for (MaterialId m(0); m.value < sum.volumes.size(); ++m.value) {
            sum.volumes[m] += volume * values[m.value];
            sum.errors[m] += volume * fractions.errors()[m.value];
          }
          sink_(grid_.site_index(i, j, k), values);
        }
      }
    }
  }

  const Scene& scene_;
  const RectilinearGrid& grid_;
  int depth_;
  const Sink& sink_;
  CellBlocks blocks_;
  std::vector<SceneIntegral> sums_;
};

}  // namespace

CellBlocks::CellBlocks(const RectilinearGrid& grid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sites_[axis] = grid.sites(static_cast<int>(axis));
    blocks_[axis] = (sites_[axis] + kBlock - 1) / kBlock;
  }
}

std::pair<Cell, Cell> CellBlocks::cells(std::size_t block) const {
  Cell first{block % blocks_[0], block / blocks_[0] % blocks_[1], block / (blocks_[0] * blocks_[1])}, last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] *= kBlock;
    last[axis] = std::min(first[axis] + kBlock, sites_[axis]);
  }
  return {first, last};
}

RectilinearGrid uniform_grid(const Box3& box, const std::array<std::size_t, 3>& cells) {
  RectilinearGrid grid;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t n = cells[static_cast<std::size_t>(axis)];
    if (n == 0) {
      fail("grid: expected at least one cell along each axis, found {}x{}x{}", cells[0], cells[1], cells[2]);
    }
    auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
    nodes.resize(n + 1);
    for (std::size_t i = 0; i <= n; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(n);
      nodes[i] = i == n ? box.max[axis] : box.min[axis] + t * (box.max[axis] - box.min[axis]);
    }
  }
  return grid;
}

SceneIntegral integrate_scene(const Scene& scene, const RectilinearGrid& grid, int depth,
                              const std::function<void(std::size_t, const std::vector<double>&)>& sink,
                              Progress& progress) {
  Integration integration(scene, grid, depth, sink);
  const std::size_t count = integration.block_count();
  for (std::size_t begin = 0; begin < count; begin += kBlocksPerStep) {
    progress.step("sampling the scene", static_cast<double>(begin) / static_cast<double>(count));
    const std::size_t size = std::min(kBlocksPerStep, count - begin);
    parallel_chunks(size, 4, [&](std::size_t first, std::size_t last) {
      integration.run_blocks(begin + first, begin + last);
    });
  }
  progress.step("sampling the scene", 1);
  return integration.total();
}

}  // namespace adamas::datasets
