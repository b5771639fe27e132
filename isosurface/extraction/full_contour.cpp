#include "isosurface/extraction/full_contour.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/contour/cell_contour.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

bool in_file_order(LatticePoint a, LatticePoint b) {
  return std::array{a.k, a.j, a.i} < std::array{b.k, b.j, b.i};
}

/// The samples of a page of the finest LOD and of the points round it, from one before the page to two behind
/// it: coordinates from -1 to 17. So all corners of the page's cells have all their neighbours.
template <class Sample>
class PageBox {
 public:
  using Word = OrderedWord<Sample>;
  static constexpr std::int32_t kFirst = -1, kLast = 17;

  /// Makes an empty box. The diamonds must outlive it.
  explicit PageBox(StoredDiamonds<Sample>& diamonds) : diamonds_(diamonds) {}

  /// Copies the samples of a page, and finds the side of the contour on which each lies. Throws PageLost.
  void load(LatticePoint block) {
    using Side = typename StoredDiamonds<Sample>::Side;
    block_ = block;
    const PageGrid& grid = diamonds_.grid();
    const LatticePoint blocks = grid.blocks(0), last = grid.last();
    for (int axis = 0; axis < 3; ++axis)
      cells_[axis] = std::clamp(last[axis] - PageGrid::kSide * block[axis], 0, PageGrid::kSide);
    // For pages that the contour does not cross, their side is enough, except for the corners of crossed
    // cells of this page.
    std::array<LatticePoint, 26> guessed;
    std::size_t guesses = 0;
    for (int n = 0; n < 27; ++n) {
      const LatticePoint step = step_around(n), at = block + step;
      if (!is_below(at, blocks)) continue;
      const Side side = step == LatticePoint{} ? Side::kBoth : diamonds_.side({0, at});
      if (side == Side::kBoth) {
        copy(step);
      } else {
        fill(step, static_cast<Word>(diamonds_.least_above() - (side == Side::kAbove ? 0 : 1)));
        if (std::min({step.i, step.j, step.k}) >= 0) guessed[guesses++] = step;
      }
    }
    find_above();
    for (std::size_t n = 0; n < guesses; ++n) {
      if (has_crossed_cells_at(guessed[n])) copy(guessed[n]);
    }
    is_finite_ = true;
    if constexpr (std::is_floating_point_v<Sample>) find_finite();
  }

  /// Returns the sample at a corner of a crossed cell of the page, or at the other end of a crossed edge from
  /// such a corner. Other samples may not have been loaded.
  [[nodiscard]] double value(LatticePoint q) const { return from_ordered<Sample>(words_[place(q)]); }
  /// Returns which samples of a row along i are not below the isovalue: bit i + 1 is the sample at i.
  [[nodiscard]] std::uint32_t above(std::int32_t j, std::int32_t k) const { return above_[row(j, k)]; }
  /// Returns the cells of the page in a row that the contour crosses: bit i is the cell whose first corner is
  /// at i.
  [[nodiscard]] std::uint32_t crossed_cells(std::int32_t j, std::int32_t k) const {
    if (j >= cells_.j || k >= cells_.k) return 0;
    std::uint32_t any = 0, all = ~0u;
    for (const std::uint32_t bits : {above(j, k), above(j + 1, k), above(j, k + 1), above(j + 1, k + 1)}) {
      any |= bits | bits >> 1;
      all &= bits & bits >> 1;
    }
    return (any & ~all) >> -kFirst & ((1u << cells_.i) - 1);
  }
  /// Returns whether the samples of the page and round it are all finite.
  [[nodiscard]] bool is_finite() const { return is_finite_; }
  /// Returns the number of cells of the page along each axis.
  [[nodiscard]] LatticePoint cells() const { return cells_; }

 private:
  static constexpr std::int32_t kSide = kLast - kFirst + 1;

