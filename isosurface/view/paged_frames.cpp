#include "isosurface/view/paged_frames.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "isosurface/extraction/page_mesh.h"
#include "isosurface/extraction/triangle_counter.h"
#include "isosurface/view/mesh_cells.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

/// Stops the work when the frame's own predicate says so.
class StoppedByFrame final : public Progress {
 public:
  explicit StoppedByFrame(const FrameRequest& request) : request_(request) {}
  void report(std::string_view, double) override {}
  [[nodiscard]] bool cancelled() const override { return request_.stop && request_.stop(); }

 private:
  const FrameRequest& request_;
};

std::array<std::uint32_t, 3> renumbered(const std::array<std::uint32_t, 3>& triangle,
                                        const std::vector<std::uint32_t>& numbers) {
  return {numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]};
}

}  // namespace

template <class Sample>
PagedFrames<Sample>::PagedFrames(StoredPages<OrderedWord<Sample>>& pages, std::size_t memory,
                                 SurfaceForm form, StoredGradients* gradients)
    : form_(form),
      diamonds_(pages),
      pages_(diamonds_, surface_, memory),
      makers_({diamonds_, surface_,
               [this](int lod, LatticePoint block) { return pages_.split_of(lod, block); }, form},
              gradients) {}

template <class Sample>
std::uint64_t PagedFrames<Sample>::id_of(int lod, LatticePoint block) {
  return std::uint64_t{static_cast<unsigned>(lod)} << kLodBits | ZOrder::interleave(block);
}

template <class Sample>
void PagedFrames<Sample>::set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients) {
  if (&pages == &diamonds_.pages()) return;
  pages_.set_before(&diamonds_.pages());
  diamonds_.set_pages(pages);
  makers_.set_pages(pages, gradients);
  is_of_another_step_ = true;
}

template <class Sample>
FrameFigures PagedFrames<Sample>::refine(const FrameRequest& request) {
  changes_ = {};
  diamonds_.set_view(View(request.viewpoint, request.depths));
  const StoppedByFrame progress(request);
  FrameFigures figures;
  try {
    choose_pages(request.resident_only);
    figures = find_frame(request, progress);
  } catch (const Cancelled&) {
    const bool is_too_much = request.max_triangles && figures_.triangles > *request.max_triangles;
    if (is_too_much || is_of_another_isovalue_) merge_all();
    figures = figures_;
    figures.splits = figures.merges = 0;
    figures.stopped = true;
  } catch (...) {
    end_frame();
    isovalue_.reset();
    throw;
  }
  end_frame();
  pages_.forget_old();
  find_changes();
  return figures;
}

template <class Sample>
void PagedFrames<Sample>::end_frame() {
  diamonds_.pages().set_loading(true);
  // The pages of the step before may go from now on.
  pages_.set_before(nullptr);
}

template <class Sample>
FrameFigures PagedFrames<Sample>::find_frame(const FrameRequest& request, const Progress& progress) {
  FrameFigures figures;
  if (isovalue_ != request.isovalue) {
    start(request.isovalue);
  } else if (is_of_another_step_) {
    count_root();
  }
  const SurfaceCut cut = cut_of(request, progress);
  last_class_ = cut.error_class;
  figures.largest_error = diamonds_.most_pixels(pages_.split(cut, [&] { progress.check(); }));
  figures.depth_tests = pages_.depth_tests();
  figures.hidden = pages_.hidden();
  find_changed_cells(figures);
  std::vector<NewChunk> made = make_chunks(progress);
  // Nothing stops the frame from here on.
  take(std::move(made));
  for_each_chunk([&](const SurfaceChunk& chunk) { figures.triangles += chunk.triangles.size(); });
  find_missing(figures);
  figures_ = figures;
  return figures;
}

template <class Sample>
void PagedFrames<Sample>::choose_pages(bool resident_only) {
  StoredPages<OrderedWord<Sample>>& pages = diamonds_.pages();
  const PageId coarsest{pages.grid().top(), {0, 0, 0}};
  pages.needed_bounds(coarsest);
  pages.set_loading(!resident_only);
  pages_.set_loading(!resident_only);
}

