#include "isosurface/extraction/triangle_budget.h"

#include <algorithm>
#include <limits>

#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

template <class Sample>
TriangleBudget<Sample>::TriangleBudget(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages,
                                       const SurfaceRequest& request)
    : split_pages_(pages), counter_(diamonds, request), page_counter_(diamonds, request) {}

template <class Sample>
PageMask TriangleBudget<Sample>::of_classes(int lod, const PageOfLod& page, int low, int high) {
  PageMask found = *page.split;
  const unsigned least = CutOfPage::code(low, lod), end = CutOfPage::code(high, lod);
  if (page.cut.least() >= end) return {};
  const auto& codes = split_pages_.codes(lod, page.block);
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
  const PageMask wanted = of_classes(lod, page, low, high);
  if (!wanted.any()) return;
  page_counter_.load(lod, page.block, wanted);
  const auto& codes = split_pages_.codes(lod, page.block);
  wanted.for_each([&](LatticePoint q) {
    visit(q, error_class(codes[PageGrid::place(q, 0)], lod),
          split_pages_.generation(lod) + DiamondStencil::at(q).phase, page_counter_.added_by_split(q));
  });
}

template <class Sample>
void TriangleBudget<Sample>::tighten(int high, std::int64_t room, SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int error_class = high - 1; error_class >= cut.error_class; --error_class) {
    for (int generation = 0; generation < generations(); ++generation) {
      sum += added(error_class, generation);
      if (sum <= room) continue;
      cut = {.error_class = error_class, .generation = generation + 1};
      return;
    }
  }
}

template <class Sample>
std::int64_t TriangleBudget<Sample>::added_before_last(int high, const SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int error_class = cut.error_class; error_class < high; ++error_class) {
    const int end =
        error_class > cut.error_class ? generations() : std::min(cut.generation - 1, generations());
    for (int generation = 0; generation < end; ++generation) sum += added(error_class, generation);
  }
  return sum;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::count(int low, int high, std::int64_t room, Progress& progress) {
  added_.assign(static_cast<std::size_t>(StoredDiamonds<Sample>::kErrorClasses * generations()), 0);
  SurfaceCut cut{.error_class = low};
  std::int64_t sum = 0;
  split_pages_.find(cut, [&](int lod, const PageOfLod& page) {
    progress.step("choosing", 1 - (lod + 1.0) / split_pages_.lods());
    visit_page(lod, page, low, high, [&](LatticePoint, int error_class, int generation, std::int64_t more) {
      added(error_class, generation) += more;
      sum += more;
    });
    // Diamonds that come after the first for which there is no room do not matter.
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
  split_pages_.find(cut, [&](int lod, const PageOfLod& page) {
    if (split_pages_.generation(lod) != generation - generation % 3) return;
    visit_page(lod, page, cut.error_class, cut.error_class + 1,
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
SurfaceCut TriangleBudget<Sample>::find(std::uint64_t triangles, int least_class, const Diamond& root,
                                        Progress& progress) {
  const auto most =
      static_cast<std::int64_t>(std::min<std::uint64_t>(triangles, std::numeric_limits<std::int64_t>::max()));
  std::int64_t total = counter_.triangles(root);
  int high = std::max(split_pages_.class_if_allowed(root.point()) + 1, least_class);
  while (high > least_class) {
    const int low =
        std::max(least_class, high - classes_further(static_cast<double>(total), static_cast<double>(most)));
    const SurfaceCut cut = count(low, high, most - total, progress);
    total += added_before_last(high, cut);
    if (cut.generation != SurfaceCut::kAll) return find_place(cut, most - total);
    high = low;
  }
  return {.error_class = least_class};
}

template class TriangleBudget<std::uint8_t>;
template class TriangleBudget<std::uint16_t>;
template class TriangleBudget<std::int16_t>;
template class TriangleBudget<float>;

}  // namespace adamas::isosurface