  static std::size_t row(std::int32_t j, std::int32_t k) {
    return static_cast<std::size_t>(j - kFirst + kSide * (k - kFirst));
  }
  static std::size_t place(LatticePoint q) {
    return static_cast<std::size_t>(q.i - kFirst) + static_cast<std::size_t>(kSide) * row(q.j, q.k);
  }
  /// The part of the box that lies on a page at a step along an axis: the first coordinate and the number of
  /// points.
  struct Run {
    std::int32_t first, count;
    explicit Run(std::int32_t step)
        : first(step < 0 ? -1 : 16 * step),
          count(step < 0   ? 1
                : step > 0 ? 2
                           : 16) {}
  };

  void copy(LatticePoint step) {
    const PageSamples<Word>& page = diamonds_.pages().needed_samples({0, block_ + step});
    const Run i(step.i), j(step.j), k(step.k);
    for (std::int32_t z = k.first; z < k.first + k.count; ++z) {
      for (std::int32_t y = j.first; y < j.first + j.count; ++y) {
        const Word* from = page.samples.data() + PageGrid::place({i.first, y, z}, 0);
        std::copy_n(from, i.count, words_.data() + place({i.first, y, z}));
      }
    }
  }
  void fill(LatticePoint step, Word word) {
    const Run i(step.i), j(step.j), k(step.k);
    for (std::int32_t z = k.first; z < k.first + k.count; ++z) {
      for (std::int32_t y = j.first; y < j.first + j.count; ++y)
        std::fill_n(words_.data() + place({i.first, y, z}), i.count, word);
    }
  }
  void find_above() {
    const std::uint64_t least = diamonds_.least_above();
    for (std::size_t row = 0; row < above_.size(); ++row) {
      const Word* words = words_.data() + static_cast<std::size_t>(kSide) * row;
      std::uint32_t bits = 0;
      for (std::int32_t n = 0; n < kSide; ++n) bits |= (words[n] >= least ? 1u : 0u) << n;
      above_[row] = bits;
    }
  }
  /// Checks only the samples of the data.
  void find_finite() {
    const LatticePoint last = diamonds_.grid().last();
    std::array<std::int32_t, 3> begin{}, end{};
    for (int axis = 0; axis < 3; ++axis) {
      begin[static_cast<std::size_t>(axis)] = block_[axis] == 0 ? 0 : kFirst;
      end[static_cast<std::size_t>(axis)] = std::min(kLast, last[axis] - PageGrid::kSide * block_[axis]);
    }
    for (std::int32_t k = begin[2]; k <= end[2]; ++k) {
      for (std::int32_t j = begin[1]; j <= end[1]; ++j) {
        for (std::int32_t i = begin[0]; i <= end[0]; ++i)
          is_finite_ = is_finite_ && std::isfinite(from_ordered<Sample>(words_[place({i, j, k})]));
      }
    }
  }
  /// Returns whether the contour crosses cells of the page that have corners on a page behind it.
  [[nodiscard]] bool has_crossed_cells_at(LatticePoint step) const {
    constexpr std::int32_t kEnd = PageGrid::kSide - 1;
    const std::uint32_t in_row = step.i > 0 ? 1u << kEnd : 0xffffu;
    for (std::int32_t k = step.k > 0 ? kEnd : 0; k <= kEnd; ++k) {
      for (std::int32_t j = step.j > 0 ? kEnd : 0; j <= kEnd; ++j) {
        if ((crossed_cells(j, k) & in_row) != 0) return true;
      }
    }
    return false;
  }

  StoredDiamonds<Sample>& diamonds_;
  LatticePoint block_{}, cells_{};
  std::array<Word, static_cast<std::size_t>(kSide) * kSide * kSide> words_{};
  std::array<std::uint32_t, static_cast<std::size_t>(kSide) * kSide> above_{};
  bool is_finite_ = true;
};

using Set = VertexLink::Set;

/// Returns the neighbours whose steps fulfil a condition.
template <class Condition>
constexpr Set neighbours_where(Condition holds) {
  Set found = 0;
  for (int n = 0; n < VertexLink::kCount; ++n) {
    if (n != 13 && holds(VertexLink::step(n))) found |= 1u << n;
  }
  return found;
}

/// The neighbours that come before a vertex in the order of lattice points.
constexpr Set kBefore = neighbours_where([](LatticePoint d) { return d < LatticePoint{0, 0, 0}; });

