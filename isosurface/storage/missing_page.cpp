#include "isosurface/storage/missing_page.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <unordered_map>

namespace adamas::isosurface {

namespace {

auto importance(const MissingPage& page) { return std::tuple(-page.view_class, page.depth, -page.id.lod); }

}  // namespace

void sort_by_importance(const PageGrid& grid, std::vector<MissingPage>& pages) {
  using Part = MissingPage::Part;
  struct Wanted {
    std::uint64_t number;
    MissingPage page;
  };
  std::vector<Wanted> all;
  // Several entries of one page become one: it has the place of the most important one, and the greatest
  // part.
  std::unordered_map<std::uint64_t, std::size_t> places;
  for (const MissingPage& page : pages) {
    const std::uint64_t number = 2 * grid.number(page.id) + (page.part == Part::kGradients ? 1 : 0);
    const auto [found, is_new] = places.try_emplace(number, all.size());
    if (is_new) {
      all.push_back({number, page});
      continue;
    }
    MissingPage& known = all[found->second].page;
    const Part part = std::max(known.part, page.part);
    if (importance(page) < importance(known)) known = page;
    known.part = part;
  }
  std::ranges::sort(all, {}, [](const Wanted& wanted) {
    return std::tuple_cat(importance(wanted.page), std::tuple(wanted.number));
  });
  pages.clear();
  for (const Wanted& wanted : all) pages.push_back(wanted.page);
}

}  // namespace adamas::isosurface
