#include "isosurface/extraction/stored_diamonds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "core/base/simd.h"

namespace adamas::isosurface {

namespace {

/// Sets `codes` to the codes of the diamonds whose samples lie on both sides of `least`, and to 0 for the
/// others.
template <class Word>
void select_crossed(const PageBounds<Word>& page, Word least, PagePoints<std::uint8_t>& codes) {
  with_wide_lanes([&](auto bytes) {
    using Lanes = Simd<Word, bytes()>;
    using Codes [[gnu::vector_size(Lanes::kCount)]] = std::uint8_t;
    for (std::size_t n = 0; n < PageGrid::kPoints; n += Lanes::kCount) {
      const auto crossed =
          (Lanes::load(page.low.data() + n) < least) & (Lanes::load(page.high.data() + n) >= least);
      Codes selected;
      std::memcpy(&selected, page.errors.data() + n, sizeof selected);
      selected &= __builtin_convertvector(crossed, Codes);
      std::memcpy(codes.data() + n, &selected, sizeof selected);
    }
  });
}

}  // namespace

template <class Sample>
StoredDiamonds<Sample>::StoredDiamonds(StoredPages<Word>& pages)
    : LatticeSamples<Sample>(pages), recent_(static_cast<std::size_t>(pages.grid().top() + 1)) {
  const PageGrid& grid = pages.grid();
  for (int lod = 0; lod < grid.depth(); ++lod)
    reaches_[static_cast<std::size_t>(lod)] = (1 << lod) * grid.reach(lod);
  const Vec3 spacing = pages.file().header().grid.spacing;
  for (int lod = 0; lod < std::max(1, grid.depth()); ++lod) {
    const ErrorScale scale = lod_error_scale(spacing, lod);
    for (int code = 0; code < ErrorScale::kCodes; ++code)
      errors_[static_cast<std::size_t>(error_class(code, lod))] =
          scale.decode(static_cast<std::uint8_t>(code));
  }
}

template <class Sample>
int StoredDiamonds<Sample>::class_within(double error) const {
  const auto end = errors_.begin() + std::max(1, ErrorScale::kCodes + 4 * (this->lods() - 1));
  return static_cast<int>(std::upper_bound(errors_.begin(), end, error) - errors_.begin()) - 1;
}

template <class Sample>
const PageEntry& StoredDiamonds<Sample>::entry(const PageId& id) {
  RecentEntry& recent = recent_[static_cast<std::size_t>(id.lod)];
  if (recent.id != id) {
    const std::optional<PageEntry> found = this->pages().entry(id);
    if (!found) throw PageLost{id, id};
    recent.id = id;
    recent.entry = *found;
  }
  return recent.entry;
}

template <class Sample>
void StoredDiamonds<Sample>::set_contour(double isovalue) {
  // Ordered words are in the order of their values, so the first word that is not below is found by
  // bisection. NaN lie at both ends, where they count as the infinities next to them.
  std::uint64_t begin = 0, end = std::uint64_t{std::numeric_limits<Word>::max()} + 1;
  while (begin < end) {
    const std::uint64_t middle = (begin + end) / 2;
    const double found = this->value(static_cast<Word>(middle));
    const bool below = std::isnan(found) ? middle < (std::uint64_t{std::numeric_limits<Word>::max()} + 1) / 2
                                         : found < isovalue;
    (below ? begin : end) = below ? middle + 1 : middle;
  }
  least_above_ = begin;
}

template <class Sample>
void StoredDiamonds<Sample>::find_crossed(int lod, LatticePoint block, Codes& codes) {
  const PageId id = this->page_id(lod, block);
  const PageBounds<Word>& found = this->pages().needed_bounds(id);
  if (greatest_class(id) == 0) {
    codes.fill(0);
  } else {
    find_crossed(lod, block, found, codes);
  }
}

template <class Sample>
void StoredDiamonds<Sample>::find_crossed(int lod, LatticePoint block, const PageBounds<Word>& bounds,
                                          Codes& codes) const {
  select_crossed(bounds, static_cast<Word>(least_above_), codes);
  keep_own(lod, block, codes);
}

template <class Sample>
void StoredDiamonds<Sample>::keep_own(int lod, LatticePoint block, Codes& codes) const {
  constexpr std::int32_t kSide = PageGrid::kSide;
  // The coarsest page does not have the points of coarser LODs side by side.
  const std::int32_t step = 1 << (lod - std::min(lod, this->grid().top()));
  const LatticePoint reach = this->grid().reach(lod);
  LatticePoint count;
  for (int axis = 0; axis < 3; ++axis)
    count[axis] = std::min({reach[axis] - kSide * block[axis] + 1, kSide, (kSide + step - 1) / step});
  const auto all = codes;
  codes.fill(0);
  for (LatticePoint q{}; q.k < count.k; ++q.k) {
    for (q.j = 0; q.j < count.j; ++q.j) {
      const std::uint8_t* const from = all.data() + PageGrid::place(step * LatticePoint{0, q.j, q.k}, 0);
      std::uint8_t* const to = codes.data() + PageGrid::place({0, q.j, q.k}, 0);
      // Other points are those of coarser LODs.
      const std::int32_t first = ((q.j | q.k) & 1) != 0 ? 0 : 1, apart = first + 1;
      if (step == 1 && count.i == kSide) {
        constexpr std::uint64_t kAll = ~std::uint64_t{0}, kOdd = 0xff00ff00ff00ff00u;
        std::array<std::uint64_t, 2> row;
        std::memcpy(row.data(), from, sizeof row);
        for (std::uint64_t& eight : row) eight &= first == 0 ? kAll : kOdd;
        std::memcpy(to, row.data(), sizeof row);
      } else {
        for (q.i = first; q.i < count.i; q.i += apart) to[q.i] = from[step * q.i];
      }
    }
  }
}

template <class Sample>
typename StoredDiamonds<Sample>::Side StoredDiamonds<Sample>::side(const PageId& id) {
  // Points that belong to coarser LODs are in no page's range.
  if (id.lod == this->grid().top() || !this->grid().contains(id)) return Side::kBoth;
  const PageEntry& known = entry(id);
  if (known.low > known.high || crosses(known.low, known.high)) return Side::kBoth;
  return known.low >= least_above_ ? Side::kAbove : Side::kBelow;
}

template <class Sample>
int StoredDiamonds<Sample>::greatest_class(const PageId& id) {
  const PageEntry& known = entry(id);
  if (known.part_count() == 0 || !crosses(known.low, known.high)) return 0;
  return error_class(known.part_errors[known.part(static_cast<std::uint32_t>(least_above_))], id.lod);
}

template <class Sample>
int StoredDiamonds<Sample>::class_if_crossed(LatticePoint p) {
  const LatticePoint at = this->in_samples(p);
  const PageId id = this->grid().page(at);
  const bool is_coarsest = id.lod == this->grid().top();
  if (this->pages().held(id) == nullptr && !is_coarsest && greatest_class(id) == 0) return 0;
  const PageBounds<Word>& found = this->pages().needed_bounds(id);
  const std::size_t place = PageGrid::place(at, id.lod);
  return crosses(found.low[place], found.high[place]) ? error_class(found.errors[place], this->lod(p)) : 0;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(StoredDiamonds);

}  // namespace adamas::isosurface