/// The neighbours whose coordinate is less, equal, or greater, for each axis.
using ByAxis = std::array<Set, 3>;
constexpr ByAxis by_axis(std::int32_t way) {
  ByAxis found{};
  for (int axis = 0; axis < 3; ++axis)
    found[static_cast<std::size_t>(axis)] = neighbours_where([=](LatticePoint d) { return d[axis] == way; });
  return found;
}
constexpr ByAxis kLess = by_axis(-1), kSame = by_axis(0), kGreater = by_axis(1);

/// The greatest parameter of a point that is nearer to the first end of its edge.
constexpr double kBelowHalf = 0.5 - std::numeric_limits<double>::epsilon() / 4;

/// Returns whether the contour's point on an edge is nearer to an end than to the other end, given the
/// distances of their values from the isovalue. A point in the middle counts as nearer to the second end.
bool is_nearer(double height, double other_height, bool is_first) {
  return is_first ? height < other_height : height <= other_height;
}

unsigned parity(LatticePoint p) { return static_cast<unsigned>((p.i & 1) | (p.j & 1) << 1 | (p.k & 1) << 2); }

/// Makes the joined contour in the cells of a page of the finest LOD.
template <class Sample>
class PageCells {
 public:
  /// The points that are not joined, by the vertex next to them, in samples: those on the edges to the
  /// neighbours of the set.
  using Separated = LatticeMap<VertexLink::Set>;

  /// Makes the object. The diamonds must outlive it.
  PageCells(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter)
      : diamonds_(diamonds),
        isovalue_(isovalue),
        least_parameter_(least_parameter),
        lattice_step_(diamonds.lattice_step(0)),
        box_(diamonds),
        places_(static_cast<std::size_t>(kEdgeSide) * kEdgeSide * kEdgeSide, kNone) {}

  /// Adds the triangles of a page's cells to a slab. Returns false where a sample there is not finite. Throws
  /// PageLost.
  bool add(LatticePoint block, SurfaceSlab& slab) {
    separated_ = nullptr;
    if (!load(block)) return false;
    const LatticePoint end = box_.cells();
    for (LatticePoint cell{0, 0, 0}; cell.k < end.k; ++cell.k) {
      for (cell.j = 0; cell.j < end.j; ++cell.j) {
        std::uint32_t crossed = box_.crossed_cells(cell.j, cell.k);
        slab.crossed_cells += static_cast<std::uint64_t>(std::popcount(crossed));
        for (; crossed != 0; crossed &= crossed - 1) {
          cell.i = std::countr_zero(crossed);
          add_cell(cell, slab);
        }
      }
    }
    return true;
  }
  /// Adds the triangles of some cells that have edge points with numbers from `first_new` on; the slab shares
  /// all other points next to the cells' corners. `cells`: the cells' first corners, counted from the page's
  /// first point.
  void add_again(LatticePoint block, std::span<const LatticePoint> cells, const Separated& separated,
                 std::uint32_t first_new, SurfaceSlab& slab) {
    separated_ = &separated;
    load(block);
    for (const LatticePoint cell : cells) {
      if ((box_.crossed_cells(cell.j, cell.k) >> cell.i & 1) == 0) continue;
      std::array<std::uint16_t, 19> edges;
      const CellContour& contour = contour_of(cell, slab, edges);
      for (std::size_t n = 0; n < contour.triangle_count; ++n) {
        std::array<std::uint32_t, 3> t;
        for (std::size_t c = 0; c < 3; ++c) t[c] = crossed_[edges[contour.triangles[n][c]]].number;
        const bool is_new =
            std::ranges::any_of(t, [&](std::uint32_t p) { return p >= first_new && p < kFirstPatch; });
        if (is_new && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) slab.triangles.push_back(t);
      }
    }
  }

