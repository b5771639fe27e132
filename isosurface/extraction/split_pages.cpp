#include "isosurface/extraction/split_pages.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "isosurface/contour/contour.h"
#include "isosurface/storage/z_order.h"

namespace adamas {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;
constexpr std::uint16_t kOdd = 0xaaaa, kEven = 0x5555;

/// Which of eight codes below 128 are not less than `least`, as bits; 0 < least <= 128.
unsigned not_less(const std::uint8_t* codes, unsigned least) {
  constexpr std::uint64_t kOnes = 0x0101010101010101ull, kGather = 0x0002040810204081ull;
  std::uint64_t eight;
  std::memcpy(&eight, codes, sizeof eight);
  const std::uint64_t high = (eight + kOnes * (128 - least)) & (kOnes << 7);
  return static_cast<unsigned>(high * kGather >> 56);
}

/// The same of a row.
unsigned row_not_less(const std::uint8_t* codes, unsigned least) {
  return not_less(codes, least) | not_less(codes + 8, least) << 8;
}

/// Whether no diamond of a row is crossed with an error.
bool is_zero(const std::uint8_t* codes) {
  std::array<std::uint64_t, 2> row;
  std::memcpy(row.data(), codes, sizeof row);
  return (row[0] | row[1]) == 0;
}

/// A row of points of a page that is no complete one, seen as phases of its diamonds: -1 where the points are
/// coarser ones.
struct RowPhases {
  int odd, even;  ///< of points with an odd coordinate i, and an even one

  RowPhases(std::int32_t j, std::int32_t k)
      : odd(2 - (j & 1) - (k & 1)), even((j | k) & 1 ? 3 - (j & 1) - (k & 1) : -1) {}
};

/// Of the diamonds of a level's page, those that a cut splits.
class CutOfPage {
 public:
  /// `order`: the page's in z-order; `generation`: that of the level's cubes.
  CutOfPage(const SurfaceCut& cut, int level, int generation, std::uint64_t order) : place_(cut.place) {
    for (int phase = 0; phase < 3; ++phase) {
      int rank = cut.least_rank(generation + phase);
      if (generation + phase == cut.generation && order < cut.page) rank = cut.rank;
      if (generation + phase == cut.generation && order == cut.page) last_phase_ = phase;
      least_[static_cast<std::size_t>(phase)] = code(rank, level);
    }
    last_least_ = code(cut.rank, level);
  }

  /// Of a row of codes, as bits.
  [[nodiscard]] unsigned split(const std::uint8_t* codes, const RowPhases& phases, std::size_t row) const {
    unsigned bits = row_not_less(codes, least_[static_cast<std::size_t>(phases.odd)]) & kOdd;
    if (phases.even >= 0) bits |= row_not_less(codes, least_[static_cast<std::size_t>(phases.even)]) & kEven;
    if (last_phase_ < 0) return bits;
    const unsigned of_phase =
        (phases.odd == last_phase_ ? kOdd : 0u) | (phases.even == last_phase_ ? kEven : 0u);
    const auto before = static_cast<std::ptrdiff_t>(place_) - static_cast<std::ptrdiff_t>(kSide * row);
    const unsigned places = before <= 0 ? 0u : before >= kSide ? 0xffffu : (1u << before) - 1;
    return bits | (row_not_less(codes, last_least_) & of_phase & places);
  }

 private:
  /// The least code of a level that has the rank; beyond all codes where none has.
  static unsigned code(int rank, int level) {
    return static_cast<unsigned>(std::clamp(rank - 4 * level, 1, 128));
  }

  std::array<unsigned, 3> least_;  ///< by phase: codes that are split
  int last_phase_ = -1;            ///< where a phase's diamonds are split up to a place, from this code on
  unsigned last_least_;
  std::size_t place_;
};

/// Where along an axis the children of a point of phase 2 lie, in pages of the next finer level: from the one
/// before the point's page to the last one in it, as three bits.
unsigned pages_of_children(std::int32_t x) { return (x == 0 ? 1 : 0) | (x <= 8 ? 2 : 0) | (x >= 8 ? 4 : 0); }

/// The pages of the next finer level that have children of a page's diamonds, along i as three bits, for
/// three rows along j of three planes along k.
std::array<unsigned, 9> pages_of_children(const PageMask& split) {
  std::array<unsigned, 9> pages{};
  for (std::int32_t k = 0; k < kSide; ++k) {
    for (std::int32_t j = 0; j < kSide; ++j) {
      const RowPhases phases(j, k);
      const unsigned bits = split.rows[static_cast<std::size_t>(j + kSide * k)] &
                            ((phases.odd == 2 ? kOdd : 0u) | (phases.even == 2 ? kEven : 0u));
      if (bits == 0) continue;
      const unsigned along_i =
          ((bits & 1) != 0 ? 1u : 0u) | ((bits & 0x1ff) != 0 ? 2u : 0u) | ((bits & 0xff00) != 0 ? 4u : 0u);
      for (unsigned n = 0; n < 9; ++n) {
        if ((pages_of_children(j) >> n % 3 & pages_of_children(k) >> n / 3 & 1) != 0) pages[n] |= along_i;
      }
    }
  }
  return pages;
}

}  // namespace

