#include "isosurface/extraction/stored_diamonds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "isosurface/compression/row_lanes.h"
#include "isosurface/preprocessing/preprocess.h"

namespace adamas {

namespace {

Domain domain_of(const VolumeGrid& volume, int depth) {
  const double side = static_cast<double>(std::int32_t{1} << depth);
  return {Box3{volume.origin, volume.origin + side * volume.spacing}, {1, 1, 1}};
}

/// Makes a page's marks the codes of those with a range that is not all on one side of `least`.
template <class Word>
void mark_crossed(const HeldPage<Word>& page, Word least) {
  using Lanes = RowLanes<Word, PageGrid::kSide>;
  using Codes [[gnu::vector_size(Lanes::kStep)]] = std::uint8_t;
  for (std::size_t n = 0; n < PageGrid::kPoints; n += Lanes::kStep) {
    const auto crossed =
        (Lanes::load(page.low.data() + n) < least) & (Lanes::load(page.high.data() + n) >= least);
    Codes codes;
    std::memcpy(&codes, page.errors.data() + n, sizeof codes);
    codes &= __builtin_convertvector(crossed, Codes);
    std::memcpy(page.marks.data() + n, &codes, sizeof codes);
  }
}

}  // namespace

template <class Sample>
StoredDiamonds<Sample>::StoredDiamonds(StoredPages<Word>& pages)
    : pages_(pages),
      grid_(pages.grid()),
      shift_(kRootBits - grid_.depth()),
      domain_(domain_of(pages.file().header().grid, grid_.depth())),
      recent_(static_cast<std::size_t>(grid_.top() + 1)) {
  for (int level = 0; level < static_cast<int>(ends_.size()); ++level)
    ends_[static_cast<std::size_t>(level)] =
        (1 << std::min(level, grid_.top())) * grid_.extent(std::min(level, grid_.top()));
  for (int level = 0; level < grid_.depth(); ++level)
    reaches_[static_cast<std::size_t>(level)] = (1 << level) * grid_.reach(level);
  const Vec3 spacing = pages.file().header().grid.spacing;
  for (int level = 0; level < std::max(1, grid_.depth()); ++level) {
    const ErrorScale scale = level_error_scale(spacing, level);
    for (int code = 0; code < ErrorScale::kCodes; ++code)
      errors_[static_cast<std::size_t>(code == 0 ? 0 : code + 4 * level)] =
          scale.decode(static_cast<std::uint8_t>(code));
  }
}

template <class Sample>
int StoredDiamonds<Sample>::rank_within(double error) const {
  const auto end = errors_.begin() + std::max(1, ErrorScale::kCodes + 4 * (grid_.depth() - 1));
  return static_cast<int>(std::upper_bound(errors_.begin(), end, error) - errors_.begin()) - 1;
}

template <class Sample>
const PageEntry& StoredDiamonds<Sample>::entry(const PageId& id) {
  RecentEntry& recent = recent_[static_cast<std::size_t>(id.level)];
  if (recent.id != id) {
    const std::optional<PageEntry> found = pages_.entry(id);
    if (!found) throw PageLost{id};
    recent.id = id;
    recent.entry = *found;
  }
  return recent.entry;
}

template <class Sample>
void StoredDiamonds<Sample>::set_contour(double isovalue, int least_rank) {
  // Ordered words are in the order of their values: the first that is not below, by halving. NaN lie at both
  // ends, where they answer as the infinities next to them.
  std::uint64_t begin = 0, end = std::uint64_t{std::numeric_limits<Word>::max()} + 1;
  while (begin < end) {
    const std::uint64_t middle = (begin + end) / 2;
    const double found = value(static_cast<Word>(middle));
    const bool below = std::isnan(found) ? middle < (std::uint64_t{std::numeric_limits<Word>::max()} + 1) / 2
                                         : found < isovalue;
    (below ? begin : end) = below ? middle + 1 : middle;
  }
  least_above_ = begin;
  least_rank_ = least_rank;
  ++contour_;
}

template <class Sample>
void StoredDiamonds<Sample>::mark(const PageId& id, const HeldPage<Word>& page) {
  page.marked = contour_;
  const PageEntry& known = entry(id);
  if (!crosses(known.low, known.high)) {
    page.marks.fill(0);
  } else if (matters_not(id, known)) {
    page.marks.fill(known.error);
  } else {
    mark_crossed(page, static_cast<Word>(least_above_));
  }
}

template <class Sample>
int StoredDiamonds<Sample>::rank_if_crossed(LatticePoint p) {
  const LatticePoint at = in_samples(p);
  const PageId id = grid_.page(at);
  const HeldPage<Word>* from = pages_.held(id);
  if (from == nullptr) {
    const PageEntry& known = entry(id);
    if (!crosses(known.low, known.high)) return 0;
    if (matters_not(id, known)) return known.error == 0 ? 0 : known.error + 4 * id.level;
    from = &page(id);
  }
  if (from->marked != contour_) mark(id, *from);
  const int code = from->marks[PageGrid::place(at, id.level)];
  return code == 0 ? 0 : code + 4 * level(p);
}

template <class Sample>
std::array<double, 2> StoredDiamonds<Sample>::range() {
  const PageEntry& all = entry({grid_.top(), {0, 0, 0}});
  return {value(static_cast<Word>(all.low)), value(static_cast<Word>(all.high))};
}

template class StoredDiamonds<std::uint8_t>;
template class StoredDiamonds<std::uint16_t>;
template class StoredDiamonds<std::int16_t>;
template class StoredDiamonds<float>;

}  // namespace adamas