 private:
  static constexpr std::uint16_t kNone = 0xffff;
  /// The place of an edge is the place of the sum of its ends in a grid of so many points along each axis.
  static constexpr std::int32_t kEdgeSide = 2 * (PageBox<Sample>::kLast - PageBox<Sample>::kFirst) + 1;
  static constexpr std::int32_t edge_place(LatticePoint sum) {
    const LatticePoint at =
        sum - 2 * LatticePoint{PageBox<Sample>::kFirst, PageBox<Sample>::kFirst, PageBox<Sample>::kFirst};
    return at.i + kEdgeSide * (at.j + kEdgeSide * at.k);
  }
  /// The place of an edge less that of twice the cell's first corner, indexed by CellContour::Edge::sum.
  static constexpr auto kPlacesOfSums = [] {
    std::array<std::int32_t, 27> places{};
    for (std::int32_t n = 0; n < 27; ++n)
      places[static_cast<std::size_t>(n)] = n % 3 + kEdgeSide * (n / 3 % 3 + kEdgeSide * (n / 9));
    return places;
  }();

  /// The point where the contour crosses an edge, and the number of the point that it is joined to.
  struct CrossedEdge {
    Vec3 position;
    std::uint32_t number;
  };

  bool load(LatticePoint block) {
    first_ = PageGrid::kSide * block;
    for (const std::int32_t place : used_) places_[static_cast<std::size_t>(place)] = kNone;
    used_.clear();
    crossed_.clear();
    box_.load(block);
    return box_.is_finite();
  }
  /// Returns the contour in a cell, and sets the places of its edges in `crossed_`.
  const CellContour& contour_of(LatticePoint cell, SurfaceSlab& slab, std::array<std::uint16_t, 19>& edges) {
    const auto pair = [&](std::int32_t j, std::int32_t k) {
      return box_.above(cell.j + j, cell.k + k) >> (cell.i + 1) & 3u;
    };
    const unsigned above = pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6;
    const CellContour& contour = CellContour::find(parity(cell), above);
    const std::uint16_t* const places = places_.data() + edge_place(2 * cell);
    for (std::size_t e = 0; e < contour.edge_count; ++e) {
      const CellContour::Edge& edge = contour.edges[e];
      const std::uint16_t& place = places[kPlacesOfSums[edge.sum]];
      if (place == kNone) {
        const LatticePoint a = cell + corner_offset(edge.a), b = cell + corner_offset(edge.b);
        add_vertex(is_nearer(height(a), height(b), a < b) ? a : b, slab);
      }
      edges[e] = place;
    }
    return contour;
  }
  void add_cell(LatticePoint cell, SurfaceSlab& slab) {
    std::array<std::uint16_t, 19> edges;
    const CellContour& contour = contour_of(cell, slab, edges);
    for (std::size_t n = 0; n < contour.triangle_count; ++n) {
      const auto& triangle = contour.triangles[n];
      const std::array<std::uint16_t, 3> corners{edges[triangle[0]], edges[triangle[1]], edges[triangle[2]]};
      const std::array<std::uint32_t, 3> t{crossed_[corners[0]].number, crossed_[corners[1]].number,
                                           crossed_[corners[2]].number};
      if (((t[0] | t[1] | t[2]) & kFirstPatch) != 0) add_geometry(corners, slab);
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) slab.triangles.push_back(t);
    }
  }
  /// Adds a triangle of the contour, before its points are joined, to the patches at its corners.
  void add_geometry(const std::array<std::uint16_t, 3>& corners, SurfaceSlab& slab) const {
    const CrossedEdge &a = crossed_[corners[0]], &b = crossed_[corners[1]], &c = crossed_[corners[2]];
    const Vec3 area_vector = 0.5 * cross(b.position - a.position, c.position - a.position);
    const double area = norm(area_vector), moment = dot(area_vector, a.position);
    const auto add = [&](std::uint32_t number) {
      if (number >= kFirstPatch)
        slab.patches[number - kFirstPatch].joined.add_triangle(area_vector, area, moment);
    };
    add(a.number);
    if (b.number != a.number) add(b.number);
    if (c.number != a.number && c.number != b.number) add(c.number);
  }
  /// Gives numbers to all points that are nearer to this vertex than to the other ends of their edges.
  void add_vertex(LatticePoint v, SurfaceSlab& slab) {
    const VertexLink& link = VertexLink::find(parity(v));
    const Set points = points_near(v, link);
    Set single = points & on_border(v);
    if (separated_ != nullptr) {
      if (const Set* const separated = separated_->find(in_samples(v))) single |= points & *separated;
    }
    const auto number = [&](Set patch) {
      const std::uint32_t n = number_of(v, patch, slab);
      for (Set left = patch; left != 0; left &= left - 1) {
        const int neighbour = std::countr_zero(left);
        const std::int32_t place = edge_place(2 * v + VertexLink::step(neighbour));
        places_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(crossed_.size());
        used_.push_back(place);
        crossed_.push_back({positions_[static_cast<std::size_t>(neighbour)], n});
      }
    };
    for (Set left = points & ~single; left != 0;) {
      const Set patch = link.component(left);
      left &= ~patch;
      if ((patch & (patch - 1)) != 0 && link.is_disc(patch)) {
        number(patch);
      } else {
        single |= patch;
      }
    }
    for (; single != 0; single &= single - 1) number(single & (0 - single));
  }
  /// Returns the neighbours of the vertex such that the edge to the neighbour has a point near the vertex.
  Set points_near(LatticePoint v, const VertexLink& link) {
    const Set above = neighbours_above(v);
    const double height_of_v = height(v);
    Set found = 0;
    for (Set crossed = (is_above(v) ? ~above : above) & link.neighbours & ~outside(v); crossed != 0;
         crossed &= crossed - 1) {
      const int n = std::countr_zero(crossed);
      const LatticePoint w = v + VertexLink::step(n);
      const bool v_is_first = (kBefore >> n & 1) == 0;
      if (!is_nearer(height_of_v, height(w), v_is_first)) continue;
      found |= 1u << n;
      const LatticePoint first = v_is_first ? v : w, second = v_is_first ? w : v;
      const double exact = edge_parameter(box_.value(first), box_.value(second), isovalue_);
      // Rounding leaves the point on its half of the edge.
      const double t = v_is_first ? std::clamp(exact, least_parameter_, kBelowHalf)
                                  : std::clamp(exact, 0.5, 1 - least_parameter_);
      const EdgePoint point{in_lattice(first), in_lattice(second), t};
      near_[static_cast<std::size_t>(n)] = point;
      positions_[static_cast<std::size_t>(n)] = point_between(diamonds_.domain().position(point.first),
                                                              diamonds_.domain().position(point.second), t);
    }
    return found;
  }
  /// Returns the number of a patch, or of a single point. It is added to the slab unless the slab shares it.
  std::uint32_t number_of(LatticePoint v, Set points, SurfaceSlab& slab) {
    const int first = std::countr_zero(points);
    constexpr std::int32_t kEnd = PageGrid::kSide;
    const bool is_shared =
        separated_ != nullptr || std::min({v.i, v.j, v.k}) == 0 || std::max({v.i, v.j, v.k}) == kEnd;
    std::uint32_t* known = nullptr;
    if (is_shared) {
      const auto [number, is_new] = slab.shared.insert(point_key(in_samples(v), first));
      if (!is_new) return *number;
      known = number;
    }
    std::uint32_t number;
    if ((points & (points - 1)) == 0) {
      number = slab.first_edge + static_cast<std::uint32_t>(slab.edge_points.size());
      slab.edge_points.push_back(near_[static_cast<std::size_t>(first)]);
      slab.edge_positions.push_back(positions_[static_cast<std::size_t>(first)]);
    } else {
      number = kFirstPatch + static_cast<std::uint32_t>(slab.patches.size());
      auto& patch = slab.patches.emplace_back(SurfaceSlab::Patch{{in_samples(v), points}, {}});
      for (Set left = points; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        patch.joined.add(positions_[n], near_[n]);
      }
    }
    if (slab.first_edge + std::max(slab.edge_points.size(), slab.patches.size()) >= kFirstPatch)
      fail("a contour has more than 2^31 points: choose another isovalue or a coarser mesh");
    if (known != nullptr) *known = number;
    return number;
  }
  [[nodiscard]] Set neighbours_above(LatticePoint v) const {
    Set found = 0;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j)
        found |= (box_.above(v.j + j - 1, v.k + k - 1) >> v.i & 7u) << (3 * j + 9 * k);
    }
    return found;
  }
  [[nodiscard]] bool is_above(LatticePoint v) const { return (box_.above(v.j, v.k) >> (v.i + 1) & 1) != 0; }
  /// Returns the distance between a sample and the isovalue.
  [[nodiscard]] double height(LatticePoint v) const { return std::abs(box_.value(v) - isovalue_); }
  /// Returns the neighbours of the vertex outside the data. on_border() returns those on a side of the data's
  /// box on which the vertex lies too.
  [[nodiscard]] Set outside(LatticePoint v) const {
    const LatticePoint at = in_samples(v), last = diamonds_.grid().last();
    Set found = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == 0) found |= kLess[static_cast<std::size_t>(axis)];
      if (at[axis] == last[axis]) found |= kGreater[static_cast<std::size_t>(axis)];
    }
    return found;
  }
  [[nodiscard]] Set on_border(LatticePoint v) const {
    const LatticePoint at = in_samples(v), last = diamonds_.grid().last();
    Set found = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == 0 || at[axis] == last[axis]) found |= kSame[static_cast<std::size_t>(axis)];
    }
    return found;
  }
  [[nodiscard]] LatticePoint in_samples(LatticePoint v) const { return first_ + v; }
  [[nodiscard]] LatticePoint in_lattice(LatticePoint v) const { return lattice_step_ * in_samples(v); }

  StoredDiamonds<Sample>& diamonds_;
  double isovalue_, least_parameter_;
  std::int32_t lattice_step_;
  PageBox<Sample> box_;
  LatticePoint first_{};                  ///< the page's first point, in samples
  const Separated* separated_ = nullptr;  ///< null: all points are joined where possible
  std::vector<CrossedEdge> crossed_;
  std::vector<std::uint16_t> places_;  ///< places in crossed_, or kNone, indexed by edge_place
  std::vector<std::int32_t> used_;     ///< the edge_place of each element of crossed_
  /// The points near the present vertex, indexed by neighbour.
  std::array<EdgePoint, VertexLink::kCount> near_;
  std::array<Vec3, VertexLink::kCount> positions_;
};

}  // namespace

