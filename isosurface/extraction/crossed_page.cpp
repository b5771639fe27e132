#include "isosurface/extraction/crossed_page.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>

#include "core/base/assert.h"
#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

/// The number of keys of a code and a phase; the groups are in the order of their keys.
constexpr std::size_t kKeys = std::size_t{3} * ErrorScale::kCodes;
unsigned key(std::uint8_t code, int phase) {
  return 3 * (unsigned{ErrorScale::kCodes - 1} - code) + static_cast<unsigned>(phase);
}
int phase_of(LatticePoint q) { return 3 - (q.i & 1) - (q.j & 1) - (q.k & 1); }

/// Calls visit(place, code, phase) for each code that is not below `least`, i running fastest.
template <class Codes, class Visit>
void for_each_code(const Codes& codes, unsigned least, Visit&& visit) {
  for (std::int32_t row = 0; row < kSide * kSide; ++row) {
    const std::uint8_t* const of_row = codes.data() + kSide * row;
    unsigned bits = row_not_less(of_row, least);
    if (bits == 0) continue;
    const RowPhases phases(row % kSide, row / kSide);
    for (; bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      visit(static_cast<std::uint16_t>(kSide * row + i), of_row[i], (i & 1) != 0 ? phases.odd : phases.even);
    }
  }
}

/// The greatest of the codes that are below a code; 0 where there is none.
template <class Codes>
std::uint8_t greatest_below(const Codes& codes, unsigned code) {
  const auto end = static_cast<std::uint8_t>(code);
  std::uint8_t greatest = 0;
  for (const std::uint8_t each : codes) greatest = std::max(greatest, each < end ? each : std::uint8_t{0});
  return greatest;
}

/// The pages round one that have members of its diamond.
std::uint32_t pages_of_members(LatticePoint q) {
  // Bit 0 is the page before; each page further on is `step` bits higher.
  const auto along = [](std::int32_t x, int step) {
    return 1u << step | (x == 0 ? 1u : 0u) | (x == kSide - 1 ? 1u << 2 * step : 0u);
  };
  return along(q.i, 1) * along(q.j, 3) * along(q.k, 9);
}

}  // namespace

void CrossedPage::forget_counts() {
  counted = 0;
  added.clear();
  lost.clear();
  for (Group& group : groups) group.added = group.lost = 0;
}

std::span<const std::uint16_t> CrossedPage::uncounted(std::size_t wanted) const {
  if (wanted <= counted) return {};
  const std::size_t begin = groups[counted].begin, end = groups[wanted - 1].end;
  return std::span(places).subspan(begin, end - begin);
}

void CrossedPage::set_counted(std::size_t wanted, std::span<const std::int16_t> changes) {
  const std::size_t begin = groups[counted].begin, end = begin + changes.size();
  added.resize(end);
  if (!lost.empty()) lost.resize(end);
  for (; counted < wanted; ++counted) {
    Group& group = groups[counted];
    for (std::size_t n = group.begin; n < group.end; ++n) {
      const std::int16_t more = changes[n - begin];
      added[n] = static_cast<std::uint8_t>(std::max<std::int16_t>(more, 0));
      group.added += added[n];
      if (more >= 0) continue;
      lost.resize(end);
      lost[n] = static_cast<std::uint8_t>(-more);
      group.lost += lost[n];
    }
  }
}

void CrossedPage::find_members(std::size_t wanted) {
  while (members.size() < wanted) {
    const Group& group = groups[members.size()];
    std::uint32_t pages = 0;
    for (std::size_t n = group.begin; n < group.end; ++n) pages |= pages_of_members(point(places[n]));
    members.push_back(pages);
  }
}

template <class Sample>
void CrossedPageReader<Sample>::drop_bounds(int lod, LatticePoint block) {
  // Bounds of the finest LOD predict nothing, and others predict none here where pages are not loaded. Those
  // of the next step may be the same.
  StoredPages<OrderedWord<Sample>>& pages = diamonds_.pages();
  const PageId id = diamonds_.page_id(lod, block);
  if (id.lod < diamonds_.grid().top() && (lod == 0 || !pages.loads()) && pages.file().steps() == 1)
    pages.drop_bounds(id);
}

template <class Sample>
CrossedPage CrossedPageReader<Sample>::read(int lod, LatticePoint block, unsigned least) {
  diamonds_.find_crossed(lod, block, codes_);
  drop_bounds(lod, block);
  if (is_limited()) limit_codes(lod, block);
  return page_of_codes(lod, block, std::max(1u, unsigned{greatest_below(codes_, least)}));
}