template <class Sample>
bool PagedFrames<Sample>::have_arrived(const std::vector<MissingNormals>& missing) {
  StoredPages<OrderedWord<Sample>>& pages = diamonds_.pages();
  return std::ranges::any_of(missing, [&](const MissingNormals& normals) {
    return pages.loads() || (normals.is_of_gradients ? gradients()->has(normals.page, PageParts::kSamples)
                                                     : pages.has(normals.page, PageParts::kSamples));
  });
}

template <class Sample>
void PagedFrames<Sample>::add_missing(const std::vector<MissingNormals>& missing) {
  using Part = MissingPage::Part;
  for (const MissingNormals& normals : missing) {
    const bool is_lost = normals.is_of_gradients ? gradients()->is_lost(normals.page)
                                                 : diamonds_.pages().is_lost(normals.page);
    if (is_lost) continue;
    const Part part = normals.is_of_gradients ? Part::kGradients : Part::kSamples;
    missing_.push_back({normals.page, part, 0, 0, diamonds_.pages().step()});
  }
}

template <class Sample>
void PagedFrames<Sample>::find_missing(FrameFigures& figures) {
  missing_ = pages_.missing();
  for (const ViewedPage* const page : chunks_) add_missing(page->chunk->missing);
  if (separate_chunk_) add_missing(separate_chunk_->missing);
  sort_by_importance(diamonds_.grid(), missing_);
  figures.pages_missing = missing_.size();
  figures.pages_lost = pages_.lost();
  if (!missing_.empty()) pages_.spare_needed();
}

template <class Sample>
std::vector<MissingPage> PagedFrames<Sample>::needed_pages() {
  std::vector<MissingPage> pages = pages_.needed();
  sort_by_importance(diamonds_.grid(), pages);
  return pages;
}

template <class Sample>
void PagedFrames<Sample>::start(double isovalue) {
  const bool is_first = !isovalue_.has_value();
  const std::uint64_t least_above = diamonds_.least_above();
  isovalue_.reset();
  diamonds_.set_contour(isovalue);
  surface_.isovalue = isovalue;
  if (!is_first && diamonds_.least_above() == least_above) {
    // The same samples are on the same sides: points move along edges, and nothing else changes.
    is_of_another_isovalue_ = true;
    for (ViewedPage* const page : chunks_) {
      const bool stays = form_ == SurfaceForm::kEdgeEnds && page->chunk->border.triangles.empty();
      if (!stays) page->chunk_step = ViewedPage::kNoStep;
    }
    pages_.forget_counts();
  } else {
    merge_all();
    pages_.clear();
    last_class_ = 0;
    is_of_another_step_ = false;
  }
  count_root();
  isovalue_ = isovalue;
}

template <class Sample>
void PagedFrames<Sample>::count_root() {
  root_triangles_ =
      static_cast<std::uint64_t>(TriangleCounter<Sample>(diamonds_, surface_).triangles(diamonds_.root()));
}

template <class Sample>
void PagedFrames<Sample>::merge_all() {
  for (ViewedPage* const page : chunks_) {
    touch(page->chunk->shown.id, true);
    page->chunk.reset();
  }
  chunks_.clear();
  missing_.clear();
  set_apart(kRoot, root_contour(diamonds_, surface_.isovalue, contour_options()));
  figures_ = {};
  figures_.triangles = separate_chunk_ ? separate_chunk_->shown.triangles.size() : 0;
  figures_.largest_error = std::numeric_limits<double>::infinity();
  is_of_another_isovalue_ = false;
}

