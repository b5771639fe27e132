#include "isosurface/extraction/stored_diamonds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/simd.h"
#include "isosurface/storage/sample_range.h"
#include "isosurface/volume/error_scale.h"

namespace adamas {

namespace {

Domain domain_of(const VolumeGrid& volume, int depth) {
  const double side = static_cast<double>(std::int32_t{1} << depth);
  return {Box3{volume.origin, volume.origin + side * volume.spacing}, {1, 1, 1}};
}

/// Makes `codes` those of the diamonds with a range that is not all on one side of `least`, and 0 of others.
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
    : pages_(pages),
      grid_(pages.grid()),
      shift_(kRootBits - grid_.depth()),
      domain_(domain_of(pages.file().header().grid, grid_.depth())),
      recent_(static_cast<std::size_t>(grid_.top() + 1)) {
  for (int lod = 0; lod < static_cast<int>(ends_.size()); ++lod)
    ends_[static_cast<std::size_t>(lod)] =
        (1 << std::min(lod, grid_.top())) * grid_.extent(std::min(lod, grid_.top()));
  for (int lod = 0; lod < grid_.depth(); ++lod)
    reaches_[static_cast<std::size_t>(lod)] = (1 << lod) * grid_.reach(lod);
  const Vec3 spacing = pages.file().header().grid.spacing;
  for (int lod = 0; lod < std::max(1, grid_.depth()); ++lod) {
    const ErrorScale scale = lod_error_scale(spacing, lod);
    for (int code = 0; code < ErrorScale::kCodes; ++code)
      errors_[static_cast<std::size_t>(code == 0 ? 0 : code + 4 * lod)] =
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
  RecentEntry& recent = recent_[static_cast<std::size_t>(id.lod)];
  if (recent.id != id) {
    const std::optional<PageEntry> found = pages_.entry(id);
    if (!found) throw PageLost{id, id};
    recent.id = id;
    recent.entry = *found;
  }
  return recent.entry;
}

template <class Sample>
bool StoredDiamonds<Sample>::samples_round(LatticePoint p, std::int32_t step, std::array<Word, 27>& samples) {
  constexpr std::int32_t kSide = PageGrid::kSide;
  const int lod = std::countr_zero(static_cast<std::uint32_t>(step)) - shift_;
  if (lod < 0 || lod > grid_.top()) return false;
  const LatticePoint at = in_samples(p), last = grid_.last();
  const LatticePoint first{(at.i >> lod) - 1, (at.j >> lod) - 1, (at.k >> lod) - 1};
  for (int axis = 0; axis < 3; ++axis) {
    if (first[axis] < 0 || first[axis] + 2 > last[axis] >> lod) return false;
  }
  const LatticePoint block{first.i / kSide, first.j / kSide, first.k / kSide};
  if (std::max({first.i % kSide, first.j % kSide, first.k % kSide}) <= kSide - 3) {
    const PageSamples<Word>* page = pages_.held({lod, block});
    if (page == nullptr) return false;
    const Word* from = page->samples.data() + PageGrid::place(first, 0);
    Word* to = samples.data();
    for (int k = 0; k < 3; ++k, from += kSide * kSide - 3 * kSide) {
      for (int j = 0; j < 3; ++j, from += kSide, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
    }
    return true;
  }
  // Along each axis: where the three places lie in their pages, and how many of them in the first one.
  std::array<std::array<std::size_t, 3>, 3> offsets;
  LatticePoint in_first{};
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis, stride *= kSide) {
    const std::int32_t x = first[axis];
    for (std::int32_t n = 0; n < 3; ++n)
      offsets[static_cast<std::size_t>(axis)][static_cast<std::size_t>(n)] =
          stride * static_cast<std::size_t>((x + n) % kSide);
    in_first[axis] = std::min(3, kSide - x % kSide);
  }
  // By whether places lie in the second page along each axis, as bits.
  std::array<const Word*, 8> pages;
  for (int second = 0; second < 8; ++second) {
    LatticePoint of = block;
    bool is_used = true;
    for (int axis = 0; axis < 3; ++axis) {
      if ((second >> axis & 1) == 0) continue;
      ++of[axis];
      is_used = is_used && in_first[axis] < 3;
    }
    if (!is_used) continue;
    const PageSamples<Word>* from = pages_.held({lod, of});
    if (from == nullptr) return false;
    pages[static_cast<std::size_t>(second)] = from->samples.data();
  }
  std::size_t n = 0;
  for (std::int32_t k = 0; k < 3; ++k) {
    for (std::int32_t j = 0; j < 3; ++j) {
      const std::size_t row =
          offsets[1][static_cast<std::size_t>(j)] + offsets[2][static_cast<std::size_t>(k)];
      const std::size_t second = (j >= in_first.j ? 2u : 0u) | (k >= in_first.k ? 4u : 0u);
      for (std::int32_t i = 0; i < 3; ++i)
        samples[n++] =
            pages[second | (i >= in_first.i ? 1u : 0u)][row + offsets[0][static_cast<std::size_t>(i)]];
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
  least_above_ = begin;
}

template <class Sample>
void StoredDiamonds<Sample>::find_crossed(const PageId& id, Codes& codes) {
  const PageBounds<Word>& found = values(id);
  if (greatest_rank(id) == 0) {
    codes.fill(0);
  } else {
    select_crossed(found, static_cast<Word>(least_above_), codes);
  }
}

template <class Sample>
int StoredDiamonds<Sample>::greatest_rank(const PageId& id) {
  const PageEntry& known = entry(id);
  if (known.part_count() == 0 || !crosses(known.low, known.high)) return 0;
  const int code = known.part_errors[known.part(static_cast<std::uint32_t>(least_above_))];
  return code == 0 ? 0 : code + 4 * id.lod;
}

template <class Sample>
int StoredDiamonds<Sample>::rank_if_crossed(LatticePoint p) {
  const LatticePoint at = in_samples(p);
  const PageId id = grid_.page(at);
  if (pages_.held(id) == nullptr && id.lod < grid_.top() && greatest_rank(id) == 0) return 0;
  const PageBounds<Word>& found = values(id);
  const std::size_t place = PageGrid::place(at, id.lod);
  const int code = crosses(found.low[place], found.high[place]) ? found.errors[place] : 0;
  return code == 0 ? 0 : code + 4 * lod(p);
}

template <class Sample>
std::array<double, 2> StoredDiamonds<Sample>::range() {
  const PageId coarsest{grid_.top(), {0, 0, 0}};
  const auto found = sample_range<Sample>(pages_);
  if (!found) throw PageLost{coarsest, coarsest};
  return *found;
}

template class StoredDiamonds<std::uint8_t>;
template class StoredDiamonds<std::uint16_t>;
template class StoredDiamonds<std::int16_t>;
template class StoredDiamonds<float>;

}  // namespace adamas
