#include "core/io/amr_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "core/io/mesh_builder.h"

namespace adamas::io {

namespace {

using Index3 = std::array<std::int64_t, 3>;
using Key = std::uint64_t;

/// Places along an axis, in cells of the finest level, are below this.
constexpr std::int64_t kMostPlaces = std::int64_t{1} << 21;

Key key_of(const Index3& at) {
  return (static_cast<Key>(at[2]) << 42) | (static_cast<Key>(at[1]) << 21) | static_cast<Key>(at[0]);
}

Index3 index_of(Key key) {
  constexpr Key kMask = kMostPlaces - 1;
  return {static_cast<std::int64_t>(key & kMask), static_cast<std::int64_t>((key >> 21) & kMask),
          static_cast<std::int64_t>(key >> 42)};
}

/// Calls `use` with each index of a box of cells.
template <class Use>
void for_each_index(const Index3& begin, const Index3& end, const Use& use) {
  for (std::int64_t z = begin[2]; z < end[2]; ++z) {
    for (std::int64_t y = begin[1]; y < end[1]; ++y) {
      for (std::int64_t x = begin[0]; x < end[0]; ++x) use(Index3{x, y, z});
    }
  }
}

/// The cells of a level, by the keys of their indices.
struct Level {
  Index3 ratio{1, 1, 1};       ///< how many cells of the next level lie along an edge
  Index3 step{1, 1, 1};        ///< the size of a cell, in cells of the finest level
  std::vector<Key> leaves{};   ///< cells that nothing finer covers, sorted
  std::vector<Key> refined{};  ///< cells that finer ones cover, sorted, whether a block has them or not

  [[nodiscard]] bool is_leaf(const Index3& cell) const {
    return std::ranges::binary_search(leaves, key_of(cell));
  }
  [[nodiscard]] bool is_refined(const Index3& cell) const {
    return std::ranges::binary_search(refined, key_of(cell));
  }
};

/// A rectangle across an axis: a face of the cell `cell` of a level, that where the cell begins.
struct Square {
  std::size_t level;
  Index3 cell;
};

class AmrCells {
 public:
  AmrCells(const std::string& name, const AmrBlocks& amr, MeshFile& file)
      : name_(name), amr_(amr), file_(file) {}

  AmrSources run() {
    file_.flat = amr_.flat;
    set_levels();
    find_first();
    find_leaves();
    find_points();
    add_cells();
    return std::move(sources_);
  }

 private:
  void set_levels() {
    levels_.resize(amr_.spacing.size());
    for (std::size_t l = levels_.size() - 1; l-- > 0;) {
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        const auto a = static_cast<int>(axis);
        const double ratio = amr_.spacing[l][a] / amr_.spacing[l + 1][a], whole = std::round(ratio);
        if (!(whole >= 1 && whole <= 64 && std::abs(ratio - whole) <= 1e-3 * whole))
          fail("{}: expected levels that refine each other by a whole number, found {:g} from level {}",
               name_, ratio, l);
        levels_[l].ratio[axis] = static_cast<std::int64_t>(whole);
        levels_[l].step[axis] = levels_[l].ratio[axis] * levels_[l + 1].step[axis];
        if (levels_[l].step[axis] >= kMostPlaces) fail_for_size();
      }
    }
  }

  /// Finds the first cell along each axis, in cells of the finest level, from which indices count then.
  void find_first() {
    first_.fill(std::numeric_limits<std::int64_t>::max());
    std::array<std::int64_t, 3> last{};
    last.fill(std::numeric_limits<std::int64_t>::min());
    const Index3& coarsest = levels_[0].step;
    for (const AmrBlock& block : amr_.blocks) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t step = levels_[block.level].step[axis];
        if (std::abs(block.begin[axis]) >= kMostPlaces || block.size[axis] >= kMostPlaces) fail_for_size();
        first_[axis] = std::min(first_[axis], block.begin[axis] * step);
        last[axis] = std::max(last[axis], (block.begin[axis] + block.size[axis]) * step);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // All levels count from a cell of the coarsest, one before the first, so that neighbours have indices.
      const std::int64_t cells = first_[axis] / coarsest[axis] - (first_[axis] % coarsest[axis] < 0 ? 1 : 0);
      first_[axis] = (cells - 1) * coarsest[axis];
      if (last[axis] - first_[axis] + coarsest[axis] >= kMostPlaces) fail_for_size();
    }
  }

  [[noreturn]] void fail_for_size() const {
    fail("{}: expected fewer than {} of the smallest cells along an axis, found more", name_, kMostPlaces);
  }

