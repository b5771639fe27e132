#include "isosurface/view/viewed_pages.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Pages that no cube of the grid has stand for the coarser ones that have their only point.
PageId page_with_points(const PageGrid& grid, PageId id) {
  while (!grid.contains(id)) id = {id.lod + 1, {id.block.i / 2, id.block.j / 2, id.block.k / 2}};
  return id;
}

}  // namespace

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
      walk_(diamonds.grid(), diamonds.lods()),
      incomplete_(static_cast<std::size_t>(diamonds.lods())) {
  for (int lod = 0; lod < diamonds.lods(); ++lod)
    places_.emplace_back(diamonds.domain(), diamonds.lattice_step(lod), diamonds.grid().reach(lod));
}

template <class Sample>
void ViewedPages<Sample>::clear() {
  shown_.clear();
  for (auto& of_lod : incomplete_) of_lod.clear();
  walk_.clear();
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
typename ViewedPages<Sample>::PageAndPlace ViewedPages<Sample>::find(LatticePoint p) {
  const auto [lod, block, on_page] = diamonds_.place(p);
  return {find(lod, block), on_page};
}

template <class Sample>
std::optional<typename ViewedPages<Sample>::Added> ViewedPages<Sample>::walk(int least_class,
                                                                             std::uint64_t room,
                                                                             const Check& check) {
  walk_.begin();
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
    find_in_sight(lod, check);
    read_ahead_of_walk();
    incomplete_[static_cast<std::size_t>(lod)].clear();
    for (const auto& [page, view] : in_sight_) {
      if (!loads_ && !find_in_memory(*page, view)) continue;
      look_at(*page, view, added);
      walk_.active(lod).push_back(page);
      if (loads_ && added.above.added > room) return {};
    }
    if (loads_) continue;
    drop_without_parents(lod, added);
    if (added.above.added > room) return {};
  }
  return added;
}

template <class Sample>
void ViewedPages<Sample>::find_in_sight(int lod, const Check& check) {
  const auto meet = [this](ViewedPage& page) {
    if (page.step != diamonds_.pages().step()) renew(page);
    page.at_low = page.lost_at_low = {};
    return true;
  };
  in_sight_.clear();
  for (ViewedPage* const page : walk_.candidates(lod, meet)) {
    check();
    if (!page->knows_greatest && !find_greatest(*page)) page->greatest = greatest_of_parents(*page);
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
  page.looked_at = walk_.number();
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
  for (const ViewedPage* const page : walk_.active(lods() - 1 - found.cut.generation / 3)) {
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
int ViewedPages<Sample>::greatest_left_on(const ViewedPage& page, const PageView& view, int known) const {
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
    for (ViewedPage* const page : walk_.active(lod)) {
      check();
      set_split(*page, diamonds_.generation(lod), cut);
      if (page->masks->split.any()) {
        page->split = &page->masks->split;
        shown_.push_back(page);
      }
      if (left < most) left = greatest_left_on(*page, view_of(*page), left);
    }
  }
  return left;
}

template <class Sample>
void ViewedPages<Sample>::forget_old() {
  if (bytes_ > memory_) {
    std::vector<ViewedPage*> old;
    for (ViewedPage& page : walk_.pages()) {
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

// The following members work in several threads.

template <class Sample>
template <class Work>
void ViewedPages<Sample>::with_readers(std::size_t count, std::size_t grain, Work&& work) {
  auto& pages = diamonds_.pages();
  pages.set_loading(false);
  parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<CrossedPageReader<Sample>> reader = readers_.take();
    if (reader == nullptr) reader = std::make_unique<CrossedPageReader<Sample>>(diamonds_, surface_);
    work(begin, end, *reader);
    readers_.give(std::move(reader));
  });
  pages.set_loading(loads_);
}

template <class Sample>
void ViewedPages<Sample>::read_ahead_of_walk() {
  constexpr std::size_t kLeast = 8, kGrain = 2;
  if (thread_limit() < 2 || in_sight_.size() < kLeast) return;
  auto& pages = diamonds_.pages();
  std::vector<const InSight*> unread;
  for (const InSight& each : in_sight_) {
    const auto& [page, view] = each;
    // The coarsest page is one page of several LODs.
    if (page->lod >= diamonds_.grid().top() || !page->knows_greatest) continue;
    const CrossedPage* const known = page->crossed.get();
    const bool is_read =
        known != nullptr ? !counts_ || known->counted >= groups_within(*known, page->lod, view.least_depth(0))
                         : !pages.has({page->lod, page->block}, PageParts::kAll);
    if (!is_read) unread.push_back(&each);
  }
  if (unread.size() < kLeast) return;
  const auto bytes = [](const InSight* each) {
    return each->page->crossed == nullptr ? 0 : bytes_of(*each->page);
  };
  for (const InSight* const each : unread) bytes_ -= bytes(each);
  with_readers(unread.size(), kGrain, [&](std::size_t begin, std::size_t end, auto& reader) {
    for (std::size_t n = begin; n < end; ++n) read_from_memory(*unread[n]->page, unread[n]->view, reader);
  });
  for (const InSight* const each : unread) bytes_ += bytes(each);
  for (const InSight* const each : unread) reader_.drop_bounds(each->page->lod, each->page->block);
}

template <class Sample>
bool ViewedPages<Sample>::count_by_threads(ViewedPage& page, std::size_t groups) {
  // The border of the data cuts most diamonds of the coarsest page, and these take long.
  constexpr std::size_t kLeast = 64, kGrain = 16;
  const std::span<const std::uint16_t> places = page.crossed->uncounted(groups);
  if (thread_limit() < 2 || places.size() < kLeast) return false;
  std::vector<std::int16_t> changes(places.size());
  std::atomic<bool> is_lost = false;
  with_readers(places.size(), kGrain, [&](std::size_t begin, std::size_t end, auto& reader) {
    try {
      reader.find_changes(page.lod, page.block, places.subspan(begin, end - begin),
                          std::span(changes).subspan(begin, end - begin));
    } catch (const PageLost&) {
      is_lost = true;
    }
  });
  if (!is_lost) page.crossed->set_counted(groups, changes);
  return !is_lost;
}

template <class Sample>
void ViewedPages<Sample>::read_from_memory(ViewedPage& page, const PageView& view,
                                           CrossedPageReader<Sample>& reader) {
  try {
    if (page.crossed == nullptr) {
      const auto& bounds = diamonds_.pages().needed_bounds({page.lod, page.block});
      set_crossed(page, reader.read(page.lod, page.block, bounds));
      page.groups_in_memory = 0;
    }
    if (!counts_) return;
    const std::size_t groups = groups_within(*page.crossed, page.lod, view.least_depth(0));
    reader.count(page.lod, page.block, groups, *page.crossed);
  } catch (const PageLost&) {
    // The walk itself gets what is missing, or does without it.
    return;
  }
}

// The following members are for walks that load no pages.

template <class Sample>
bool ViewedPages<Sample>::find_greatest(ViewedPage& page) {
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
  page.knows_greatest = true;
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
    if (parent == nullptr || parent->looked_at != walk_.number() || parent->crossed->groups.empty()) continue;
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
  // The members of the groups before this one are in memory.
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
    if (!page.knows_greatest || !pages.has(id, PageParts::kAll)) {
      const double depth = view.least_depth(0);
      note_missing(id, page.knows_greatest ? MissingPage::Part::kAll : MissingPage::Part::kDirectory,
                   class_at(page.greatest, depth), depth);
      note_incomplete();
      return false;
    }
    read(page);
    page.groups_in_memory = 0;
  }
  page.used = frame_;
  page.groups_wanted = groups_within(*page.crossed, page.lod, view.least_depth(0));
  if (page.groups_in_memory < page.groups_wanted || page.left_then != pages.evicted_pages()) {
    page.groups_in_memory = groups_in_memory(page);
    page.left_then = pages.evicted_pages();
  }
  if (page.groups_in_memory >= page.groups_wanted) return true;
  note_missing_groups(page, view);
  note_incomplete();
  return true;
}

/// Notes what is not in memory of the members of groups, up to the last group that has a diamond of the
/// walk's classes in sight.
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
    if (near != nullptr) near->suspect = walk_.number();
  }
}

