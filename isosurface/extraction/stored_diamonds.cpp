#include "isosurface/extraction/stored_diamonds.h"

#include <algorithm>
#include <bit>
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
    if (!found) throw PageLost{id, id};
    recent.id = id;
    recent.entry = *found;
  }
  return recent.entry;
}

template <class Sample>
bool StoredDiamonds<Sample>::samples_round(LatticePoint p, std::int32_t step,
                                           std::array<double, 27>& samples) {
  constexpr std::int32_t kSide = PageGrid::kSide;
  const int level = std::countr_zero(static_cast<std::uint32_t>(step)) - shift_;
  if (level < 0 || level > grid_.top()) return false;
  const LatticePoint at = in_samples(p), last = grid_.last();
  const LatticePoint middle{at.i >> level, at.j >> level, at.k >> level};
  bool on_one_page = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t x = middle[axis];
    if (x == 0 || x + 1 > last[axis] >> level) return false;
    on_one_page = on_one_page && x % kSide != 0 && x % kSide != kSide - 1;
  }
  if (on_one_page) {
    const HeldPage<Word>* from = pages_.held({level, {middle.i / kSide, middle.j / kSide, middle.k / kSide}});
    if (from == nullptr) return false;
    const Word* first = from->samples.data() + PageGrid::place(middle - LatticePoint{1, 1, 1}, 0);
    for (std::size_t n = 0; n < 27; ++n)
      samples[n] = value(first[n % 3 + kSide * (n / 3 % 3) + kSide * kSide * (n / 9)]);
    return true;
  }
  PageId id{-1, {}};
  const Word* words = nullptr;
  std::size_t n = 0;
  for (std::int32_t k = middle.k - 1; k <= middle.k + 1; ++k) {
    for (std::int32_t j = middle.j - 1; j <= middle.j + 1; ++j) {
      for (std::int32_t i = middle.i - 1; i <= middle.i + 1; ++i) {
        const PageId next{level, {i / kSide, j / kSide, k / kSide}};
        if (next != id) {
          const HeldPage<Word>* from = pages_.held(next);
          if (from == nullptr) return false;
          id = next;
          words = from->samples.data();
        }
        samples[n++] = value(words[PageGrid::place({i, j, k}, 0)]);
      }
    }
  }
  return true;
}

template <class Sample>
void StoredDiamonds<Sample>::set_contour(double isovalue) {
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
  if (contour_ == 0 || least_above_ != begin) ++contour_;
  least_above_ = begin;
}

template <class Sample>
void StoredDiamonds<Sample>::mark(const PageId& id, const HeldPage<Word>& page) {
  page.marked = contour_;
  const PageEntry& known = entry(id);
  if (!crosses(known.low, known.high)) {
    page.marks.fill(0);
    return;
  }
  mark_crossed(page, static_cast<Word>(least_above_));
}

template <class Sample>
const HeldPage<typename StoredDiamonds<Sample>::Word>& StoredDiamonds<Sample>::marked_page(const PageId& id) {
  const HeldPage<Word>& found = page(id);
  if (found.marked != contour_) mark(id, found);
  return found;
}

template <class Sample>
int StoredDiamonds<Sample>::greatest_rank(const PageId& id) {
  const PageEntry& known = entry(id);
  return known.error == 0 || !crosses(known.low, known.high) ? 0 : known.error + 4 * id.level;
}

template <class Sample>
int StoredDiamonds<Sample>::rank_if_crossed(LatticePoint p) {
  const LatticePoint at = in_samples(p);
  const PageId id = grid_.page(at);
  if (pages_.held(id) == nullptr && id.level < grid_.top() && greatest_rank(id) == 0) return 0;
  const int code = marked_page(id).marks[PageGrid::place(at, id.level)];
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