  /// The index of a block's first cell, counted from first_.
  [[nodiscard]] Index3 begin_of(const AmrBlock& block) const {
    Index3 begin{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      begin[axis] = block.begin[axis] - first_[axis] / levels_[block.level].step[axis];
    return begin;
  }

  /// Calls `use` with the number and the index of each cell of a block that is taken.
  template <class Use>
  void for_each_cell(const AmrBlock& block, const Use& use) const {
    const Index3 begin = begin_of(block);
    std::size_t cell = 0;
    for_each_index(begin, {begin[0] + block.size[0], begin[1] + block.size[1], begin[2] + block.size[2]},
                   [&](const Index3& at) {
                     if (block.left_out.empty() || !block.left_out[cell]) use(cell, at);
                     ++cell;
                   });
  }

  void find_leaves() {
    std::vector<std::vector<Key>> cells(levels_.size());
    for (const AmrBlock& block : amr_.blocks) {
      for_each_cell(block, [&](std::size_t, const Index3& at) { cells[block.level].push_back(key_of(at)); });
    }
    for (std::size_t l = levels_.size(); l-- > 0;) {
      sort_unique(cells[l]);
      if (l + 1 < levels_.size()) find_refined(l);
      std::ranges::set_difference(cells[l], levels_[l].refined, std::back_inserter(levels_[l].leaves));
    }
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
      const Level &coarse = levels_[l], &fine = levels_[l + 1];
      const auto children = static_cast<std::size_t>(coarse.ratio[0] * coarse.ratio[1] * coarse.ratio[2]);
      if (coarse.refined.size() * children != fine.leaves.size() + fine.refined.size())
        fail("{}: expected cells of level {} that finer ones cover whole or not at all, found others", name_,
             l);
    }
  }

  /// Finds the cells of a level of which the next one has a part.
  void find_refined(std::size_t l) {
    for (const std::vector<Key>* finer : {&levels_[l + 1].leaves, &levels_[l + 1].refined}) {
      for (const Key key : *finer) {
        Index3 at = index_of(key);
        for (std::size_t axis = 0; axis < 3; ++axis) at[axis] /= levels_[l].ratio[axis];
        levels_[l].refined.push_back(key_of(at));
      }
    }
    sort_unique(levels_[l].refined);
  }

  /// Calls `use` with each corner of a cell, 0 to 7 or, if cells are flat, 0 to 3, and its place.
  template <class Use>
  void for_each_corner(std::size_t l, const Index3& cell, const Use& use) const {
    const Index3& step = levels_[l].step;
    for (std::size_t corner = 0; corner < (amr_.flat ? 4u : 8u); ++corner) {
      Index3 at{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis] = (cell[axis] + static_cast<std::int64_t>((corner >> axis) & 1)) * step[axis];
      use(corner, at);
    }
  }