template <class Sample>
CrossedPage CrossedPageReader<Sample>::read(int lod, LatticePoint block,
                                            const PageBounds<typename StoredDiamonds<Sample>::Word>& bounds) {
  diamonds_.find_crossed(lod, block, bounds, codes_);
  if (is_limited()) limit_codes(lod, block);
  return page_of_codes(lod, block, 1);
}

template <class Sample>
bool CrossedPageReader<Sample>::allows(int lod, LatticePoint block, LatticePoint q) const {
  return limits_->allow((1 << lod) * (kSide * block + q), lod, phase_of(q));
}

template <class Sample>
bool CrossedPageReader<Sample>::allows_any(int lod, LatticePoint block) const {
  if (!is_limited()) return true;
  for (std::uint16_t place = 0; place < PageGrid::kPoints; ++place) {
    const LatticePoint q = CrossedPage::point(place);
    // Other points belong to coarser LODs.
    if (phase_of(q) < 3 && allows(lod, block, q)) return true;
  }
  return false;
}

template <class Sample>
void CrossedPageReader<Sample>::limit_codes(int lod, LatticePoint block) {
  for_each_code(codes_, 1, [&](std::uint16_t place, std::uint8_t, int) {
    if (!allows(lod, block, CrossedPage::point(place))) codes_[place] = 0;
  });
}

template <class Sample>
ChildPages CrossedPageReader<Sample>::children(int lod, LatticePoint block, LatticePoint q) const {
  if (!is_limited()) return child_pages(q);
  ChildPages pages = 0;
  for (const LatticePoint offset : DiamondStencil::at(q).children) {
    const LatticePoint child = 2 * q + offset;
    if (allows(lod - 1, 2 * block, child)) pages |= 1u << page_around(child);
  }
  return pages;
}

template <class Sample>
CrossedPage CrossedPageReader<Sample>::page_of_codes(int lod, LatticePoint block, unsigned least) const {
  CrossedPage page;
  std::array<std::uint16_t, kKeys> next{};
  std::size_t total = 0, group_count = 0;
  // All diamonds with their keys, i running fastest.
  std::array<std::uint16_t, PageGrid::kPoints> places;
  std::array<std::uint8_t, PageGrid::kPoints> keys;
  for_each_code(codes_, least, [&](std::uint16_t place, std::uint8_t code, int phase) {
    const unsigned of_diamond = key(code, phase);
    places[total] = place;
    keys[total++] = static_cast<std::uint8_t>(of_diamond);
    ++next[of_diamond];
  });
  for (const std::uint16_t count : next) group_count += count > 0 ? 1 : 0;
  page.groups.reserve(group_count);
  page.places.resize(total);
  std::uint16_t begin = 0;
  for (std::size_t k = 0; k < kKeys; ++k) {
    const auto end = static_cast<std::uint16_t>(begin + next[k]);
    if (end > begin)
      page.groups.push_back({.code = static_cast<std::uint8_t>(ErrorScale::kCodes - 1 - k / 3),
                             .phase = static_cast<std::uint8_t>(k % 3),
                             .begin = begin,
                             .end = end});
    next[k] = begin;
    begin = end;
  }
  for (std::size_t n = 0; n < total; ++n) page.places[next[keys[n]]++] = places[n];
  for (CrossedPage::Group& group : page.groups) {
    // The finest LOD has no children.
    if (group.phase != 2 || lod == 0) continue;
    for (std::size_t n = group.begin; n < group.end; ++n)
      group.children |= children(lod, block, CrossedPage::point(page.places[n]));
  }
  return page;
}

template <class Sample>
void CrossedPageReader<Sample>::find_changes(int lod, LatticePoint block,
                                             std::span<const std::uint16_t> places,
                                             std::span<std::int16_t> changes) {
  PageMask wanted;
  for (const std::uint16_t place : places) wanted.add(place);
  counter_.load(lod, block, wanted);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const std::int64_t more = counter_.added_by_split(CrossedPage::point(places[n]));
    ADAMAS_ASSERT(std::abs(more) <= std::numeric_limits<std::uint8_t>::max());
    changes[n] = static_cast<std::int16_t>(more);
  }
}

template <class Sample>
void CrossedPageReader<Sample>::count(int lod, LatticePoint block, std::size_t groups, CrossedPage& page) {
  const std::span<const std::uint16_t> places = page.uncounted(groups);
  if (places.empty()) return;
  std::vector<std::int16_t> changes(places.size());
  find_changes(lod, block, places, changes);
  page.set_counted(groups, changes);
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(CrossedPageReader);

}  // namespace adamas::isosurface