/// The state of a thread, which works on consecutive slabs.
template <class Sample>
struct FullContour<Sample>::Worker {
  StoredDiamonds<Sample> diamonds;
  PageCells<Sample> cells;
  typename PageCells<Sample>::Separated separated{};  ///< separated patches next to its slabs' vertices
  CoincidingPatches coincidences{};
  std::size_t first = 0, last = 0;  ///< the first slab, and the first of the next worker

  Worker(StoredPages<OrderedWord<Sample>>& pages, double isovalue, double least_parameter)
      : diamonds(pages), cells(diamonds, isovalue, least_parameter) {
    diamonds.set_contour(isovalue);
  }
};

template <class Sample>
FullContour<Sample>::FullContour(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter,
                                 const SplitLimits& limits, std::size_t most_threads)
    : diamonds_(diamonds),
      isovalue_(isovalue),
      least_parameter_(least_parameter),
      limits_(limits),
      most_threads_(most_threads) {
  find_blocks(diamonds_.grid().top(), {0, 0, 0});
  std::sort(blocks_.begin(), blocks_.end(), in_file_order);
  find_slabs();
}

template <class Sample>
FullContour<Sample>::~FullContour() = default;

template <class Sample>
bool FullContour<Sample>::is_wanted(int lod, LatticePoint block) const {
  const PageGrid& grid = diamonds_.grid();
  const LatticePoint count = grid.blocks(lod), last = grid.last();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t begin = block[axis] * (kSide << lod), end = begin + (kSide << lod);
    if (block[axis] >= count[axis] || begin >= last[axis]) return false;
    // The mesh outside the region is needed as far as triangles inside depend on it.
    constexpr double kMargin = 3;
    if (limits_.region &&
        (end < (*limits_.region)[0][axis] - kMargin || begin > (*limits_.region)[1][axis] + kMargin))
      return false;
  }
  return diamonds_.side({lod, block}) == StoredDiamonds<Sample>::Side::kBoth;
}

