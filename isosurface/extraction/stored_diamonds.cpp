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
  // Ordered words are in the order of their values, so that the first that is not below is found by halving.
  // NaN lie at both ends, where they count as the infinities next to them.
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
void StoredDiamonds<Sample>::find_crossed(const PageId& id, Codes& codes) {
  const PageBounds<Word>& found = this->pages().needed_bounds(id);
  if (greatest_class(id) == 0) {
    codes.fill(0);
  } else {
    find_crossed(found, codes);
  }
}

template <class Sample>
void StoredDiamonds<Sample>::find_crossed(const PageBounds<Word>& bounds, Codes& codes) const {
  select_crossed(bounds, static_cast<Word>(least_above_), codes);
}

template <class Sample>
typename StoredDiamonds<Sample>::Side StoredDiamonds<Sample>::side(const PageId& id) {
  // Points of coarser LODs alone are in no page's range.
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

template class StoredDiamonds<std::uint8_t>;
template class StoredDiamonds<std::uint16_t>;
template class StoredDiamonds<std::int16_t>;
template class StoredDiamonds<float>;

}  // namespace adamas::isosurface