template <class Sample>
SurfaceCut PagedFrames<Sample>::cut_of(const FrameRequest& request, const Progress& progress) {
  constexpr int kNothing = ViewedDiamonds<Sample>::kClasses;
  const auto check = [&] { progress.check(); };
  const int least = std::max(1, diamonds_.view_class(request.pixels));
  const std::uint64_t most = request.max_triangles.value_or(std::numeric_limits<std::uint64_t>::max());
  if (!request.max_triangles || root_triangles_ > most) {
    const int of_all = request.max_triangles ? kNothing : least;
    pages_.walk(of_all, ViewedPages<Sample>::kAnyNumber, check);
    return {.error_class = of_all};
  }
  constexpr int kFirst = 7;
  int low = last_class_ > 0 ? last_class_
                            : diamonds_.view_class(diamonds_.pixels(diamonds_.root().point())) - kFirst;
  // There is room for diamonds of classes from `fits` on, and no room for those from `fails` on.
  const std::uint64_t all_room = most - root_triangles_;
  std::uint64_t room = all_room;
  int fits = kNothing, fails = least - 1;
  for (int up = 1;;) {
    low = std::clamp(low, std::max(least, fails), fits - 1);
    const auto added = pages_.walk(low, room, check);
    if (!added) {
      fails = low + 1;
      low += std::exchange(up, 2 * up);
      continue;
    }
    // Splits that remove triangles make room for others.
    while (added->all().added > room) {
      const auto found = pages_.cut_within(low, *added, room);
      if (all_room + found.sum.lost <= room) return found.cut;
      room = all_room + found.sum.lost;
      fails = least - 1;
    }
    if (low == least) return {.error_class = least};
    fits = low;
    low -=
        classes_further(static_cast<double>(root_triangles_ + added->all().added), static_cast<double>(most));
  }
}

template <class Sample>
void PagedFrames<Sample>::find_changed_cells(FrameFigures& figures) {
  // Chunks of another step are made anew in any case.
  const std::uint32_t step = diamonds_.pages().step();
  const bool keeps_some =
      std::ranges::any_of(chunks_, [step](const ViewedPage* page) { return page->chunk_step == step; });
  for (ViewedPage* const page : pages_.shown()) note_changes(*page, *page->split, keeps_some, figures);
  for (ViewedPage* const page : chunks_) {
    if (pages_.split_of(page->lod, page->block) == nullptr) note_changes(*page, {}, keeps_some, figures);
  }
}

template <class Sample>
void PagedFrames<Sample>::note_changes(ViewedPage& page, const PageMask& now, bool of_cells,
                                       FrameFigures& figures) {
  const PageMask* const before = page.chunk == nullptr ? nullptr : &page.chunk->split;
  if (before != nullptr && *before == now) return;
  for (std::int32_t row = 0; row < kSide * kSide; ++row) {
    const auto r = static_cast<std::size_t>(row);
    const unsigned old = before == nullptr ? 0u : before->rows[r], split = now.rows[r] & ~old,
                   merged = old & ~unsigned{now.rows[r]};
    if ((split | merged) == 0) continue;
    figures.splits += static_cast<std::uint64_t>(std::popcount(split));
    figures.merges += static_cast<std::uint64_t>(std::popcount(merged));
    if (!of_cells) continue;
    for (unsigned bits = split | merged; bits != 0; bits &= bits - 1) {
      const LatticePoint q{std::countr_zero(bits), row % kSide, row / kSide};
      const Diamond diamond(diamonds_.lattice_step(page.lod) * (kSide * page.block + q));
      note_cell(diamond.point());
      // Its tetrahedra are halves of those of its parents.
      for (int n = 0; n < diamond.parent_count(); ++n) note_cell(diamond.parent(n));
    }
  }
}

template <class Sample>
void PagedFrames<Sample>::note_cell(LatticePoint p) {
  const int lod = diamonds_.lod(p);
  if (lod >= diamonds_.lods() || !diamonds_.domain().contains(p)) return;
  const auto [page, q] = pages_.find(p);
  if (page == nullptr) return;
  if (std::exchange(page->changed_in, pages_.walk_number()) != pages_.walk_number()) page->changed = 0;
  page->changed |= std::uint64_t{1} << PageChunk::cell(q);
}

