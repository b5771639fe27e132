#include "isosurface/view/viewed_pages.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "isosurface/view/viewed_pages_by_threads.h"
#include "isosurface/view/viewed_pages_in_memory.h"
#include "isosurface/view/viewed_pages_in_time.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

template <class Sample>
typename ViewedPages<Sample>::Sum ViewedPages<Sample>::Added::all() const {
  Sum sum = above;
  for (const Sum& of_generation : of_generations) sum += of_generation;
  return sum;
}

template <class Sample>
ViewedPages<Sample>::ViewedPages(ViewedDiamonds<Sample>& diamonds, const SurfaceRequest& surface,
                                 std::size_t memory)
    : diamonds_(diamonds),
      surface_(surface),
      reader_(diamonds, surface),
      memory_(memory),
      index_(static_cast<std::size_t>(diamonds.lods())),
      incomplete_(index_.size()),
      active_(index_.size()) {
  for (int lod = 0; lod < diamonds.lods(); ++lod)
    places_.emplace_back(diamonds.domain(), diamonds.lattice_step(lod), diamonds.grid().reach(lod));
}

template <class Sample>
void ViewedPages<Sample>::clear() {
  shown_.clear();
  for (auto& of_lod : active_) of_lod.clear();
  for (auto& of_lod : incomplete_) of_lod.clear();
  for (auto& of_lod : index_) of_lod.clear();
  pages_.clear();
  bytes_ = 0;
}

template <class Sample>
typename ViewedPages<Sample>::Depths ViewedPages<Sample>::depths_of(int view_class) const {
  Depths depths(StoredDiamonds<Sample>::kErrorClasses);
  for (std::size_t n = 0; n < depths.size(); ++n)
    depths[n] = diamonds_.farthest(diamonds_.error(static_cast<int>(n)), view_class);
  return depths;
}

template <class Sample>
ViewedPage* ViewedPages<Sample>::find(int lod, LatticePoint block) {
  if (lod < 0 || lod >= lods()) return nullptr;
  ViewedPage* const* const found = index_[static_cast<std::size_t>(lod)].find(block);
  return found == nullptr ? nullptr : *found;
}

template <class Sample>
typename ViewedPages<Sample>::PageAndPlace ViewedPages<Sample>::find(LatticePoint p) {
  const auto [lod, block, on_page] = diamonds_.place(p);
  return {find(lod, block), on_page};
}

template <class Sample>
ViewedPage& ViewedPages<Sample>::page(int lod, LatticePoint block) {
  if (ViewedPage* const known = find(lod, block)) return *known;
  ViewedPage& added = pages_.emplace_back();
  added.lod = lod;
  added.block = block;
  added.order = ZOrder::interleave(block);
  added.step = diamonds_.pages().step();
  *index_[static_cast<std::size_t>(lod)].insert(block).first = &added;
  return added;
}

template <class Sample>
void ViewedPages<Sample>::add_candidate(int lod, LatticePoint block) {
  if (!has_page(diamonds_.grid(), lod, block)) return;
  ViewedPage* const known = &page(lod, block);
  if (std::exchange(known->met, walk_) == walk_) return;
  if (known->step != diamonds_.pages().step()) renew(*known);
  known->split = nullptr;
  known->children = 0;
  known->at_low = known->lost_at_low = {};
  candidates_.push_back(known);
}

template <class Sample>
void ViewedPages<Sample>::find_candidates(int lod) {
  candidates_.clear();
  if (lod >= diamonds_.grid().top()) return add_candidate(lod, {0, 0, 0});
  const auto add = [&](LatticePoint block) { add_candidate(lod, block); };
  for (const ViewedPage* parent : active_[static_cast<std::size_t>(lod) + 1])
    for_each_child_page(parent->block, parent->children, add);
  for (std::size_t n = 0; n < candidates_.size(); ++n)
    for_each_page_of_last_points(diamonds_.grid(), lod, candidates_[n]->block, add);
  std::ranges::sort(candidates_, {}, &ViewedPage::order);
}

template <class Sample>
std::optional<typename ViewedPages<Sample>::Added> ViewedPages<Sample>::walk(int least_class,
                                                                             std::uint64_t room,
                                                                             const Check& check) {
  ++walk_;
  depth_tests_ = hidden_ = 0;
  missing_.clear();
  lost_ = 0;
  greatest_missing_ = 0;
  low_ = depths_of(least_class);
  next_ = depths_of(least_class + 1);
  greatest_passed_ = 0;
  counts_ = room != kAnyNumber;
  Added added;
  added.of_generations.resize(static_cast<std::size_t>(generations()));
  for (int lod = lods() - 1; lod >= 0; --lod) {
    find_candidates(lod);
    find_in_sight(check);
    read_ahead_of_walk();
    std::vector<ViewedPage*>& active = active_[static_cast<std::size_t>(lod)];
    active.clear();
    incomplete_[static_cast<std::size_t>(lod)].clear();
    for (const auto& [page, view] : in_sight_) {
      if (!loads_ && !find_in_memory(*page, view)) continue;
      look_at(*page, view, added);
      active.push_back(page);
      if (loads_ && added.above.added > room) return {};
    }
    if (loads_) continue;
    drop_without_parents(lod, added);
    if (added.above.added > room) return {};
  }
  return added;
}

