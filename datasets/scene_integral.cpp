#include "datasets/scene_integral.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::datasets {

namespace {

constexpr double kTetrahedron = 1.0 / 6;

Box3 octant(const Box3& box, unsigned o) {
  const Vec3 middle = box.center();
  Box3 part;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = ((o >> axis) & 1u) != 0;
    part.min[axis] = upper ? middle[axis] : box.min[axis];
    part.max[axis] = upper ? box.max[axis] : middle[axis];
  }
  return part;
}

}  // namespace

double positive_fraction(const std::array<double, 4>& values) {
  std::array<double, 4> v = values;
  std::sort(v.begin(), v.end(), std::greater<>());
  const auto [a, b, c, d] = v;
  if (!(a > 0)) return 0;
  if (d > 0) return 1;
  if (!(b > 0)) return a / (a - b) * (a / (a - c)) * (a / (a - d));
  if (c > 0) return 1 - d / (d - a) * (d / (d - b)) * (d / (d - c));
  // The part is a wedge between the edge of the two positive vertices and the cut; it is divided into three
  // tetrahedra.
  const double ac = a / (a - c), ad = a / (a - d), bc = b / (b - c), bd = b / (b - d);
  return ac * ad + bc * bd * (1 - ac) + ac * bd * (1 - ad);
}

CellFractions::CellFractions(const Scene& scene, int depth)
    : depth_(depth),
      levels_(static_cast<std::size_t>(depth) + 1, LocalScene(scene)),
      fine_(scene.materials().size()),
      coarse_(scene.materials().size()),
      errors_(scene.materials().size()) {
  ADAMAS_ASSERT(depth >= 1);
}

const std::vector<double>& CellFractions::integrate(const LocalScene& parent, const Box3& box) {
  std::fill(fine_.begin(), fine_.end(), 0.0);
  std::fill(coarse_.begin(), coarse_.end(), 0.0);
  visit(parent, box, 0, 1, true);
  combine();
  return fine_;
}

void CellFractions::visit(const LocalScene& parent, const Box3& box, int level, double weight,
                          bool on_coarse) {
  LocalScene& local = levels_[static_cast<std::size_t>(level)];
  local.restrict_to(parent, box);
  if (const auto owner = local.sole_owner()) {
    fine_[owner->value] += weight;
    if (on_coarse) coarse_[owner->value] += weight;
    return;
  }
  if (local.linear()) {
    std::vector<double> sums(fine_.size());
    cut(local, box, weight, sums);
    for (std::size_t m = 0; m < sums.size(); ++m) {
      fine_[m] += sums[m];
      if (on_coarse) coarse_[m] += sums[m];
    }
    return;
  }
  if (level == depth_) return cut(local, box, weight, fine_);
  const bool last = level + 1 == depth_;
  if (last) cut(local, box, weight, coarse_);
  for (unsigned o = 0; o < 8; ++o) visit(local, octant(box, o), level + 1, weight / 8, !last);
}

void CellFractions::cut(const LocalScene& local, const Box3& box, double weight, std::vector<double>& sums) {
  cube_.sample(local, box.corners());
  const auto candidates = local.candidates();
  if (candidates.size() == 2 && local.functions().size() == 2) return cut_pair(local, weight, sums);
  for (std::size_t t = 0; t < kCubeTetrahedra.size(); ++t) {
    cube_.problem(local, t, problem_);
    parts_.clear();
    partition_tetrahedron(problem_, parts_);
    for (const OwnedTetrahedron& part : parts_) {
      sums[part.owner] += weight * kTetrahedron * volume_fraction(part.corners);
    }
  }
}

void CellFractions::cut_pair(const LocalScene& local, double weight, std::vector<double>& sums) const {
  const SceneCandidate &a = local.candidates()[0], &b = local.candidates()[1];
  double above = 0;
  for (const auto& corners : kCubeTetrahedra) {
    std::array<double, 4> difference;
    for (std::size_t i = 0; i < 4; ++i) {
      difference[i] = cube_.value(a.functions[0], corners[i]) - cube_.value(b.functions[0], corners[i]);
    }
    above += kTetrahedron * positive_fraction(difference);
  }
  sums[a.owner.value] += weight * above;
  sums[b.owner.value] += weight * (1 - above);
}

void CellFractions::combine() {
  bool inside = true;
  for (std::size_t m = 0; m < fine_.size(); ++m) {
    errors_[m] = std::abs(fine_[m] - coarse_[m]);
    // The error of linear interpolation falls by a factor of four from depth to depth.
    coarse_[m] = fine_[m] + (fine_[m] - coarse_[m]) / 3;
    inside = inside && coarse_[m] >= 0 && coarse_[m] <= 1;
  }
  if (inside) std::swap(fine_, coarse_);
}

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
