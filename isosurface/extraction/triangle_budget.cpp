#include "isosurface/extraction/triangle_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isosurface/volume/z_order.h"

namespace adamas {

namespace {

/// How many ranks further the surface may be followed in one go: mostly a surface has 2^(1/4) times the
/// triangles with each rank.
int ranks_further(std::int64_t triangles, std::int64_t most) {
  constexpr double kMost = 8;
  const double ratio = static_cast<double>(most) / static_cast<double>(std::max<std::int64_t>(triangles, 1));
  return static_cast<int>(std::clamp(4 * std::log2(ratio), 1.0, kMost));
}

}  // namespace

template <class Sample>
TriangleBudget<Sample>::TriangleBudget(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages,
                                       const SurfaceRequest& request, int bisections)
    : pages_(pages),
      request_(request),
      bisections_(bisections),
      counter_(diamonds, request, bisections),
      page_(diamonds) {}

template <class Sample>
PageMask TriangleBudget<Sample>::of_ranks(int lod, const PageOfLod& page, int low, int high) {
  PageMask found = *page.split;
  const unsigned least = CutOfPage::code(low, lod), end = CutOfPage::code(high, lod);
  if (page.cut.least() >= end) return {};
  const auto& codes = pages_.codes(lod, page.block);
  for (std::size_t row = 0; row < found.rows.size(); ++row) {
    if (found.rows[row] == 0) continue;
    const std::uint8_t* of_row = codes.data() + PageGrid::kSide * row;
    const unsigned wanted = row_not_less(of_row, least) & ~row_not_less(of_row, end);
    found.rows[row] = static_cast<std::uint16_t>(found.rows[row] & wanted);
  }
  return found;
}

template <class Sample>
template <class Visit>
void TriangleBudget<Sample>::visit_page(int lod, const PageOfLod& page, int low, int high, Visit&& visit) {
  const PageMask wanted = of_ranks(lod, page, low, high);
  if (!wanted.any()) return;
  page_.load(lod, page.block, wanted);
  const auto& codes = pages_.codes(lod, page.block);
  const bool simple = bisections_ == 0 && page_.all_finite();
  wanted.for_each([&](LatticePoint q) {
    const DiamondStencil& stencil = DiamondStencil::at(q);
    // What is clipped is worked out.
    const bool whole =
        simple && ((page_.is_inside() && !request_.region) || counter_.is_inside(page_.diamond(q)));
    const std::int64_t more =
        whole ? page_.triangles_added(stencil, q) : counter_.added_by_split(page_.diamond(q));
    visit(q, codes[PageGrid::place(q, 0)] + 4 * lod, 3 * (pages_.lods() - 1 - lod) + stencil.phase, more);
  });
}

template <class Sample>
void TriangleBudget<Sample>::tighten(int high, std::int64_t room, SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int rank = high - 1; rank >= cut.rank; --rank) {
    for (int generation = 0; generation < generations(); ++generation) {
      sum += added(rank, generation);
      if (sum <= room) continue;
      cut = {.rank = rank, .generation = generation + 1};
      return;
    }
  }
}

template <class Sample>
std::int64_t TriangleBudget<Sample>::added_before_last(int high, const SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int rank = cut.rank; rank < high; ++rank) {
    const int end = rank > cut.rank ? generations() : std::min(cut.generation - 1, generations());
    for (int generation = 0; generation < end; ++generation) sum += added(rank, generation);
  }
  return sum;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::count(int low, int high, std::int64_t room, Progress& progress) {
  added_.assign(static_cast<std::size_t>(StoredDiamonds<Sample>::kRanks * generations()), 0);
  SurfaceCut cut{.rank = low};
  std::int64_t sum = 0;
  pages_.find(cut, [&](int lod, const PageOfLod& page) {
    progress.step("choosing", 1 - (lod + 1.0) / pages_.lods());
    visit_page(lod, page, low, high, [&](LatticePoint, int rank, int generation, std::int64_t more) {
      added(rank, generation) += more;
      sum += more;
    });
    // What comes after the first diamond that there is no room for does not matter.
    if (sum > room) tighten(high, room, cut);
  });
  return cut;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find_place(SurfaceCut cut, std::int64_t room) {
  struct Added {
    std::uint64_t page;
    std::size_t place;
    std::int64_t triangles;
  };
  const int generation = cut.generation - 1;
  std::vector<Added> all;
  pages_.find(cut, [&](int lod, const PageOfLod& page) {
    if (lod != pages_.lods() - 1 - generation / 3) return;
    visit_page(lod, page, cut.rank, cut.rank + 1,
               [&](LatticePoint q, int, int of_generation, std::int64_t more) {
                 if (of_generation == generation)
                   all.push_back({ZOrder::interleave(page.block), PageGrid::place(q, 0), more});
               });
  });
  cut.generation = generation;
  for (const Added& next : all) {
    cut.page = next.page;
    cut.place = next.place;
    room -= next.triangles;
    if (room < 0) break;
  }
  return cut;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find(std::uint64_t triangles, int least_rank, const Diamond& root,
                                        Progress& progress) {
  const auto most =
      static_cast<std::int64_t>(std::min<std::uint64_t>(triangles, std::numeric_limits<std::int64_t>::max()));
  std::int64_t total = counter_.triangles(root);
  int high = std::max(pages_.rank(root.point()) + 1, least_rank);
  while (high > least_rank) {
    const int low = std::max(least_rank, high - ranks_further(total, most));
    const SurfaceCut cut = count(low, high, most - total, progress);
    total += added_before_last(high, cut);
    if (cut.generation != SurfaceCut::kAll) return find_place(cut, most - total);
    high = low;
  }
  return {.rank = least_rank};
}

template class TriangleBudget<std::uint8_t>;
template class TriangleBudget<std::uint16_t>;
template class TriangleBudget<std::int16_t>;
template class TriangleBudget<float>;

}  // namespace adamas