template <class Sample>
std::vector<typename PagedFrames<Sample>::NewChunk> PagedFrames<Sample>::make_chunks(
    const Progress& progress) {
  std::vector<NewChunk> made;
  for (ViewedPage* const page : pages_.shown()) {
    // Provisional normals are computed anew, all together.
    const bool is_provisional = page->chunk != nullptr && !page->chunk->missing.empty();
    const bool is_of_step = page->chunk_step == page->step;
    if (page->chunk != nullptr && is_of_step && page->changed_in != pages_.walk_number() &&
        !(is_provisional && have_arrived(page->chunk->missing)))
      continue;
    made.push_back({page, is_provisional || !is_of_step ? nullptr : page->chunk.get()});
  }
  makers_.make(made, progress);
  return made;
}

template <class Sample>
void PagedFrames<Sample>::take(std::vector<NewChunk> made) {
  ++revision_;
  const bool is_separate_old = is_of_another_step_ || is_of_another_isovalue_ ||
                               (separate_chunk_ && have_arrived(separate_chunk_->missing));
  bool border_changed = is_separate_old || (separate_chunk_ && separate_chunk_->shown.id == kRoot);
  const auto note_border = [&](const PageChunk& chunk) {
    border_changed = border_changed || !chunk.border.triangles.empty();
  };
  for (ViewedPage* const page : chunks_) {
    if (pages_.split_of(page->lod, page->block) != nullptr) continue;
    note_border(*page->chunk);
    touch(page->chunk->shown.id, true);
    makers_.recycle(std::move(page->chunk));
  }
  for (NewChunk& next : made) {
    next.chunk->shown.id = id_of(next.page->lod, next.page->block);
    note_border(*next.chunk);
    if (next.page->chunk != nullptr) note_border(*next.page->chunk);
    touch(next.chunk->shown.id, next.page->chunk != nullptr);
    next.chunk->shown.revision = revision_;
    next.page->chunk_step = next.page->step;
    makers_.recycle(std::exchange(next.page->chunk, std::move(next.chunk)));
  }
  chunks_ = pages_.shown();
  if (chunks_.empty()) {
    if (is_separate_old || !separate_chunk_ || separate_chunk_->shown.id != kRoot)
      set_apart(kRoot, root_contour(diamonds_, surface_.isovalue, contour_options()));
  } else if (border_changed) {
    set_apart(kBorder, border());
  }
  is_of_another_step_ = is_of_another_isovalue_ = false;
}

template <class Sample>
void PagedFrames<Sample>::drop_apart() {
  if (separate_chunk_) touch(separate_chunk_->shown.id, true);
  separate_chunk_.reset();
}

template <class Sample>
void PagedFrames<Sample>::set_apart(std::uint64_t id, Contour contour) {
  const bool was_there = separate_chunk_ && separate_chunk_->shown.id == id;
  if (!was_there) drop_apart();
  if (contour.triangles.empty()) return drop_apart();
  touch(id, was_there);
  SeparateChunk& chunk = separate_chunk_.emplace();
  SurfaceChunk& shown = chunk.shown;
  shown.id = id;
  shown.revision = ++revision_;
  shown.points = contour.points;
  shown.triangles = contour.triangles;
  shown.normals.reserve(contour.points.size());
  PointNormals<Sample>& normals = makers_.first().normals();
  for (const EdgePoint& point : contour.edge_points) shown.normals.push_back(normals.normal(point));
  for (const MeanPoint& point : contour.mean_points) shown.normals.push_back(normals.normal(point));
  chunk.missing = normals.take_missing();
  chunk.contour = std::move(contour);
}

template <class Sample>
void PagedFrames<Sample>::find_changes() {
  changes_ = {};
  // The first entry of a chunk says whether it was there before.
  std::ranges::stable_sort(touched_, {}, [](const auto& touched) { return touched.first; });
  for (std::size_t n = 0; n < touched_.size(); ++n) {
    const auto [id, was_there] = touched_[n];
    if (n > 0 && touched_[n - 1].first == id) continue;
    const bool is_there = chunk(id) != nullptr;
    if (was_there && is_there) changes_.changed.push_back(id);
    if (was_there && !is_there) changes_.removed.push_back(id);
    if (!was_there && is_there) changes_.added.push_back(id);
  }
  touched_.clear();
}

// The functions below answer questions about the last frame.

