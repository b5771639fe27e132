#include "isosurface/extraction/split_pages.h"

#include <vector>

#include "core/base/parallel.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

template <class Sample>
std::size_t SplitPages<Sample>::count() const {
  std::size_t sum = 0;
  for_each_page([&](const SplitPage& page) { sum += page.split->count(); });
  return sum;
}

template <class Sample>
int SplitPages<Sample>::class_if_allowed(LatticePoint p) {
  if (!diamonds_.is_stored(p)) return 0;
  if (limits_.any() && !limits_.allow(diamonds_.in_samples(p), diamonds_.lod(p), Diamond(p).phase()))
    return 0;
  return diamonds_.class_if_crossed(p);
}

template <class Sample>
bool SplitPages<Sample>::is_lost(LatticePoint p) const {
  const int lod = diamonds_.lod(p);
  return !limits_.lost.empty() && lod >= 0 &&
         limits_.lost.blocks(diamonds_.in_samples(p), lod, Diamond(p).phase());
}

template <class Sample>
void SplitPages<Sample>::find(const SurfaceCut& cut, std::span<Reader* const> readers, Progress& progress) {
  walk_.begin();
  greatest_left_ = 0;
  for (int lod = lods() - 1; lod >= 0; --lod) {
    const std::vector<SplitPage*>& pages = candidates(lod);
    // Each thread has about the same part of the volume at all LODs, as finer pages are predicted from
    // coarser ones.
    constexpr std::size_t kLeastPages = 16;
    const std::size_t threads = std::clamp<std::size_t>(pages.size() / kLeastPages, 1, readers.size());
    std::vector<int> left(threads);
    parallel_for(threads, 1, [&](std::size_t t) {
      for (std::size_t n = pages.size() * t / threads; n < pages.size() * (t + 1) / threads; ++n) {
        if (t == 0) progress.step("reading", 1 - (lod + 1.0) / lods());
        left[t] = std::max(left[t], look_at(*pages[n], cut, *readers[t]));
      }
    });
    greatest_left_ = std::max(greatest_left_, *std::ranges::max_element(left));
    for (SplitPage* const page : pages) {
      if (page->split != nullptr) walk_.active(lod).push_back(page);
    }
  }
}

template <class Sample>
int SplitPages<Sample>::look_at(SplitPage& page, const SurfaceCut& cut, Reader& reader) const {
  StoredDiamonds<Sample>& diamonds = reader.diamonds();
  const PageId id{page.lod, page.block};
  const CutOfPage on_page(cut, page.lod, generation(page.lod), page.order);
  page.groups = 0;
  if (page.lod < diamonds.grid().top()) {
    const int greatest = diamonds.greatest_class(id);
    if (greatest < static_cast<int>(on_page.least()) + 4 * page.lod) return greatest;
  }
  if (page.crossed == nullptr) {
    page.crossed =
        std::make_unique<CrossedPage>(reader.read(page.lod, page.block, several_cuts_ ? 1 : on_page.least()));
    // The bounds of the finest LOD predict no others.
    if (page.lod == 0) diamonds.pages().drop_bounds(id);
  }
  const CrossedPage& known = *page.crossed;
  PageMask split;
  int left = 0;
  for (const CrossedPage::Group& group : known.groups) {
    const std::size_t end = on_page.end(group.code, group.phase);
    std::size_t n = group.begin;
    for (; n < group.end && known.places[n] < end; ++n) split.add(known.places[n]);
    if (n == group.end) {
      page.children |= group.children;
    } else {
      left = std::max(left, error_class(group.code, page.lod));
      for (std::size_t m = group.begin; m < n && group.children != 0; ++m)
        page.children |= reader.children(page.lod, page.block, CrossedPage::point(known.places[m]));
    }
    if (n == group.begin) break;
    ++page.groups;
  }
  if (page.groups > 0) {
    if (page.mask == nullptr) page.mask = std::make_unique<PageMask>();
    *page.mask = split;
    page.split = page.mask.get();
  }
  if (!several_cuts_) page.crossed.reset();
  return left;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(SplitPages);

}  // namespace adamas::isosurface
