#include "isosurface/extraction/triangle_budget.h"

#include <algorithm>
#include <limits>

#include "isosurface/extraction/triangle_counter.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

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
  split_pages_.find(cut, [&](SplitPage& page) {
    progress.step("choosing", 1 - (page.lod + 1.0) / split_pages_.lods());
    split_pages_.count(page);
    for (std::size_t g = 0; g < page.groups; ++g) {
      const CrossedPage::Group& group = page.crossed->groups[g];
      const int of_group = error_class(group.code, page.lod);
      if (of_group >= high) continue;
      const std::int64_t more = std::int64_t{group.added} - group.lost;
      added(of_group, split_pages_.generation(page.lod) + group.phase) += more;
      sum += more;
    }
    // Diamonds that come after the first for which there is no room do not matter.
    if (sum > room) tighten(high, room, cut);
  });
  return cut;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find_place(SurfaceCut cut, std::int64_t room) {
  const int generation = cut.generation - 1;
  SurfaceCut found{.error_class = cut.error_class, .generation = generation};
  split_pages_.find(cut, [&](SplitPage& page) {
    if (room < 0 || split_pages_.generation(page.lod) != generation - generation % 3) return;
    split_pages_.count(page);
    for (std::size_t g = 0; g < page.groups; ++g) {
      const CrossedPage::Group& group = page.crossed->groups[g];
      if (error_class(group.code, page.lod) != cut.error_class || group.phase != generation % 3) continue;
      for (std::size_t n = group.begin; n < group.end && room >= 0; ++n) {
        found.page = page.order;
        found.place = page.crossed->places[n];
        const CrossedPage::Change change = page.crossed->change(n);
        room -= std::int64_t{change.added} - change.lost;
      }
    }
  });
  return found;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find(std::uint64_t triangles, int least_class, const Diamond& root,
                                        Progress& progress) {
  const auto most =
      static_cast<std::int64_t>(std::min<std::uint64_t>(triangles, std::numeric_limits<std::int64_t>::max()));
  std::int64_t total = TriangleCounter<Sample>(diamonds_, request_).triangles(root);
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

ADAMAS_INSTANTIATE_FOR_SAMPLES(TriangleBudget);

}  // namespace adamas::isosurface
