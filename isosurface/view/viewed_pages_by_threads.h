#pragma once

// Members of ViewedPages for what several threads do; viewed_pages.cpp alone includes this.

#include <algorithm>
#include <atomic>

#include "core/base/parallel.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

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
    if (page->lod >= diamonds_.grid().top() || !page->is_told) continue;
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
    // The walk gets what is missing, or does without.
    return;
  }
}

}  // namespace adamas::isosurface