template <class Sample>
void FullContour<Sample>::find_blocks(int lod, LatticePoint block) {
  if (!is_wanted(lod, block)) return;
  if (lod == 0) {
    blocks_.push_back(block);
    return;
  }
  for (unsigned child = 0; child < 8; ++child) find_blocks(lod - 1, 2 * block + corner_offset(child));
}

template <class Sample>
bool FullContour<Sample>::is_worthwhile() {
  if (diamonds_.grid().top() == 0) return false;
  const auto with_errors = std::count_if(blocks_.begin(), blocks_.end(), [this](LatticePoint block) {
    return diamonds_.greatest_class({0, block}) > 0;
  });
  return 2 * static_cast<std::size_t>(with_errors) > blocks_.size();
}

template <class Sample>
void FullContour<Sample>::find_slabs() {
  for (std::size_t n = 0; n < blocks_.size(); ++n) {
    if (n == 0 || blocks_[n].k != blocks_[n - 1].k) slabs_.push_back(n);
  }
  slabs_.push_back(blocks_.size());
}

template <class Sample>
void FullContour<Sample>::make_workers() {
  // Each thread also reads a slab on both sides of its own, and the first thread joins all slabs.
  constexpr std::size_t kLeastSlabs = 3;
  constexpr double kPartOfFirst = 0.9;
  const std::size_t slabs = slabs_.size() - 1;
  const std::size_t threads = std::clamp<std::size_t>(slabs / kLeastSlabs, 1, most_threads_);
  const double pages =
      static_cast<double>(blocks_.size()) / (static_cast<double>(threads) - 1 + kPartOfFirst);
  std::size_t first = 0;
  for (StoredPages<OrderedWord<Sample>>* of_thread : diamonds_.pages().for_threads(threads)) {
    workers_.push_back(std::make_unique<Worker>(*of_thread, isovalue_, least_parameter_));
    Worker& worker = *workers_.back();
    worker.first = first;
    const double part = static_cast<double>(workers_.size()) - 1 + kPartOfFirst;
    const auto next =
        std::lower_bound(slabs_.begin(), slabs_.end() - 1, static_cast<std::size_t>(pages * part));
    worker.last = workers_.size() == threads ? slabs : static_cast<std::size_t>(next - slabs_.begin());
    first = worker.last;
  }
}

