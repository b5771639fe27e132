#pragma once

// Members of ViewedPages for walks that load no pages; viewed_pages.cpp alone includes this.

#include <algorithm>
#include <bit>

#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

/// Pages that no cube of the grid has stand for the coarser ones that have their only point.
inline PageId page_with_points(const PageGrid& grid, PageId id) {
  while (!grid.contains(id)) id = {id.lod + 1, {id.block.i / 2, id.block.j / 2, id.block.k / 2}};
  return id;
}

template <class Sample>
bool ViewedPages<Sample>::tell(ViewedPage& page) {
  const PageId id{page.lod, page.block};
  StoredPages<typename ViewedDiamonds<Sample>::Word>& pages = diamonds_.pages();
  if (page.lod >= diamonds_.grid().top()) {
    // The coarsest page has diamonds of several LODs, and the directory does not tell of each.
    page.greatest = error_class(ErrorScale::kCodes - 1, page.lod);
  } else {
    if (!loads_ && !pages.file().has_entry(pages.step(), id)) return false;
    if (!loads_ && !pages.entry(id)) {
      pages.note_lost(id);
      return false;
    }
    page.greatest = diamonds_.greatest_class(id);
  }
  page.is_told = true;
  return true;
}

/// No diamond has a greater error than its parents, which are on pages of the next coarser LOD where they are
/// not on the diamond's own page or next to it.
template <class Sample>
int ViewedPages<Sample>::greatest_of_parents(const ViewedPage& page) {
  int greatest = 0;
  for (std::int32_t n = 0; n < 27; ++n) {
    const LatticePoint step = step_around(n);
    const LatticePoint own{page.block.i / 2, page.block.j / 2, page.block.k / 2};
    const ViewedPage* const parent = find(page.lod + 1, own + step);
    if (parent == nullptr || parent->looked_at != walk_ || parent->crossed->groups.empty()) continue;
    greatest = std::max(greatest, error_class(parent->crossed->groups.front().code, parent->lod));
  }
  return greatest;
}

template <class Sample>
void ViewedPages<Sample>::note_missing(const PageId& id, MissingPage::Part part, int view_class,
                                       double depth) {
  greatest_missing_ = std::max(greatest_missing_, view_class);
  if (diamonds_.pages().is_lost(id)) {
    ++lost_;
  } else {
    missing_.push_back({id, part, view_class, depth, diamonds_.pages().step()});
  }
}

template <class Sample>
template <class Visit>
bool ViewedPages<Sample>::for_each_member_page(const ViewedPage& page, std::uint32_t members, Visit&& visit) {
  const PageGrid& grid = diamonds_.grid();
  // The coarsest page has all members of its diamonds.
  if (page.lod >= grid.top()) return visit(PageId{grid.top(), {0, 0, 0}});
  const LatticePoint blocks = grid.blocks(page.lod);
  for (std::uint32_t bits = members; bits != 0; bits &= bits - 1) {
    const LatticePoint block = page.block + step_around(std::countr_zero(bits));
    if (!is_below(block, blocks)) continue;
    if (!visit(page_with_points(grid, {page.lod, block}))) return false;
  }
  return true;
}

template <class Sample>
void ViewedPages<Sample>::find_members(const ViewedPage& page, std::size_t groups) {
  bytes_ -= page.crossed->bytes();
  page.crossed->find_members(groups);
  bytes_ += page.crossed->bytes();
}

template <class Sample>
std::size_t ViewedPages<Sample>::groups_in_memory(const ViewedPage& page) {
  find_members(page, page.groups_wanted);
  auto& pages = diamonds_.pages();
  const std::vector<std::uint32_t>& members = page.crossed->members;
  std::size_t group = 0;
  // Those of groups before are there.
  for (std::uint32_t known = 0; group < page.groups_wanted; known |= members[group++]) {
    const bool has_all = for_each_member_page(
        page, members[group] & ~known, [&](const PageId& id) { return pages.has(id, PageParts::kSamples); });
    if (!has_all) break;
  }
  return group;
}