template <class Sample>
void ViewedPages<Sample>::find_in_sight(const Check& check) {
  in_sight_.clear();
  for (ViewedPage* const page : candidates_) {
    check();
    if (!page->is_told && !tell(*page)) page->greatest = greatest_of_parents(*page);
    if (page->greatest == 0) continue;
    const PageView view = view_of(*page);
    depth_tests_ += view.has_depths() ? 1 : 0;
    hidden_ += view.is_occluded() ? 1 : 0;
    if (view.is_hidden()) continue;
    const double depth = view.least_depth(0);
    if (low_[static_cast<std::size_t>(page->greatest)] < depth) {
      greatest_passed_ = std::max(greatest_passed_, class_at(page->greatest, depth));
      continue;
    }
    in_sight_.push_back({page, view});
  }
}

template <class Sample>
std::size_t ViewedPages<Sample>::find_groups(ViewedPage& page, const PageView& view) {
  page.used = frame_;
  if (page.crossed == nullptr) read(page);
  CrossedPage& known = *page.crossed;
  if (loads_) page.groups_wanted = groups_within(known, page.lod, view.least_depth(0));
  const std::size_t groups = loads_ ? page.groups_wanted : page.groups_in_memory;
  if (counts_ && groups > known.counted) {
    bytes_ -= known.bytes();
    if (!count_by_threads(page, groups)) reader_.count(page.lod, page.block, groups, known);
    bytes_ += known.bytes();
  }
  return groups;
}

template <class Sample>
void ViewedPages<Sample>::read(ViewedPage& page) {
  set_crossed(page, reader_.read(page.lod, page.block));
  bytes_ += bytes_of(page);
}

template <class Sample>
std::size_t ViewedPages<Sample>::groups_within(const CrossedPage& known, int lod, double depth) const {
  std::size_t groups = 0;
  while (groups < known.groups.size() &&
         low_[static_cast<std::size_t>(error_class(known.groups[groups].code, lod))] >= depth)
    ++groups;
  return groups;
}

template <class Sample>
bool ViewedPages<Sample>::is_occluded(const PageView& view, std::uint16_t place, int phase) {
  const bool is_hidden = view.is_occluded(place, phase);
  ++depth_tests_;
  hidden_ += is_hidden ? 1 : 0;
  return is_hidden;
}

template <class Sample>
void ViewedPages<Sample>::look_at(ViewedPage& page, const PageView& view, Added& added) {
  const std::size_t groups = find_groups(page, view);
  const CrossedPage& known = *page.crossed;
  PageMask &above = page.masks->above, &at_low = page.masks->at_low;
  above = at_low = {};
  page.looked_at = walk_;
  const bool whole = view.is_whole();
  for (std::size_t g = 0; g < groups; ++g) {
    const CrossedPage::Group& group = known.groups[g];
    const auto of_error = static_cast<std::size_t>(error_class(group.code, page.lod));
    const double low = low_[of_error], next = next_[of_error], least = view.least_depth(group.phase),
                 greatest = view.greatest_depth(group.phase);
    if (low < view.least_depth(0)) break;
    if (low < least) continue;
    const std::span<const std::uint16_t> places(known.places.data() + group.begin,
                                                known.places.data() + group.end);
    if (whole && greatest <= next) {
      for (const std::uint16_t place : places) above.add(place);
      added.above += {group.added, group.lost};
      page.children |= group.children;
    } else if (whole && next < least && greatest <= low) {
      for (const std::uint16_t place : places) at_low.add(place);
      page.at_low[group.phase] += group.added;
      page.lost_at_low[group.phase] += group.lost;
      page.children |= group.children;
    } else {
      for (std::size_t n = group.begin; n < group.end; ++n) {
        const std::uint16_t place = known.places[n];
        const double depth = view.depth(place, group.phase);
        if (depth > low || (!whole && !view.is_in_picture(place, group.phase))) continue;
        if (view.has_depths() && is_occluded(view, place, group.phase)) continue;
        const auto [more, lost] = counts_ ? known.change(n) : CrossedPage::Change{};
        if (depth <= next) {
          above.add(place);
          added.above += {more, lost};
        } else {
          at_low.add(place);
          page.at_low[group.phase] += more;
          page.lost_at_low[group.phase] += lost;
        }
        if ((group.children & ~page.children) != 0) page.children |= child_pages(CrossedPage::point(place));
      }
    }
  }
  for (std::size_t phase = 0; phase < 3; ++phase)
    added.of_generations[static_cast<std::size_t>(diamonds_.generation(page.lod)) + phase] +=
        {page.at_low[phase], page.lost_at_low[phase]};
}