template <class Sample>
std::optional<Contour> FullContour<Sample>::run(Progress& progress) {
  JoinedSurface surface(diamonds_.lattice_step(0), diamonds_.data_box());
  make_workers();
  const auto part = [this](std::size_t n) {
    return static_cast<double>(slabs_[n + 1]) / static_cast<double>(blocks_.size());
  };
  // The first thread appends its slabs immediately. Those of the others wait for the slabs before.
  std::vector<SurfaceSlab> waiting(slabs_.size() - 1);
  std::atomic<bool> is_finite = true;
  parallel_for(workers_.size(), 1, [&](std::size_t t) {
    Worker& worker = *workers_[t];
    SurfaceSlab reused;
    for (std::size_t n = worker.first; n < worker.last && is_finite; ++n) {
      SurfaceSlab& slab = t == 0 ? reused : waiting[n];
      if (!add_slab(n, worker, slab)) is_finite = false;
      if (t != 0) continue;
      surface.append(slab, part(n));
      progress.step("extracting", static_cast<double>(n + 1) / static_cast<double>(worker.last));
    }
  });
  if (!is_finite) return {};
  for (std::size_t n = workers_[0]->last; n < waiting.size(); ++n)
    surface.append(std::exchange(waiting[n], {}), part(n));
  crossed_cells_ = surface.crossed_cells();
  while (surface.has_suspects()) separate(surface, progress);
  Contour result = surface.finish();
  if (limits_.region) remove_unused_points(result);
  return result;
}

