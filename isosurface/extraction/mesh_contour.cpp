#include "isosurface/extraction/mesh_contour.h"

#include <algorithm>
#include <bit>

#include "core/base/parallel.h"

namespace adamas::isosurface {

template <class Sample>
PageContour<Sample>::PageContour(StoredDiamonds<Sample>& diamonds, const SplitPages<Sample>& pages,
                                 const SplitLimits& limits, ContourBuilder& builder)
    : diamonds_(diamonds),
      split_pages_(pages),
      limits_(limits),
      builder_(builder),
      mesh_(diamonds, [&pages](int lod, LatticePoint block) { return pages.split_of(lod, block); }),
      edge_points_(std::size_t{DiamondStencil::kEdgePlaces}, ContourBuilder::kNone) {}

template <class Sample>
void PageContour<Sample>::add(const SplitPage& page) {
  mesh_.load(page.lod, page.block, *page.split);
  page.split->for_each([&](LatticePoint q) {
    tetrahedra_ += static_cast<std::size_t>(std::popcount(mesh_.samples().slots(DiamondStencil::at(q), q)));
    if (!limits_.lost.empty()) note_lost_children(mesh_.samples().diamond(q));
    mesh_.for_each_triangle(q, [this](const typename PageMesh<Sample>::EdgePlaces& edges, bool) {
      builder_.add_triangle({edge_point(edges[0]), edge_point(edges[1]), edge_point(edges[2])});
    });
  });
  for (const std::int32_t place : used_)
    edge_points_[static_cast<std::size_t>(place)] = ContourBuilder::kNone;
  used_.clear();
}

template <class Sample>
void PageContour<Sample>::note_lost_children(const Diamond& diamond) {
  for (int c = 0; c < diamond.child_count(); ++c) {
    // A child that cannot be read has no greater error than its parents.
    const LatticePoint child = diamond.child(c);
    if (diamonds_.reaches_data(child) && split_pages_.is_lost(child))
      greatest_class_at_lost_ =
          std::max(greatest_class_at_lost_, diamonds_.class_if_crossed(diamond.point()));
  }
}

template <class Sample>
std::uint32_t PageContour<Sample>::edge_point(std::int32_t place) {
  std::uint32_t& point = edge_points_[static_cast<std::size_t>(place)];
  if (point == ContourBuilder::kNone) {
    const PageDiamonds<Sample>& samples = mesh_.samples();
    const auto [a, b] = DiamondStencil::ends_of_edge(place);
    point =
        builder_.edge_point(samples.in_lattice(a), samples.in_lattice(b), samples.value(a), samples.value(b));
    used_.push_back(place);
  }
  return point;
}

template <class Sample>
MeshContour<Sample>::MeshContour(std::span<StoredDiamonds<Sample>* const> thread_diamonds,
                                 const SplitPages<Sample>& pages, const SplitLimits& limits,
                                 const SurfaceRequest& request) {
  pages.for_each_page([&](const SplitPage& page) { pages_.push_back(&page); });
  StoredDiamonds<Sample>& first = *thread_diamonds.front();
  const ContourOptions options = request.contour_options(first.last_sample(), first.spacing());
  // Surfaces have a little less than 1.5 triangles for each split diamond.
  const std::uint64_t about = std::uint64_t{pages.count()} * 3 / 2;
  const std::uint64_t wanted = std::min(about, request.max_triangles.value_or(about));
  for (StoredDiamonds<Sample>* diamonds : thread_diamonds) {
    ContourBuilder& builder =
        *builders_.emplace_back(std::make_unique<ContourBuilder>(first.domain(), request.isovalue, options));
    // The contours of the other builders are appended to the first one.
    builder.reserve(
        static_cast<std::size_t>(builders_.size() == 1 ? wanted : wanted / thread_diamonds.size()));
    contours_.push_back(std::make_unique<PageContour<Sample>>(*diamonds, pages, limits, builder));
  }
  find_runs();
}

template <class Sample>
void MeshContour<Sample>::find_runs() {
  std::vector<std::size_t> ends;  // number of split diamonds up to the last one of each page
  std::size_t sum = 0;
  for (const SplitPage* const page : pages_) ends.push_back(sum += page->split->count());
  for (std::size_t t = 0; t <= builders_.size(); ++t) {
    const auto begin = std::lower_bound(ends.begin(), ends.end(), sum * t / builders_.size());
    runs_.push_back(static_cast<std::size_t>(begin - ends.begin()));
  }
  runs_.front() = 0;
  runs_.back() = pages_.size();
}

template <class Sample>
Contour MeshContour<Sample>::run(Progress& progress) {
  parallel_for(builders_.size(), 1, [&](std::size_t t) {
    for (std::size_t n = runs_[t]; n < runs_[t + 1]; ++n) {
      if (t == 0) progress.step("extracting", static_cast<double>(n) / static_cast<double>(runs_[1]));
      contours_[t]->add(*pages_[n]);
    }
  });
  builders_.front()->append(std::span(builders_).subspan(1));
  return builders_.front()->finish();
}

template <class Sample>
std::uint64_t MeshContour<Sample>::tetrahedra_added() const {
  std::uint64_t sum = 0;
  for (const auto& contour : contours_) sum += contour->tetrahedra_added();
  return sum;
}

template <class Sample>
int MeshContour<Sample>::greatest_class_at_lost() const {
  int greatest = 0;
  for (const auto& contour : contours_) greatest = std::max(greatest, contour->greatest_class_at_lost());
  return greatest;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(MeshContour);

}  // namespace adamas::isosurface
