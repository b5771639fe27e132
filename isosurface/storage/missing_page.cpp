#include "isosurface/storage/missing_page.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace adamas {

namespace {

auto importance(const MissingPage& page) { return std::tuple(-page.view_class, page.depth, -page.id.lod); }

}  // namespace

void sort_by_importance(const PageGrid& grid, std::vector<MissingPage>& pages) {
  using Part = MissingPage::Part;
  const auto number = [&](const MissingPage& page) {
    return std::pair(grid.number(page.id), page.part == Part::kGradients);
  };
  // Of several wants of one page the most important one tells its place, and the greatest part all of them.
  std::ranges::sort(pages, [&](const MissingPage& a, const MissingPage& b) {
    return std::tuple(number(a), importance(a), a.part) < std::tuple(number(b), importance(b), b.part);
  });
  std::size_t count = 0;
  for (const MissingPage& page : pages) {
    if (count > 0 && number(pages[count - 1]) == number(page)) {
      pages[count - 1].part = std::max(pages[count - 1].part, page.part);
    } else {
      pages[count++] = page;
    }
  }
  pages.resize(count);
  std::ranges::stable_sort(pages, {}, importance);
}

}  // namespace adamas