template <class Sample>
std::size_t SplitPages<Sample>::count() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) {
    for (const PageMask& mask : level.masks) sum += mask.count();
  }
  return sum;
}

template <class Sample>
int SplitPages<Sample>::rank(LatticePoint p) {
  if (!diamonds_.is_stored(p)) return 0;
  if (limits_.any() && !limits_.allow(diamonds_.in_samples(p), diamonds_.level(p), Diamond(p).phase()))
    return 0;
  return diamonds_.rank_if_crossed(p);
}

template <class Sample>
bool SplitPages<Sample>::is_split(LatticePoint p) const {
  const int level = diamonds_.level(p);
  if (level < 0 || level >= levels()) return false;
  const LatticePoint s = diamonds_.in_samples(p);
  const LatticePoint u{s.i >> level, s.j >> level, s.k >> level};
  const PageOfLevel* found = page(level, {u.i / kSide, u.j / kSide, u.k / kSide});
  return found != nullptr && found->mask != kNone &&
         mask(level, *found).has({u.i % kSide, u.j % kSide, u.k % kSide});
}

template <class Sample>
bool SplitPages<Sample>::is_in_data(LatticePoint p) const {
  return diamonds_.domain().contains(p) && !is_beyond(Diamond(p), diamonds_.last_sample());
}

template <class Sample>
bool SplitPages<Sample>::is_lost(LatticePoint p) const {
  const int level = diamonds_.level(p);
  return !limits_.lost.empty() && level >= 0 &&
         limits_.lost.blocks(diamonds_.in_samples(p), level, Diamond(p).phase());
}

