#include "core/io/rectilinear_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// Places are evenly spaced if they are off by less than this part of a cell, beyond the rounding of floats.
constexpr double kEven = 1e-3;
/// Cells lie on a lattice if they are nearer to it than this part of their size; so do sizes of cells.
constexpr double kOnLattice = 1e-2;

/// The distance of evenly spaced places; 0 where they are not.
double even_distance(const std::vector<double>& places) {
  if (places.size() < 2) return 0;
  const auto cells = static_cast<double>(places.size() - 1);
  const double first = places.front(), last = places.back(), step = (last - first) / cells;
  const double rounding = std::numeric_limits<float>::epsilon() * std::max(std::abs(first), std::abs(last));
  if (!(step > 0) || !std::isfinite(step)) return 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double even = first + static_cast<double>(i) * step;
    if (!(std::abs(places[i] - even) <= kEven * step + rounding)) return 0;
  }
  return step;
}

class LevelFinder {
 public:
  LevelFinder(const std::string& name, const std::vector<RectilinearBlock>& blocks, bool flat, bool stated)
      : name_(name), blocks_(blocks), stated_(stated) {
    amr_.flat = flat;
  }

  std::optional<AmrBlocks> run() {
    if (!find_sizes()) return refuse("evenly spaced blocks of cells");
    find_levels();
    if (amr_.spacing.size() < 2) return {};
    if (!fit_spacing()) return refuse("blocks whose cells refine each other by a whole number");
    if (!place_blocks()) return refuse("blocks whose cells begin where others do");
    if (!stated_ && !fill_whole_cells() && !overlap()) return {};
    return std::move(amr_);
  }

 private:
  /// Returns that there are no levels. Throws Error where there should be.
  [[nodiscard]] std::optional<AmrBlocks> refuse(const char* expected) const {
    if (stated_ || (amr_.spacing.size() > 1 && overlap()))
      fail("{}: expected levels of {}, found others", name_, expected);
    return {};
  }