template <class Sample>
void ViewedPages<Sample>::suspect_children(const ViewedPage& page) {
  const bool is_finer = page.lod <= diamonds_.grid().top();
  for (std::int32_t n = 0; n < 64; ++n) {
    const LatticePoint step{n % 4 - 1, n / 4 % 4 - 1, n / 16 - 1};
    ViewedPage* const near = find(page.lod - 1, (is_finer ? 2 : 1) * page.block + step);
    if (near != nullptr) near->suspect = walk_.number();
  }
}

template <class Sample>
bool ViewedPages<Sample>::has_parents(LatticePoint p) {
  const auto parents = Diamond(p).parents(diamonds_.domain());
  return std::ranges::all_of(parents, [&](LatticePoint parent) {
    if (!diamonds_.is_stored(parent)) return true;
    const auto [page, q] = find(parent);
    if (page == nullptr || page->looked_at != walk_.number()) return false;
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
    for (ViewedPage* const page : walk_.active(lod)) {
      if (page->suspect == walk_.number() && drop_without_parents(*page, phase, added))
        changed.push_back(page);
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
  for (int lod = 0; lod < lods(); ++lod) {
    for (const ViewedPage* const page : walk_.active(lod)) {
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

// The following members carry over what is known to other steps.

template <class Sample>
void ViewedPages<Sample>::renew(ViewedPage& page) {
  const std::uint32_t step = diamonds_.pages().step();
  if (is_unchanged(page)) {
    if (page.chunk_step == page.step) page.chunk_step = step;
    page.step = step;
    return;
  }
  if (page.crossed != nullptr) forget_crossed(page);
  page.knows_greatest = false;
  page.step = step;
}

template <class Sample>
bool ViewedPages<Sample>::is_unchanged(const ViewedPage& page) {
  StoredPages<typename ViewedDiamonds<Sample>::Word>& pages = diamonds_.pages();
  if (before_ == nullptr || page.step != before_->step() || page.crossed == nullptr) return false;
  const PageGrid& grid = diamonds_.grid();
  // Gradients near the border may be of samples of finer LODs, where the data are not large; and those that
  // the store keeps are not looked at.
  constexpr std::int32_t kReach = 4;
  const LatticePoint last = grid.last();
  if (page.lod > grid.top() || std::min({last.i, last.j, last.k}) < kReach << page.lod) return false;
  if (pages.file().header().gradients) return false;
  PageComparison comparison(*before_, pages);
  const PageId id{page.lod, page.block};
  if (loads_) pages.bounds(id);
  if (!comparison.has_same_samples(id) || !comparison.has_same_bounds(id)) return false;
  const LatticePoint blocks = grid.blocks(page.lod);
  for (std::int32_t n = 0; n < 27; ++n) {
    const LatticePoint block = page.block + step_around(n);
    if (is_below(block, blocks) && !comparison.has_same_samples({page.lod, block})) return false;
  }
  return true;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(ViewedPages);

}  // namespace adamas::isosurface