template <class Sample>
const SurfaceChunk* PagedFrames<Sample>::chunk(std::uint64_t id) {
  if (separate_chunk_ && separate_chunk_->shown.id == id) return &separate_chunk_->shown;
  if (id == kRoot || id == kBorder) return nullptr;
  const ViewedPage* const page = pages_.find(static_cast<int>(id >> kLodBits),
                                             ZOrder::deinterleave(id & ((std::uint64_t{1} << kLodBits) - 1)));
  return page == nullptr || page->chunk == nullptr ? nullptr : &page->chunk->shown;
}

template <class Sample>
bool PagedFrames<Sample>::is_split(LatticePoint p) {
  const int lod = diamonds_.lod(p);
  if (lod < 0 || lod >= diamonds_.lods()) return false;
  const auto [page, q] = pages_.find(p);
  return page != nullptr && page->chunk != nullptr && page->chunk->split.has(q);
}

template <class Sample>
std::vector<std::vector<Vec3>> PagedFrames<Sample>::cells_in(const Plane& plane) {
  if (!isovalue_) return {};
  return isosurface::cells_in(diamonds_.root(), diamonds_.domain(), plane, diamonds_.data_box(),
                              [this](LatticePoint p) { return is_split(p); });
}

template <class Sample>
std::optional<double> PagedFrames<Sample>::error_at(const Vec3& place) {
  if (!isovalue_) return std::nullopt;
  const LatticePoint p =
      diamond_at(diamonds_.root(), diamonds_.domain(), place, [this](LatticePoint q) { return is_split(q); });
  try {
    return diamonds_.is_stored(p) ? diamonds_.error(diamonds_.class_if_crossed(p)) : 0;
  } catch (const PageLost&) {
    return std::nullopt;
  }
}

template <class Sample>
Contour PagedFrames<Sample>::border() const {
  ContourBuilder builder(diamonds_.domain(), surface_.isovalue, contour_options());
  // The triangles identify edges by their places.
  std::vector<std::uint32_t> numbers(std::size_t{DiamondStencil::kEdgePlaces});
  for (const ViewedPage* const page : chunks_) {
    const PageChunk& chunk = *page->chunk;
    for (std::size_t n = 0; n < chunk.border.edges.size(); ++n) {
      const EdgePoint point = makers_.first().edge_point(chunk, chunk.border, n);
      numbers[chunk.border.edges[n]] = builder.edge_point(point, makers_.first().position(point));
    }
    for (const auto& places : chunk.border.triangles)
      builder.add_triangle({numbers[places[0]], numbers[places[1]], numbers[places[2]]});
  }
  return builder.finish();
}

template <class Sample>
Contour PagedFrames<Sample>::contour() const {
  // The border of the data cuts none of these triangles any more.
  ContourBuilder builder(diamonds_.domain(), surface_.isovalue, {});
  std::vector<std::uint32_t> numbers;
  for (const ViewedPage* const page : chunks_) {
    const PageChunk& chunk = *page->chunk;
    numbers.clear();
    for (std::size_t n = 0; n < chunk.inside.edges.size(); ++n) {
      const EdgePoint point = makers_.first().edge_point(chunk, chunk.inside, n);
      numbers.push_back(builder.edge_point(point, makers_.first().position(point)));
    }
    for (const auto& triangle : chunk.shown.triangles) builder.add_triangle(renumbered(triangle, numbers));
  }
  if (!separate_chunk_) return builder.finish();
  const Contour& separate = separate_chunk_->contour;
  numbers.clear();
  for (std::size_t n = 0; n < separate.edge_points.size(); ++n)
    numbers.push_back(builder.edge_point(separate.edge_points[n], separate.points[n]));
  Contour contour = builder.finish();
  for (std::size_t n = separate.edge_points.size(); n < separate.points.size(); ++n) {
    numbers.push_back(static_cast<std::uint32_t>(contour.points.size()));
    contour.points.push_back(separate.points[n]);
  }
  contour.mean_points = separate.mean_points;
  for (const auto& triangle : separate.triangles) contour.triangles.push_back(renumbered(triangle, numbers));
  return contour;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(PagedFrames);

}  // namespace adamas::isosurface
