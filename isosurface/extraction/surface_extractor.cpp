#include "isosurface/extraction/surface_extractor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/contour/decimate.h"
#include "isosurface/extraction/full_contour.h"
#include "isosurface/extraction/mesh_contour.h"
#include "isosurface/extraction/triangle_budget.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

template <class Sample>
SurfaceExtractor<Sample>::SurfaceExtractor(StoredPages<OrderedWord<Sample>>& pages)
    : pages_(pages), diamonds_(pages), split_pages_(diamonds_, request_, limits_) {}

template <class Sample>
std::array<double, 2> SurfaceExtractor<Sample>::range() {
  const auto found = sample_range<Sample>(pages_);
  const PageId coarsest{pages_.grid().top(), {0, 0, 0}};
  if (!found) throw PageLost{coarsest, coarsest};
  return *found;
}

template <class Sample>
ContourOptions SurfaceExtractor<Sample>::contour_options() const {
  return request_.contour_options(diamonds_.last_sample(), diamonds_.spacing());
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of(const SurfaceCut& cut, Progress& progress) {
  find_split(cut, progress);
  ExtractedSurface surface = split_pages_.count() > 0 ? contour_of_mesh(progress) : contour_of_root();
  clip(surface.contour);
  return surface;
}

template <class Sample>
void SurfaceExtractor<Sample>::find_split(const SurfaceCut& cut, Progress& progress) {
  // A thread does not pay for a few pages. After other cuts, most pages are known already.
  constexpr std::int64_t kLeastPages = 24;
  const LatticePoint blocks = diamonds_.grid().blocks(0);
  const std::int64_t pages = std::int64_t{blocks.i} * blocks.j * blocks.k;
  const std::int64_t most = request_.max_triangles ? 1 : static_cast<std::int64_t>(threads_);
  make_helpers(static_cast<std::size_t>(std::clamp<std::int64_t>(pages / kLeastPages, 1, most)));
  std::vector<CrossedPageReader<Sample>*> readers{&split_pages_.reader()};
  for (const std::unique_ptr<Helper>& helper : helpers_) readers.push_back(&helper->reader);
  split_pages_.find(cut, readers, progress);
  if (request_.others_follow) return;
  // The split diamonds are known now, so bounds are no longer needed.
  pages_.drop_bounds();
  for (const std::unique_ptr<Helper>& helper : helpers_) helper->diamonds.pages().drop_bounds();
}

template <class Sample>
void SurfaceExtractor<Sample>::make_helpers(std::size_t threads) {
  helpers_.clear();
  if (threads == 1) return;
  const std::vector<StoredPages<OrderedWord<Sample>>*> thread_pages = pages_.for_threads(threads);
  for (std::size_t t = 1; t < threads; ++t) {
    helpers_.push_back(std::make_unique<Helper>(*thread_pages[t], request_, limits_));
    helpers_.back()->diamonds.set_contour(request_.isovalue);
  }
}

template <class Sample>
void SurfaceExtractor<Sample>::clip(Contour& contour) const {
  const Vec3 spacing = contour_options().spacing;
  if (request_.region) clip_contour(contour, *request_.region, spacing);
  clip_contour(contour, request_.sides, spacing);
}

template <class Sample>
std::optional<ExtractedSurface> SurfaceExtractor<Sample>::full_contour(Progress& progress) {
  FullContour<Sample> full(diamonds_, request_.isovalue, request_.least_parameter, limits_, threads_);
  if (!full.is_worthwhile()) return {};
  std::optional<Contour> contour = full.run(progress);
  if (!contour) return {};
  ExtractedSurface surface;
  surface.contour = std::move(*contour);
  surface.tetrahedra = 6 * full.crossed_cells();
  clip(surface.contour);
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of_root() {
  ExtractedSurface surface;
  surface.contour = root_contour(diamonds_, request_.isovalue, contour_options());
  surface.tetrahedra = static_cast<std::uint64_t>(diamonds_.root().tetrahedron_count());
  surface.max_error = diamonds_.error(split_pages_.class_if_allowed(diamonds_.root().point()));
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of_mesh(Progress& progress) {
  std::vector<StoredDiamonds<Sample>*> thread_diamonds{&diamonds_};
  for (const std::unique_ptr<Helper>& helper : helpers_) thread_diamonds.push_back(&helper->diamonds);
  // Each thread may need pages now that others have decoded to find the split diamonds.
  if (!helpers_.empty()) pages_.for_threads(thread_diamonds.size());
  MeshContour<Sample> mesh(thread_diamonds, split_pages_, limits_, request_);
  ExtractedSurface surface;
  surface.contour = mesh.run(progress);
  surface.diamonds = split_pages_.count();
  surface.tetrahedra =
      static_cast<std::uint64_t>(diamonds_.root().tetrahedron_count()) + mesh.tetrahedra_added();
  surface.max_error = diamonds_.error(std::max(mesh.greatest_class_at_lost(), split_pages_.greatest_left()));
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::extract_once(Progress& progress) {
  const int least_class = diamonds_.class_within(request_.error) + 1;
  if (!request_.max_triangles && request_.join && least_class == 1 && limits_.lost.empty()) {
    if (std::optional<ExtractedSurface> surface = full_contour(progress)) return std::move(*surface);
  }
  if (!request_.max_triangles) return contour_of({.error_class = least_class}, progress);
  if (request_.join) return decimated(least_class, progress);
  return contour_of(cut_of(*request_.max_triangles, least_class, progress), progress);
}

template <class Sample>
SurfaceCut SurfaceExtractor<Sample>::cut_of(std::uint64_t triangles, int least_class, Progress& progress) {
  TriangleBudget<Sample> chosen(diamonds_, split_pages_, request_);
  return chosen.find(triangles, least_class, diamonds_.root(), progress);
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::decimated(int least_class, Progress& progress) {
  // The mesh is refined further than to the wanted number of triangles, by this factor or to an error of a
  // part of a voxel, below which samples give little information. Joining points leaves about a third of its
  // triangles.
  constexpr double kFiner = 12, kJoined = 2.7, kEnough = 1.25, kFineError = 0.25;
  const Vec3 spacing = diamonds_.spacing();
  const double fine_error = kFineError * std::min({spacing.x, spacing.y, spacing.z});
  const int fine_class = std::max(least_class, diamonds_.class_within(fine_error) + 1);
  const std::uint64_t most = *request_.max_triangles;
  const auto times_most = [most](double factor) {
    return static_cast<std::uint64_t>(kJoined * factor * static_cast<double>(most));
  };
  ExtractedSurface surface = contour_of(cut_of(times_most(kFiner), fine_class, progress), progress);
  if (surface.contour.triangles.size() < most && fine_class > least_class)
    surface = contour_of(cut_of(times_most(kEnough), least_class, progress), progress);
  for (std::uint64_t budget = times_most(kFiner / 2);; budget /= 2) {
    if (surface.contour.triangles.size() > most) {
      progress.step("decimating", -1);
      const Decimation done = decimate_contour(surface.contour, most);
      surface.max_error += done.error;
      surface.bodies_left_out = done.bodies;
    }
    // Parts of a border, and handles, may need more triangles than are wanted.
    if (surface.contour.triangles.size() <= most || budget == 0) return surface;
    surface = contour_of(cut_of(budget, least_class, progress), progress);
  }
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::extract(const SurfaceRequest& request, Progress& progress) {
  request_ = request;
  // Pages that were lost for another surface are found and reported again.
  limits_ = {};
  diamonds_.set_contour(request_.isovalue);
  if (request.region) {
    const Vec3 spacing = diamonds_.spacing();
    const auto in_samples = [&](const Vec3& p) {
      Vec3 result;
      for (int axis = 0; axis < 3; ++axis)
        result[axis] = (p[axis] - diamonds_.domain().box().min[axis]) / spacing[axis];
      return result;
    };
    limits_.region = {in_samples(request.region->min), in_samples(request.region->max)};
  }
  threads_ = thread_limit();
  std::vector<PageId> lost;
  for (;;) {
    split_pages_.forget(request.max_triangles.has_value());
    try {
      ExtractedSurface surface = extract_once(progress);
      surface.lost = lost;
      return surface;
    } catch (const PageLost& missing) {
      // The first damaged page must not depend on the number of threads.
      if (std::exchange(threads_, 1) > 1) continue;
      // If the surface cannot do without the damaged page, the page that is predicted from it counts as lost,
      // too.
      const auto is_known = [&](const PageId& page) {
        return std::find(lost.begin(), lost.end(), page) != lost.end();
      };
      const PageId page = is_known(missing.damaged) ? missing.page : missing.damaged;
      if (request.strict) fail_as(ErrorKind::kDamaged, "{} is damaged", page_name(page));
      if (page.lod == diamonds_.grid().top() || is_known(page))
        fail_as(ErrorKind::kDamaged, "{} is damaged, without which there is no surface", page_name(page));
      lost.push_back(page);
      limits_.lost.add(page);
    }
  }
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(SurfaceExtractor);

}  // namespace adamas::isosurface