  bool find_sizes() {
    for (const RectilinearBlock& block : blocks_) {
      Vec3& size = sizes_.emplace_back();
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        const double step = even_distance(block.nodes[axis]);
        if (step == 0) return false;
        size[static_cast<int>(axis)] = step;
      }
    }
    return true;
  }

  /// Gives blocks with cells of one size one level, the greatest cells first.
  void find_levels() {
    std::vector<std::size_t> order(blocks_.size());
    for (std::size_t b = 0; b < order.size(); ++b) order[b] = b;
    std::ranges::stable_sort(
        order, [this](std::size_t a, std::size_t b) { return volume(sizes_[a]) > volume(sizes_[b]); });
    amr_.blocks.resize(blocks_.size());
    for (const std::size_t b : order) {
      if (amr_.spacing.empty() || !is_same(amr_.spacing.back(), sizes_[b])) amr_.spacing.push_back(sizes_[b]);
      amr_.blocks[b].level = amr_.spacing.size() - 1;
    }
  }

  /// Makes the sizes of all levels exact parts of that of the coarsest one, which its extent tells best.
  bool fit_spacing() {
    Vec3 low, high;
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      const auto a = static_cast<int>(axis);
      low[a] = std::numeric_limits<double>::infinity();
      high[a] = -low[a];
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        if (amr_.blocks[b].level != 0) continue;
        low[a] = std::min(low[a], blocks_[b].nodes[axis].front());
        high[a] = std::max(high[a], blocks_[b].nodes[axis].back());
      }
      amr_.spacing[0][a] = (high[a] - low[a]) / std::round((high[a] - low[a]) / amr_.spacing[0][a]);
      for (std::size_t l = 1; l < amr_.spacing.size(); ++l) {
        const double ratio = amr_.spacing[l - 1][a] / amr_.spacing[l][a], whole = std::round(ratio);
        if (!(whole >= 1 && std::abs(ratio - whole) <= kOnLattice * whole)) return false;
        amr_.spacing[l][a] = amr_.spacing[l - 1][a] / whole;
      }
    }
    amr_.origin = low;
    return true;
  }

  bool place_blocks() {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      AmrBlock& block = amr_.blocks[b];
      block.size = {1, 1, 1};
      block.left_out = blocks_[b].left_out;
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        const auto a = static_cast<int>(axis);
        const double first = blocks_[b].nodes[axis].front();
        const double rounding = std::numeric_limits<float>::epsilon() * std::abs(first);
        const double spacing = amr_.spacing[block.level][a], at = (first - amr_.origin[a]) / spacing;
        if (!(std::abs(at) < kMostCells)) return false;
        if (!(std::abs(at - std::round(at)) <= kOnLattice + rounding / spacing)) return false;
        block.begin[axis] = std::llround(at);
        block.size[axis] = static_cast<std::int64_t>(blocks_[b].nodes[axis].size()) - 1;
      }
    }
    return true;
  }

  /// Whether each finer block fills whole cells of the level above.
  [[nodiscard]] bool fill_whole_cells() const {
    return std::ranges::all_of(amr_.blocks, [this](const AmrBlock& block) {
      for (std::size_t axis = 0; block.level > 0 && axis < axes(); ++axis) {
        const auto a = static_cast<int>(axis);
        const auto ratio = std::llround(amr_.spacing[block.level - 1][a] / amr_.spacing[block.level][a]);
        if (block.begin[axis] % ratio != 0 || block.size[axis] % ratio != 0) return false;
      }
      return true;
    });
  }

  /// Whether two blocks of different levels have a part of space in common.
  [[nodiscard]] bool overlap() const {
    for (std::size_t a = 0; a < blocks_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (amr_.blocks[a].level != amr_.blocks[b].level && overlap(a, b)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool overlap(std::size_t a, std::size_t b) const {
    const Box3 &first = blocks_[a].taken, &second = blocks_[b].taken;
    for (int axis = 0; axis < static_cast<int>(axes()); ++axis) {
      const double common =
          std::min(first.max[axis], second.max[axis]) - std::max(first.min[axis], second.min[axis]);
      if (!(common > 0.5 * std::min(sizes_[a][axis], sizes_[b][axis]))) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_same(const Vec3& a, const Vec3& b) const {
    for (int axis = 0; axis < static_cast<int>(axes()); ++axis) {
      if (!(std::abs(a[axis] - b[axis]) <= kOnLattice * a[axis])) return false;
    }
    return true;
  }
  [[nodiscard]] double volume(const Vec3& size) const { return size.x * size.y * (amr_.flat ? 1 : size.z); }
  [[nodiscard]] std::size_t axes() const { return amr_.flat ? 2 : 3; }

  static constexpr double kMostCells = 1e9;  // from the origin to a block, along an axis

  const std::string& name_;
  const std::vector<RectilinearBlock>& blocks_;
  bool stated_;
  std::vector<Vec3> sizes_;  // of the cells of each block
  AmrBlocks amr_;
};

/// Blocks of one level, whose cells are those of one grid.
struct OneLevel {
  AmrBlocks amr;                            ///< with cells of the size 1
  std::array<std::vector<double>, 3> axes;  ///< the places of the grid's nodes
};

OneLevel blocks_of_grid(const std::string& name, const std::vector<RectilinearBlock>& blocks, bool flat) {
  OneLevel result;
  result.amr.spacing = {{1, 1, 1}};
  result.amr.flat = flat;
  result.amr.blocks.assign(blocks.size(), {0, {}, {1, 1, 1}, {}});
  for (std::size_t axis = 0; axis < (flat ? 2u : 3u); ++axis) {
    std::vector<double>& places = result.axes[axis];
    double least = std::numeric_limits<double>::infinity();
    for (const RectilinearBlock& block : blocks) {
      const auto& nodes = block.nodes[axis];
      places.insert(places.end(), nodes.begin(), nodes.end());
      for (std::size_t i = 1; i < nodes.size(); ++i) least = std::min(least, nodes[i] - nodes[i - 1]);
    }
    // Nodes of two blocks at one place differ by rounding.
    const double apart = 0.1 * least;
    std::ranges::sort(places);
    const auto same = [apart](double a, double b) { return b - a < apart; };
    places.erase(std::unique(places.begin(), places.end(), same), places.end());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto& nodes = blocks[b].nodes[axis];
      const auto begin = std::ranges::lower_bound(places, nodes.front() - apart);
      const auto cells = static_cast<std::int64_t>(nodes.size()) - 1;
      bool fits = places.end() - begin > cells;
      for (std::ptrdiff_t i = 0; fits && i <= cells; ++i)
        fits = std::abs(begin[i] - nodes[static_cast<std::size_t>(i)]) <= 2 * apart;
      if (!fits) fail("{}: expected blocks whose cells are those of one grid, found others", name);
      result.amr.blocks[b].begin[axis] = begin - places.begin();
      result.amr.blocks[b].size[axis] = cells;
    }
  }
  return result;
}

}  // namespace

std::optional<AmrBlocks> find_rectilinear_levels(const std::string& name,
                                                 const std::vector<RectilinearBlock>& blocks, bool flat,
                                                 bool stated) {
  return LevelFinder(name, blocks, flat, stated).run();
}

AmrSources add_rectilinear_cells(const std::string& name, const std::vector<RectilinearBlock>& blocks,
                                 bool flat, bool stated, MeshFile& file) {
  if (stated) {
    if (const auto levels = find_rectilinear_levels(name, blocks, flat, true))
      return add_amr_cells(name, *levels, file);
  }
  const OneLevel grid = blocks_of_grid(name, blocks, flat);
  AmrSources sources = add_amr_cells(name, grid.amr, file);
  for (Vec3& p : file.points) {
    for (std::size_t axis = 0; axis < (flat ? 2u : 3u); ++axis) {
      double& at = p[static_cast<int>(axis)];
      at = grid.axes[axis][static_cast<std::size_t>(std::llround(at))];
    }
  }
  return sources;
}

}  // namespace adamas::io