template <class Sample>
std::vector<LatticePoint> SplitPages<Sample>::candidates(int level) {
  const PageGrid& grid = diamonds_.grid();
  if (level >= grid.top()) return {{0, 0, 0}};
  const LatticePoint blocks = grid.blocks(level);
  LatticeMap<std::uint8_t> met;
  std::vector<std::pair<std::uint64_t, LatticePoint>> found;
  const auto add = [&](LatticePoint block) {
    if (std::min({block.i, block.j, block.k}) < 0 || block.i >= blocks.i || block.j >= blocks.j ||
        block.k >= blocks.k || !met.insert(block).second || !grid.contains({level, block}))
      return;
    found.emplace_back(ZOrder::interleave(block), block);
  };
  for (const PageOfLevel& parent : pages(level + 1)) {
    if (parent.mask == kNone) continue;
    const std::array<unsigned, 9> rows =
        limits_.any() ? allowed_children(level + 1, parent) : pages_of_children(mask(level + 1, parent));
    for (std::int32_t n = 0; n < 27; ++n) {
      if ((rows[static_cast<std::size_t>(n / 3)] >> n % 3 & 1) != 0)
        add(2 * parent.block + LatticePoint{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
    }
  }
  // Where the level's last points lie in a page's first plane nothing comes from coarser diamonds but by way
  // of the page before.
  const LatticePoint last = grid.extent(level);
  for (std::size_t n = 0; n < found.size(); ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      LatticePoint next = found[n].second;
      if (kSide * ++next[axis] == last[axis] && may_split(level, next)) add(next);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<LatticePoint> in_order;
  in_order.reserve(found.size());
  for (const auto& [order, block] : found) in_order.push_back(block);
  return in_order;
}

template <class Sample>
std::array<unsigned, 9> SplitPages<Sample>::allowed_children(int level, const PageOfLevel& parent) const {
  std::array<unsigned, 9> found{};
  mask(level, parent).for_each([&](LatticePoint q) {
    const DiamondStencil& stencil = DiamondStencil::at(q);
    if (stencil.phase != 2) return;
    for (const LatticePoint offset : stencil.children) {
      const LatticePoint child = 2 * q + offset;
      if (!limits_.allow((1 << (level - 1)) * (2 * kSide * parent.block + child), level - 1, 0)) continue;
      const LatticePoint page{(child.i >> 4) + 1, (child.j >> 4) + 1, (child.k >> 4) + 1};
      found[static_cast<std::size_t>(page.j + 3 * page.k)] |= 1u << page.i;
    }
  });
  return found;
}

template <class Sample>
bool SplitPages<Sample>::may_split(int level, LatticePoint block) const {
  if (!limits_.any()) return true;
  PageMask all;
  all.rows.fill(kOdd | kEven);
  limit(level, block, all);
  return std::any_of(all.rows.begin(), all.rows.end(), [](std::uint16_t row) { return row != 0; });
}

template <class Sample>
typename SplitPages<Sample>::PageOfLevel SplitPages<Sample>::look_into(int level, LatticePoint block,
                                                                       const SurfaceCut& cut) {
  Level& of = levels_[static_cast<std::size_t>(level)];
  *of.indices.insert(block).first = static_cast<std::uint32_t>(of.pages.size());
  PageOfLevel& page = of.pages.emplace_back();
  page.block = block;
  const PageId where = id(level, block);
  if (level < diamonds_.grid().top()) {
    const int greatest = diamonds_.greatest_rank(where);
    if (greatest < cut.rank || greatest == 0) {
      greatest_left_ = std::max(greatest_left_, greatest);
      return page;
    }
  }
  diamonds_.find_crossed(where, codes_);
  const PageMask split = split_of(level, block, cut);
  if (std::any_of(split.rows.begin(), split.rows.end(), [](std::uint16_t row) { return row != 0; })) {
    page.mask = static_cast<std::uint32_t>(of.masks.size());
    of.masks.push_back(split);
  }
  return page;
}

template <class Sample>
PageMask SplitPages<Sample>::split_of(int level, LatticePoint block, const SurfaceCut& cut) {
  const LatticePoint reach = diamonds_.grid().reach(level);
  LatticePoint count;
  for (int axis = 0; axis < 3; ++axis) count[axis] = std::min(reach[axis] - kSide * block[axis] + 1, kSide);
  const auto in_row = static_cast<std::uint16_t>((1u << count.i) - 1);
  const int generation = 3 * (levels() - 1 - level), step = 1 << levels_below(level);
  const CutOfPage in_page(cut, level, generation, ZOrder::interleave(block));
  // What is not split has no greater rank than this, and mostly just that.
  const bool look_at_left = greatest_left_ < (cut.generation < generation + 3 ? cut.rank : cut.rank - 1);
  PageMask mask, left;
  for (std::int32_t k = 0; k < count.k; ++k) {
    for (std::int32_t j = 0; j < count.j; ++j) {
      const RowPhases phases(j, k);
      const std::uint8_t* row = codes_.data() + place(level, {0, j, k});
      std::array<std::uint8_t, kSide> spread;
      if (step > 1) {
        for (std::int32_t i = 0; i < kSide; ++i)
          spread[static_cast<std::size_t>(i)] = i * step < kSide ? row[i * step] : std::uint8_t{0};
        row = spread.data();
      }
      if (is_zero(row)) continue;
      const std::size_t at = static_cast<std::size_t>(j + kSide * k);
      const unsigned own = in_row & (phases.even < 0 ? kOdd : kOdd | kEven);
      const unsigned split = in_page.split(row, phases, at);
      mask.rows[at] = static_cast<std::uint16_t>(split & own);
      if (look_at_left) left.rows[at] = static_cast<std::uint16_t>(row_not_less(row, 1) & own & ~split);
    }
  }
  if (limits_.any()) {
    limit(level, block, mask);
    limit(level, block, left);
  }
  if (look_at_left) {
    left.for_each([&](LatticePoint q) {
      greatest_left_ = std::max(greatest_left_, codes_[place(level, q)] + 4 * level);
    });
  }
  return mask;
}

template <class Sample>
void SplitPages<Sample>::limit(int level, LatticePoint block, PageMask& mask) const {
  const PageMask before = mask;
  before.for_each([&](LatticePoint q) {
    const LatticePoint p = (1 << level) * (kSide * block + q);
    const int phase = 3 - (q.i & 1) - (q.j & 1) - (q.k & 1);
    if (!limits_.allow(p, level, phase))
      mask.rows[static_cast<std::size_t>(q.j + kSide * q.k)] &= static_cast<std::uint16_t>(~(1u << q.i));
  });
}

template class SplitPages<std::uint8_t>;
template class SplitPages<std::uint16_t>;
template class SplitPages<std::int16_t>;
template class SplitPages<float>;

}  // namespace adamas