template <class Sample>
bool ViewedPages<Sample>::find_in_memory(ViewedPage& page, const PageView& view) {
  auto& pages = diamonds_.pages();
  const auto note_incomplete = [&] { incomplete_[static_cast<std::size_t>(page.lod)].push_back(&page); };
  const PageId id = diamonds_.page_id(page.lod, page.block);
  if (page.crossed == nullptr) {
    if (!page.is_told || !pages.has(id, PageParts::kAll)) {
      const double depth = view.least_depth(0);
      note_missing(id, page.is_told ? MissingPage::Part::kAll : MissingPage::Part::kDirectory,
                   class_at(page.greatest, depth), depth);
      note_incomplete();
      return false;
    }
    read(page);
    page.groups_in_memory = 0;
  }
  page.used = frame_;
  page.groups_wanted = groups_within(*page.crossed, page.lod, view.least_depth(0));
  if (page.groups_in_memory < page.groups_wanted || page.left_then != pages.left()) {
    page.groups_in_memory = groups_in_memory(page);
    page.left_then = pages.left();
  }
  if (page.groups_in_memory >= page.groups_wanted) return true;
  note_missing_groups(page, view);
  note_incomplete();
  return true;
}

/// What is not in memory of the members of groups, up to the last one that has a diamond of the walk's
/// classes in sight.
template <class Sample>
void ViewedPages<Sample>::note_missing_groups(const ViewedPage& page, const PageView& view) {
  const CrossedPage& known = *page.crossed;
  std::size_t end = page.groups_in_memory;
  int greatest = 0;
  double nearest = view.greatest_depth(0);
  for (std::size_t g = page.groups_in_memory; g < page.groups_wanted; ++g) {
    const CrossedPage::Group& group = known.groups[g];
    const int of_error = error_class(group.code, page.lod);
    for (std::size_t n = group.begin; n < group.end; ++n) {
      const double depth = view.depth(known.places[n], group.phase);
      if (depth > low_[static_cast<std::size_t>(of_error)] || !view.is_visible(known.places[n], group.phase))
        continue;
      end = g + 1;
      greatest = std::max(greatest, class_at(of_error, depth));
      nearest = std::min(nearest, depth);
    }
  }
  auto& pages = diamonds_.pages();
  for (std::size_t g = page.groups_in_memory; g < end; ++g) {
    for_each_member_page(page, page.crossed->members[g], [&](const PageId& id) {
      if (!pages.has(id, PageParts::kSamples))
        note_missing(id, MissingPage::Part::kSamples, greatest, nearest);
      return true;
    });
  }
}

template <class Sample>
void ViewedPages<Sample>::suspect_round(const ViewedPage& page) {
  for (std::int32_t n = 0; n < 27; ++n) {
    ViewedPage* const near = find(page.lod, page.block + step_around(n));
    if (near != nullptr) near->suspect = walk_;
  }
}

template <class Sample>
void ViewedPages<Sample>::suspect_children(const ViewedPage& page) {
  const bool is_finer = page.lod <= diamonds_.grid().top();
  for (std::int32_t n = 0; n < 64; ++n) {
    const LatticePoint step{n % 4 - 1, n / 4 % 4 - 1, n / 16 - 1};
    ViewedPage* const near = find(page.lod - 1, (is_finer ? 2 : 1) * page.block + step);
    if (near != nullptr) near->suspect = walk_;
  }
}

template <class Sample>
bool ViewedPages<Sample>::has_parents(LatticePoint p) {
  const auto parents = Diamond(p).parents(diamonds_.domain());
  return std::ranges::all_of(parents, [&](LatticePoint parent) {
    if (!diamonds_.is_stored(parent)) return true;
    const auto [page, q] = find(parent);
    if (page == nullptr || page->looked_at != walk_) return false;
    return page->masks->above.has(q) || page->masks->at_low.has(q);
  });
}