  /// Finds the corners of all leaves. Points get their numbers when the first cell has them.
  void find_points() {
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      for (const Key key : levels_[l].leaves)
        for_each_corner(l, index_of(key),
                        [&](std::size_t, const Index3& at) { places_.push_back(key_of(at)); });
    }
    sort_unique(places_);
    if (places_.size() >= kNone)
      fail("{}: expected fewer than {} points, found {}", name_, kNone, places_.size());
    numbers_.assign(places_.size(), kNone);
  }

  /// Returns which of places_ a place is; their number if it is none of them.
  [[nodiscard]] std::size_t find_place(const Index3& at) const {
    const Key key = key_of(at);
    const auto found = std::ranges::lower_bound(places_, key);
    return found != places_.end() && *found == key ? static_cast<std::size_t>(found - places_.begin())
                                                   : places_.size();
  }

  void add_cells() {
    sources_.cells.resize(amr_.blocks.size());
    sources_.points.resize(amr_.blocks.size());
    taken_.resize(levels_.size());
    for (std::size_t l = 0; l < levels_.size(); ++l) taken_[l].assign(levels_[l].leaves.size(), false);
    for (const bool numbering : {true, false}) {
      for (std::size_t b = 0; b < amr_.blocks.size(); ++b) {
        const AmrBlock& block = amr_.blocks[b];
        for_each_cell(block, [&](std::size_t cell, const Index3& at) {
          const std::vector<Key>& leaves = levels_[block.level].leaves;
          const auto found = std::ranges::lower_bound(leaves, key_of(at));
          if (found == leaves.end() || *found != key_of(at)) return;
          // The first of two blocks that overlap has the cell: it is marked, and the mark taken away again.
          const auto leaf = static_cast<std::size_t>(found - leaves.begin());
          if (taken_[block.level][leaf] == numbering) return;
          taken_[block.level][leaf] = numbering;
          if (numbering) {
            number_corners(b, cell, at);
          } else {
            add_cell(block.level, at);
            sources_.cells[b].push_back(static_cast<std::int64_t>(cell));
          }
        });
      }
    }
  }

  void number_corners(std::size_t b, std::size_t cell, const Index3& at) {
    const AmrBlock& block = amr_.blocks[b];
    const auto number = static_cast<std::int64_t>(cell);
    const Index3 in_block{number % block.size[0], number / block.size[0] % block.size[1],
                          number / block.size[0] / block.size[1]};
    for_each_corner(block.level, at, [&](std::size_t corner, const Index3& place) {
      std::uint32_t& own = numbers_[find_place(place)];
      if (own != kNone) return;
      own = static_cast<std::uint32_t>(file_.points.size());
      file_.points.push_back(position(place));
      const auto beside = [&](std::size_t axis) {
        return in_block[axis] + static_cast<std::int64_t>((corner >> axis) & 1);
      };
      sources_.points[b].push_back(beside(0) +
                                   (block.size[0] + 1) * (beside(1) + (block.size[1] + 1) * beside(2)));
    });
  }

  [[nodiscard]] Vec3 position(const Index3& place) const {
    Vec3 p = amr_.origin;
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      const auto a = static_cast<int>(axis);
      p[a] += static_cast<double>(place[axis] + first_[axis]) * amr_.spacing.back()[a];
    }
    return p;
  }

  void add_cell(std::size_t l, const Index3& cell) {
    if (amr_.flat) {
      add_face(2, {l, cell});
    } else {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int64_t side : {0, 1}) {
          Index3 beyond = cell, place = cell;
          beyond[axis] += side == 0 ? -1 : 1;
          place[axis] += side;
          squares_.clear();
          collect_squares(axis, {l, place}, beyond);
          for (const Square& square : squares_) add_face(axis, square);
        }
      }
    }
    end_cell(file_);
  }

  /// Finds the rectangles that a face has, as the cells beyond it divide it. `beyond`: the neighbour at the
  /// level of the face.
  void collect_squares(std::size_t axis, const Square& square, const Index3& beyond) {
    const Level& level = levels_[square.level];
    if (!level.is_refined(beyond)) {
      squares_.push_back(square);
      return;
    }
    Index3 begin{}, end{};
    for (std::size_t a = 0; a < 3; ++a) {
      begin[a] = square.cell[a] * level.ratio[a];
      end[a] = begin[a] + (a == axis ? 1 : level.ratio[a]);
    }
    const bool before = beyond[axis] < square.cell[axis];
    for_each_index(begin, end, [&](const Index3& at) {
      Index3 neighbour = at;
      neighbour[axis] -= before ? 1 : 0;
      collect_squares(axis, {square.level + 1, at}, neighbour);
    });
  }

  /// Appends a rectangle across an axis, with the points on its edges.
  void add_face(std::size_t axis, const Square& square) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Index3& step = levels_[square.level].step;
    Index3 at{};
    for (std::size_t a = 0; a < 3; ++a) at[a] = square.cell[a] * step[a];
    face_.clear();
    const auto walk = [&](std::size_t along, bool forward) {
      face_.push_back(numbers_[find_place(at)]);
      const std::int64_t from = at[along];
      add_between(square.level, along, at, forward);
      at[along] = from + (forward ? step[along] : -step[along]);
    };
    walk(u, true);
    walk(v, true);
    walk(u, false);
    walk(v, false);
    append_face(face_, file_);
  }

  /// Appends the points of finer cells inside an edge of a cell, in the direction of the walk. A level has
  /// none if the one above it has none: the corners of a cell's parent are corners of cells too.
  void add_between(std::size_t l, std::size_t along, const Index3& from, bool forward) {
    if (l + 1 == levels_.size()) return;
    const std::int64_t ratio = levels_[l].ratio[along],
                       step = forward ? levels_[l + 1].step[along] : -levels_[l + 1].step[along];
    if (ratio == 1) {
      add_between(l + 1, along, from, forward);
      return;
    }
    Index3 at = from;
    at[along] += step;
    if (find_place(at) == places_.size()) return;
    for (std::int64_t i = 0; i < ratio; ++i) {
      at[along] = from[along] + i * step;
      if (i > 0) face_.push_back(numbers_[find_place(at)]);
      add_between(l + 1, along, at, forward);
    }
  }

  [[nodiscard]] std::size_t axes() const { return amr_.flat ? 2 : 3; }

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const std::string& name_;
  const AmrBlocks& amr_;
  MeshFile& file_;
  std::vector<Level> levels_;
  Index3 first_{};
  std::vector<Key> places_;               // of all points, sorted
  std::vector<std::uint32_t> numbers_;    // of places_ among the mesh's points
  std::vector<std::vector<bool>> taken_;  // per level and leaf
  std::vector<Square> squares_;           // of one face
  std::vector<std::uint32_t> face_;
  AmrSources sources_;
};

}  // namespace

AmrSources add_amr_cells(const std::string& name, const AmrBlocks& blocks, MeshFile& file) {
  return AmrCells(name, blocks, file).run();
}

}  // namespace adamas::io
