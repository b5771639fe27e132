#pragma once

// Members of ViewedPages for what several threads do; viewed_pages.cpp alone includes this.

#include <algorithm>

#include "core/base/parallel.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas {

template <class Sample>
void ViewedPages<Sample>::read_ahead_of_walk() {
  constexpr std::size_t kLeast = 8, kGrain = 2;
  if (thread_limit() < 2 || candidates_.size() < kLeast) return;
  auto& pages = diamonds_.pages();
  std::vector<ViewedPage*> unread;
  for (ViewedPage* const page : candidates_) {
    // The coarsest page is one page of several LODs.
    if (page->lod >= diamonds_.grid().top() || (!page->is_told && !tell(*page)) || page->greatest == 0)
      continue;
    const PageView view = view_of(*page);
    if (view.is_hidden() || low_[static_cast<std::size_t>(page->greatest)] < view.least_depth(0)) continue;
    const bool is_known = page->crossed != nullptr;
    if (is_known ? counts_ &&
                       page->crossed->counted < groups_within(*page->crossed, page->lod, view.least_depth(0))
                 : pages.has({page->lod, page->block}, PageParts::kAll))
      unread.push_back(page);
  }
  if (unread.size() < kLeast) return;
  pages.set_loading(false);
  for (const ViewedPage* const page : unread) bytes_ -= page->crossed == nullptr ? 0 : bytes_of(*page);
  parallel_chunks(unread.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    CrossedPageReader<Sample>& reader = taken_reader();
    for (std::size_t n = begin; n < end; ++n) read_from_memory(*unread[n], reader);
    const std::lock_guard lock(readers_mutex_);
    unused_readers_.push_back(&reader);
  });
  for (const ViewedPage* const page : unread) bytes_ += page->crossed == nullptr ? 0 : bytes_of(*page);
  pages.set_loading(loads_);
  for (const ViewedPage* const page : unread) reader_.drop_bounds(page->lod, page->block);
}

template <class Sample>
void ViewedPages<Sample>::read_from_memory(ViewedPage& page, CrossedPageReader<Sample>& reader) {
  try {
    if (page.crossed == nullptr) {
      const auto& bounds = diamonds_.pages().needed_bounds({page.lod, page.block});
      page.crossed = std::make_unique<CrossedPage>(reader.read(page.lod, page.block, bounds));
      page.masks = std::make_unique<ViewedMasks>();
      page.groups_in_memory = 0;
    }
    if (!counts_) return;
    const std::size_t groups = groups_within(*page.crossed, page.lod, view_of(page).least_depth(0));
    reader.count(page.lod, page.block, groups, *page.crossed);
  } catch (const PageLost&) {
    // The walk gets what is missing, or does without.
    return;
  }
}

template <class Sample>
CrossedPageReader<Sample>& ViewedPages<Sample>::taken_reader() {
  const std::lock_guard lock(readers_mutex_);
  if (unused_readers_.empty()) return readers_.emplace_back(diamonds_, surface_);
  CrossedPageReader<Sample>* const reader = unused_readers_.back();
  unused_readers_.pop_back();
  return *reader;
}

}  // namespace adamas