template <class Sample>
void ViewedPages<Sample>::drop_without_parents(int lod, Added& added) {
  const auto l = static_cast<std::size_t>(lod);
  std::vector<ViewedPage*>& incomplete = incomplete_[l];
  if (l + 1 < incomplete_.size()) {
    for (const ViewedPage* const page : incomplete_[l + 1]) suspect_children(*page);
  }
  for (const ViewedPage* const page : incomplete) suspect_round(*page);
  for (int phase = 0; phase < 3; ++phase) {
    std::vector<ViewedPage*> changed;
    for (ViewedPage* const page : active_[l]) {
      if (page->suspect == walk_ && drop_without_parents(*page, phase, added)) changed.push_back(page);
    }
    for (ViewedPage* const page : changed) suspect_round(*page);
    incomplete.insert(incomplete.end(), changed.begin(), changed.end());
  }
}

template <class Sample>
bool ViewedPages<Sample>::drop_without_parents(ViewedPage& page, int phase, Added& added) {
  const CrossedPage& known = *page.crossed;
  Sum& of_generation = added.of_generations[static_cast<std::size_t>(diamonds_.generation(page.lod) + phase)];
  const auto p = static_cast<std::size_t>(phase);
  const LatticePoint corner = PageGrid::kSide * page.block;
  bool is_changed = false;
  std::uint32_t children = 0;
  for (std::size_t g = 0; g < page.groups_in_memory; ++g) {
    if (known.groups[g].phase != phase) continue;
    for (std::size_t n = known.groups[g].begin; n < known.groups[g].end; ++n) {
      const LatticePoint q = CrossedPage::point(known.places[n]);
      const bool is_above = page.masks->above.has(q);
      if (!is_above && !page.masks->at_low.has(q)) continue;
      if (has_parents(diamonds_.lattice_step(page.lod) * (corner + q))) {
        children |= phase == 2 ? child_pages(q) : 0u;
        continue;
      }
      is_changed = true;
      (is_above ? page.masks->above : page.masks->at_low).remove(known.places[n]);
      const auto [more, lost] = counts_ ? known.change(n) : CrossedPage::Change{};
      if (is_above) {
        added.above -= {more, lost};
      } else {
        page.at_low[p] -= more;
        page.lost_at_low[p] -= lost;
        of_generation -= {more, lost};
      }
    }
  }
  if (phase == 2) page.children = children;
  return is_changed;
}

template <class Sample>
template <class Visit>
void ViewedPages<Sample>::for_each_needed(Visit&& visit) {
  for (const auto& of_lod : active_) {
    for (const ViewedPage* const page : of_lod) {
      const double depth = view_of(*page).least_depth(0);
      const std::size_t groups = page->groups_wanted;
      find_members(*page, groups);
      if (groups > 0) {
        const PageId own = diamonds_.page_id(page->lod, page->block);
        visit(own, MissingPage::Part::kAll,
              class_at(error_class(page->crossed->groups[0].code, page->lod), depth), depth);
      }
      // The first of the groups with members on a page have the greatest errors.
      std::uint32_t known = 0;
      for (std::size_t g = 0; g < groups; ++g) {
        const std::uint32_t members = page->crossed->members[g] & ~known;
        if (members == 0) continue;
        known |= members;
        const int importance = class_at(error_class(page->crossed->groups[g].code, page->lod), depth);
        for_each_member_page(*page, members, [&](const PageId& id) {
          visit(id, MissingPage::Part::kSamples, importance, depth);
          return true;
        });
      }
    }
  }
}

template <class Sample>
void ViewedPages<Sample>::spare_needed() {
  auto& pages = diamonds_.pages();
  pages.forget_needs();
  for_each_needed(
      [&](const PageId& id, MissingPage::Part, int importance, double) { pages.need(id, importance); });
}

template <class Sample>
std::vector<MissingPage> ViewedPages<Sample>::needed() {
  std::vector<MissingPage> pages;
  for_each_needed([&](const PageId& id, MissingPage::Part part, int view_class, double depth) {
    pages.push_back({id, part, view_class, depth, diamonds_.pages().step()});
  });
  return pages;
}

}  // namespace adamas::isosurface
