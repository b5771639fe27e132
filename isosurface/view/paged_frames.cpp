#include "isosurface/view/paged_frames.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "isosurface/extraction/page_contour.h"
#include "isosurface/extraction/triangle_budget.h"

namespace adamas {

namespace {

/// Ends the work when the frame's own predicate says so.
class StoppedByFrame final : public Progress {
 public:
  explicit StoppedByFrame(const FrameRequest& request) : request_(request) {}
  void report(std::string_view, double) override {}
  [[nodiscard]] bool cancelled() const override { return request_.stop && request_.stop(); }

 private:
  const FrameRequest& request_;
};

/// How many diamonds one mask has that another has not.
std::uint64_t more_in(const PageMask& one, const PageMask* other) {
  std::uint64_t sum = 0;
  for (std::size_t row = 0; row < one.rows.size(); ++row) {
    const unsigned others = other == nullptr ? 0u : other->rows[row];
    sum += static_cast<std::uint64_t>(std::popcount(static_cast<unsigned>(one.rows[row]) & ~others));
  }
  return sum;
}

}  // namespace

template <class Sample>
PagedFrames<Sample>::PagedFrames(StoredPages<OrderedWord<Sample>>& pages)
    : diamonds_(pages),
      split_pages_(diamonds_, limits_),
      masks_(static_cast<std::size_t>(split_pages_.lods())) {}

template <class Sample>
FrameFigures PagedFrames<Sample>::refine(const FrameRequest& request) {
  diamonds_.set_view(View(request.viewpoint));
  StoppedByFrame progress(request);
  try {
    if (isovalue_ != request.isovalue) {
      isovalue_.reset();
      diamonds_.set_contour_in_view(request.isovalue);
      surface_.isovalue = request.isovalue;
      merge_all();
      isovalue_ = request.isovalue;
    }
    if (request.max_triangles && figures_.triangles > *request.max_triangles) merge_all();
    const SurfaceCut cut = cut_of(request, progress);
    split_pages_.find(cut, [&](int, const auto&) { progress.check(); });
    Contour contour = contour_of_mesh(progress);
    // Nothing stops the frame from here on.
    contour_ = std::move(contour);
    figures_ = {};
    figures_.triangles = contour_.triangles.size();
    figures_.largest_error = diamonds_.most_pixels(split_pages_.greatest_left());
    count_changes(figures_);
    return figures_;
  } catch (const Cancelled&) {
    FrameFigures stopped = figures_;
    stopped.splits = stopped.merges = 0;
    stopped.stopped = true;
    return stopped;
  }
}

template <class Sample>
void PagedFrames<Sample>::merge_all() {
  contour_ = root_contour(diamonds_, surface_.isovalue,
                          surface_.contour_options(diamonds_.last_sample(), diamonds_.spacing()));
  figures_ = {};
  figures_.triangles = contour_.triangles.size();
  figures_.largest_error = std::numeric_limits<double>::infinity();
  masks_.assign(masks_.size(), {});
}

template <class Sample>
SurfaceCut PagedFrames<Sample>::cut_of(const FrameRequest& request, Progress& progress) {
  const int least_class = std::max(1, diamonds_.view_class(request.pixels));
  split_pages_.forget(request.max_triangles.has_value());
  if (!request.max_triangles) return {.error_class = least_class};
  TriangleBudget<Sample> budget(diamonds_, split_pages_, surface_);
  return budget.find(*request.max_triangles, least_class, diamonds_.root(), progress);
}

template <class Sample>
Contour PagedFrames<Sample>::contour_of_mesh(Progress& progress) {
  const ContourOptions options = surface_.contour_options(diamonds_.last_sample(), diamonds_.spacing());
  if (split_pages_.count() == 0) return root_contour(diamonds_, surface_.isovalue, options);
  ContourBuilder builder(diamonds_.domain(), surface_.isovalue, options);
  builder.expect(split_pages_.count() * 3 / 2);
  PageContour<Sample> contour(diamonds_, split_pages_, limits_, builder);
  split_pages_.for_each_page([&](int lod, const auto& page, double) {
    progress.check();
    contour.add(lod, page);
  });
  return builder.finish();
}

template <class Sample>
void PagedFrames<Sample>::count_changes(FrameFigures& figures) {
  for (int lod = 0; lod < split_pages_.lods(); ++lod) {
    LatticeMap<PageMask>& before = masks_[static_cast<std::size_t>(lod)];
    LatticeMap<PageMask> now;
    for (const auto& page : split_pages_.pages(lod)) {
      if (page.split == nullptr) continue;
      const PageMask* const old = before.find(page.block);
      figures.splits += more_in(*page.split, old);
      if (old != nullptr) figures.merges += more_in(*old, page.split);
      *now.insert(page.block).first = *page.split;
    }
    before.for_each([&](LatticePoint block, const PageMask& mask) {
      if (now.find(block) == nullptr) figures.merges += more_in(mask, nullptr);
    });
    before = std::move(now);
  }
}

template class PagedFrames<std::uint8_t>;
template class PagedFrames<std::uint16_t>;
template class PagedFrames<std::int16_t>;
template class PagedFrames<float>;

}  // namespace adamas