template <class Sample>
bool FullContour<Sample>::add_slab(std::size_t n, Worker& worker, SurfaceSlab& slab) const {
  const std::int32_t first = kSide * blocks_[slabs_[n]].k, sample = diamonds_.lattice_step(0);
  slab.clear(first, first + kSide);
  for (std::size_t block = slabs_[n]; block < slabs_[n + 1]; ++block) {
    if (!worker.cells.add(blocks_[block], slab)) return false;
  }
  const std::vector<PointsOfVertex> patches = slab.separate(sample, worker.coincidences);
  for (const PointsOfVertex& patch : patches) *worker.separated.insert(patch.vertex).first |= patch.points;
  const std::vector<CellOfPage> cells = cells_round(patches);
  slab.share(corners_of(cells), sample);
  const auto first_new = static_cast<std::uint32_t>(slab.edge_points.size());
  for_each_page(cells, [&](LatticePoint block, std::span<const LatticePoint> of_page) {
    worker.cells.add_again(block, of_page, worker.separated, first_new, slab);
  });
  return true;
}

template <class Sample>
void FullContour<Sample>::separate(JoinedSurface& surface, Progress& progress) {
  progress.step("extracting", 1);
  const auto worker_of = [this](std::int32_t k) -> Worker& {
    const auto has_slab = [&](const std::unique_ptr<Worker>& w) {
      return k <= blocks_[slabs_[w->last] - 1].k;
    };
    return **std::find_if(workers_.begin(), workers_.end() - 1, has_slab);
  };
  const std::vector<PointsOfVertex> patches = surface.separate(workers_[0]->coincidences);
  const std::vector<CellOfPage> cells = cells_round(patches);
  const LatticeMap<bool> corners = corners_of(cells);
  for (const PointsOfVertex& patch : patches) {
    // Threads share the patches next to a plane between them.
    for (const std::int32_t k : {patch.vertex.k - 1, patch.vertex.k})
      *worker_of(k / kSide).separated.insert(patch.vertex).first |= patch.points;
  }
  SurfaceSlab addition = surface.addition(corners);
  const std::uint32_t first_new = addition.first_edge;
  for_each_page(cells, [&](LatticePoint block, std::span<const LatticePoint> of_page) {
    Worker& worker = worker_of(block.k);
    worker.cells.add_again(block, of_page, worker.separated, first_new, addition);
  });
  surface.add(addition);
}

template <class Sample>
template <class Visit>
void FullContour<Sample>::for_each_page(const std::vector<CellOfPage>& cells, const Visit& visit) {
  std::vector<LatticePoint> of_page;
  for (std::size_t n = 0; n < cells.size();) {
    const LatticePoint block = cells[n].block;
    of_page.clear();
    for (; n < cells.size() && cells[n].block == block; ++n) of_page.push_back(cells[n].cell);
    visit(block, std::span<const LatticePoint>(of_page));
  }
}

template <class Sample>
LatticeMap<bool> FullContour<Sample>::corners_of(const std::vector<CellOfPage>& cells) {
  LatticeMap<bool> corners;
  for (const CellOfPage& c : cells) {
    for (unsigned n = 0; n < 8; ++n) corners.insert(kSide * c.block + c.cell + corner_offset(n));
  }
  return corners;
}

template <class Sample>
std::vector<typename FullContour<Sample>::CellOfPage> FullContour<Sample>::cells_round(
    const std::vector<PointsOfVertex>& patches) const {
  const LatticePoint last = diamonds_.grid().last();
  std::vector<CellOfPage> found;
  for (const PointsOfVertex& patch : patches) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      const LatticePoint c = patch.vertex - corner_offset(corner);
      if (std::min({c.i, c.j, c.k}) < 0 || c.i >= last.i || c.j >= last.j || c.k >= last.k) continue;
      const LatticePoint block{c.i / kSide, c.j / kSide, c.k / kSide};
      found.push_back({block, c - kSide * block});
    }
  }
  const auto before = [](const CellOfPage& a, const CellOfPage& b) {
    return a.block != b.block ? in_file_order(a.block, b.block) : in_file_order(a.cell, b.cell);
  };
  std::sort(found.begin(), found.end(), before);
  const auto same = [](const CellOfPage& a, const CellOfPage& b) {
    return a.block == b.block && a.cell == b.cell;
  };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(FullContour);

}  // namespace adamas::isosurface