template <class Sample>
typename ViewedPages<Sample>::CutAndSum ViewedPages<Sample>::cut_within(int least_class, const Added& added,
                                                                        std::uint64_t room) {
  CutAndSum found{{.error_class = least_class, .generation = 0}, added.above};
  std::size_t generation = 0;
  for (; found.sum.added + added.of_generations[generation].added <= room; ++generation)
    found.sum += added.of_generations[generation];
  found.cut.generation = static_cast<int>(generation);
  const std::size_t phase = generation % 3;
  for (const ViewedPage* const page : active_[index_.size() - 1 - generation / 3]) {
    if (found.sum.added + page->at_low[phase] > room) {
      end_on(*page, room, found);
      break;
    }
    found.sum += {page->at_low[phase], page->lost_at_low[phase]};
  }
  return found;
}

template <class Sample>
void ViewedPages<Sample>::end_on(const ViewedPage& page, std::uint64_t room, CutAndSum& found) {
  const CrossedPage& known = *page.crossed;
  std::vector<std::pair<std::uint16_t, std::size_t>> at_low;
  for (std::size_t g = 0; g < page.groups_wanted; ++g) {
    if (known.groups[g].phase != found.cut.generation % 3) continue;
    for (std::size_t n = known.groups[g].begin; n < known.groups[g].end; ++n) {
      if (page.masks->at_low.has(CrossedPage::point(known.places[n])))
        at_low.emplace_back(known.places[n], n);
    }
  }
  std::ranges::sort(at_low);
  found.cut.page = page.order;
  for (const auto& [place, n] : at_low) {
    found.cut.place = place;
    if (found.sum.added + known.added[n] > room) return;
    found.sum += {known.added[n], known.change(n).lost};
  }
}

template <class Sample>
void ViewedPages<Sample>::set_split(ViewedPage& page, int generation, const SurfaceCut& cut) {
  ViewedMasks& masks = *page.masks;
  masks.split = masks.above;
  const LastOfCut last(cut, generation, page.order);
  if (last.has_none()) return;
  constexpr auto kSide = static_cast<std::size_t>(PageGrid::kSide);
  for (std::size_t row = 0; row < masks.at_low.rows.size(); ++row) {
    const unsigned at_low = masks.at_low.rows[row];
    if (at_low == 0) continue;
    const RowPhases phases(static_cast<std::int32_t>(row % kSide), static_cast<std::int32_t>(row / kSide));
    masks.split.rows[row] =
        static_cast<std::uint16_t>(masks.split.rows[row] | (at_low & last.of_row(phases, row)));
  }
}

template <class Sample>
int ViewedPages<Sample>::left_on(const ViewedPage& page, const PageView& view, int known) const {
  for (const CrossedPage::Group& group : page.crossed->groups) {
    const int of_error = error_class(group.code, page.lod);
    if (class_at(of_error, view.least_depth(group.phase)) <= known) continue;
    for (std::size_t n = group.begin; n < group.end; ++n) {
      const std::uint16_t place = page.crossed->places[n];
      if (page.split != nullptr && page.split->has(CrossedPage::point(place))) continue;
      if (view.is_visible(place, group.phase))
        known = std::max(known, class_at(of_error, view.depth(place, group.phase)));
    }
  }
  return known;
}

template <class Sample>
int ViewedPages<Sample>::split(const SurfaceCut& cut, const Check& check) {
  shown_.clear();
  int left = std::max(greatest_passed_, greatest_missing_);
  for (int lod = lods() - 1; lod >= 0; --lod) {
    const int most = cut.greatest_left(diamonds_.generation(lod));
    for (ViewedPage* const page : active_[static_cast<std::size_t>(lod)]) {
      check();
      set_split(*page, diamonds_.generation(lod), cut);
      if (page->masks->split.any()) {
        page->split = &page->masks->split;
        shown_.push_back(page);
      }
      if (left < most) left = left_on(*page, view_of(*page), left);
    }
  }
  return left;
}

template <class Sample>
void ViewedPages<Sample>::forget_old() {
  if (bytes_ > memory_) {
    std::vector<ViewedPage*> old;
    for (ViewedPage& page : pages_) {
      if (page.crossed != nullptr && page.used != frame_) old.push_back(&page);
    }
    std::ranges::stable_sort(old, {}, &ViewedPage::used);
    for (ViewedPage* const page : old) {
      if (bytes_ <= memory_) break;
      forget_crossed(*page);
    }
  }
  ++frame_;
}

template class ViewedPages<std::uint8_t>;
template class ViewedPages<std::uint16_t>;
template class ViewedPages<std::int16_t>;
template class ViewedPages<float>;

}  // namespace adamas::isosurface
