#include "isosurface/extraction/surface_extractor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/geometry/tetrahedron_contour.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/extraction/diamond_halves.h"
#include "isosurface/extraction/triangle_counter.h"
#include "isosurface/hierarchy/indexed_hierarchy.h"
#include "isosurface/storage/z_order.h"

namespace adamas {

template <class Sample>
SurfaceExtractor<Sample>::SurfaceExtractor(StoredPages<OrderedWord<Sample>>& pages)
    : diamonds_(pages), subtree_bisections_(3 * pages.file().header().subtree_depth) {
  const std::int32_t middle = std::int32_t{1} << (kRootBits - 1);
  root_ = {middle, middle, middle};
}

template <class Sample>
int SurfaceExtractor<Sample>::generation(LatticePoint p) const {
  const Diamond diamond(p);
  return 3 * diamond.level() + diamond.phase();
}

template <class Sample>
void SurfaceExtractor<Sample>::sort_by_page(Points& points) const {
  if (points.size() < 2) return;
  const int bits = trailing_zeros(points[0]) + 4;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(points.size());
  for (const LatticePoint p : points) {
    order.emplace_back(ZOrder::interleave({p.i >> bits, p.j >> bits, p.k >> bits}),
                       static_cast<std::uint32_t>(order.size()));
  }
  std::sort(order.begin(), order.end());
  Points sorted;
  sorted.reserve(points.size());
  for (const auto& [page, index] : order) sorted.push_back(points[index]);
  points.swap(sorted);
}

template <class Sample>
bool SurfaceExtractor<Sample>::reaches_region(LatticePoint p, int level, int phase) const {
  const LatticePoint at = diamonds_.in_samples(p);
  const double reach = std::ldexp(nested_reach(phase), level);
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] + reach < (*region_)[0][axis] || at[axis] - reach > (*region_)[1][axis]) return false;
  }
  return true;
}

template <class Sample>
bool SurfaceExtractor<Sample>::is_lost(LatticePoint p) const {
  const int level = diamonds_.level(p);
  return level >= 0 && lost_.blocks(diamonds_.in_samples(p), level, Diamond(p).phase());
}

template <class Sample>
int SurfaceExtractor<Sample>::rank(LatticePoint p) {
  if (!diamonds_.is_stored(p)) return 0;
  if (region_ || !lost_.empty()) {
    if (region_ && !reaches_region(p, diamonds_.level(p), Diamond(p).phase())) return 0;
    if (is_lost(p)) return 0;
  }
  return diamonds_.rank_if_crossed(p);
}

template <class Sample>
bool SurfaceExtractor<Sample>::is_split(LatticePoint p, int rank, const Cut& cut) const {
  if (rank != cut.rank) return rank > cut.rank;
  if (rank == 0) return false;
  const int g = generation(p);
  if (g != cut.generation) return g < cut.generation;
  return std::binary_search(cut.last.begin(), cut.last.end(), p);
}

template <class Sample>
bool SurfaceExtractor<Sample>::leads_to(LatticePoint parent, LatticePoint child) const {
  for (const LatticePoint p : Diamond(child).parents(diamonds_.domain())) {
    if (diamonds_.is_stored(p)) return p == parent;
  }
  return false;
}

template <class Sample>
DiamondVertices SurfaceExtractor<Sample>::vertices(const Diamond& diamond, bool with_middle) {
  return {diamond, domain(), request_.isovalue, with_middle,
          [this](LatticePoint p) { return diamonds_.sample(p); }};
}

template <class Sample>
typename SurfaceExtractor<Sample>::Cut SurfaceExtractor<Sample>::cut_by_error() const {
  return {least_rank(), std::numeric_limits<int>::max(), {}};
}

template <class Sample>
typename SurfaceExtractor<Sample>::Cut SurfaceExtractor<Sample>::cut_by_triangles(std::uint64_t budget,
                                                                                  Progress& progress) {
  const int least = least_rank();
  diamonds_.set_contour(request_.isovalue, least);
  TriangleCounter<Sample> counter(diamonds_, request_, subtree_bisections_);
  std::int64_t triangles = counter.triangles(Diamond(root_));
  // By rank, then by generation: no diamond has a greater rank, or with the same rank an earlier generation,
  // than its parents.
  std::vector<std::map<int, Points>> waiting(StoredDiamonds<Sample>::kRanks);
  if (const int r = rank(root_); r >= least) waiting[static_cast<std::size_t>(r)][0].push_back(root_);
  for (int r = StoredDiamonds<Sample>::kRanks - 1; r >= least; --r) {
    auto& generations = waiting[static_cast<std::size_t>(r)];
    while (!generations.empty()) {
      auto [g, points] = std::move(*generations.begin());
      generations.erase(generations.begin());
      sort_by_page(points);
      progress.step("choosing", static_cast<double>(triangles) / static_cast<double>(budget));
      for (std::size_t n = 0; n < points.size(); ++n) {
        const std::int64_t added = counter.added_by_split(Diamond(points[n]));
        if (triangles + added > static_cast<std::int64_t>(budget)) {
          Cut cut{r, g, {points.begin(), points.begin() + static_cast<std::ptrdiff_t>(n)}};
          std::sort(cut.last.begin(), cut.last.end());
          return cut;
        }
        triangles += added;
        for (const LatticePoint child : Diamond(points[n]).children(diamonds_.domain())) {
          if (!leads_to(points[n], child)) continue;
          if (const int c = rank(child); c >= least)
            waiting[static_cast<std::size_t>(c)][g + 1].push_back(child);
        }
      }
    }
  }
  return cut_by_error();
}

template <class Sample>
template <class Split, class Leaf>
void SurfaceExtractor<Sample>::walk(const Cut& cut, Progress& progress, Split&& split, Leaf&& leaf) {
  // With subtrees it matters of every diamond whether it is crossed.
  diamonds_.set_contour(request_.isovalue, subtree_bisections_ > 0 ? 0 : cut.rank);
  Points current, next;
  if (const int r = rank(root_); is_split(root_, r, cut)) {
    current.push_back(root_);
  } else {
    leaf(nullptr, Diamond(root_), r);
  }
  for (int g = 0; !current.empty(); ++g) {
    progress.step("extracting", g / (3.0 * diamonds_.levels()));
    next.clear();
    sort_by_page(current);
    for (const LatticePoint p : current) {
      const Diamond diamond(p);
      split(diamond);
      for (int c = 0; c < diamond.child_count(); ++c) {
        const LatticePoint child = diamond.child(c);
        if (!domain().contains(child) || is_beyond(Diamond(child), diamonds_.last_sample())) continue;
        const int r = rank(child);
        if (!is_split(child, r, cut)) {
          leaf(&diamond.type().child_tetrahedra[static_cast<std::size_t>(c)], Diamond(child),
               // What cannot be had has no greater error than what it comes from.
               lost_.empty() || !is_lost(child) ? r : rank(p));
        } else if (leads_to(p, child)) {
          next.push_back(child);
        }
      }
    }
    current.swap(next);
  }
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of(const Cut& cut, Progress& progress) {
  ExtractedSurface surface =
      subtree_bisections_ > 0 ? contour_of_subtrees(cut, progress) : contour_of_mesh(cut, progress);
  if (request_.region) clip_contour(surface.contour, *request_.region);
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of_mesh(const Cut& cut, Progress& progress) {
  ExtractedSurface surface;
  ContourBuilder builder(domain(), request_.isovalue, {request_.least_parameter, diamonds_.last_sample()});
  const auto emit = [&](const Diamond& diamond, int slot, unsigned above, const auto& values) {
    if (kTetrahedronContours[above].triangle_count == 0) return;
    builder.add(
        {diamond.point(), static_cast<std::uint8_t>(slot), static_cast<std::uint8_t>(above), values()});
  };
  std::optional<DiamondVertices> v;
  surface.tetrahedra = static_cast<std::uint64_t>(Diamond(root_).tetrahedron_count());
  walk(
      cut, progress,
      [&](const Diamond& diamond) {
        v = vertices(diamond, true);
        ++surface.diamonds;
        surface.tetrahedra += static_cast<std::uint64_t>(diamond.tetrahedron_count(domain()));
      },
      [&](const ChildTetrahedra* halves, const Diamond& diamond, int rank) {
        surface.max_error = std::max(surface.max_error, diamonds_.error(rank));
        if (halves == nullptr) {
          v = vertices(diamond, false);
          for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot)
            emit(diamond, slot, v->above_of(slot, {0, 1, 2, 3}), [&] { return v->tetrahedron(slot); });
          return;
        }
        for (const auto& half : *halves) {
          if ((v->slots >> half.slot & 1) != 0)
            emit(diamond, half.child_slot, v->above_of(half.slot, half.vertices),
                 [&] { return v->half(half.slot, half.vertices); });
        }
      });
  surface.contour = builder.finish();
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::contour_of_subtrees(const Cut& cut, Progress& progress) {
  ExtractedSurface surface;
  // Bisections of neighbours of different generations do not meet by themselves: a table of the fine mesh
  // splits what one needs of the other.
  IndexedHierarchy mesh(domain(), diamonds_.levels());
  Points done;
  const auto is_in_domain = [&](const Diamond& diamond, int slot) {
    const int next = slot + 1 == diamond.tetrahedron_count() ? 0 : slot + 1;
    return domain().contains(diamond.ring(slot)) && domain().contains(diamond.ring(next));
  };
  const auto refine = [&](auto&& self, const Diamond& diamond, int slot, int bisections) -> void {
    if (bisections == 0 || diamonds_.level(diamond.point()) < 0) return;
    mesh.split(diamond.point(), done);
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      if (bisections > 1) self(self, Diamond(diamond.child(half.child)), half.slot, bisections - 1);
    }
  };
  walk(
      cut, progress,
      [&](const Diamond& diamond) {
        ++surface.diamonds;
        mesh.split(diamond.point(), done);
        done.clear();
      },
      [&](const ChildTetrahedra* halves, const Diamond& diamond, int rank) {
        surface.max_error = std::max(surface.max_error, diamonds_.error(rank));
        // What is exactly linear, or not crossed, or lost, stays as it is.
        const bool has_values = 3 * diamonds_.level(diamond.point()) >= subtree_bisections_;
        if (has_values && (rank == 0 || (!lost_.empty() && is_lost(diamond.point())))) return;
        if (halves == nullptr) {
          for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot)
            refine(refine, diamond, slot, subtree_bisections_);
          return;
        }
        for (const auto& half : *halves) {
          if (is_in_domain(diamond, half.child_slot))
            refine(refine, diamond, half.child_slot, subtree_bisections_);
        }
      });
  surface.tetrahedra = mesh.tetrahedron_count();
  surface.contour = extract_contour(mesh, [this](LatticePoint p) { return diamonds_.sample(p); },
                                    request_.isovalue, {request_.least_parameter, diamonds_.last_sample()});
  return surface;
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::extract_once(Progress& progress) {
  if (!request_.max_triangles) return contour_of(cut_by_error(), progress);
  // With subtrees a split adds triangles to its neighbours too, which the choice does not know: it is then
  // repeated with other numbers, until it uses nearly all.
  constexpr double kEnough = 0.97;
  constexpr int kMostTurns = 12;
  const std::uint64_t most = *request_.max_triangles;
  std::uint64_t kept = 0, refused = most + 1;
  std::optional<ExtractedSurface> best;
  for (int turn = 0; turn < kMostTurns && refused - kept > 1; ++turn) {
    const std::uint64_t budget = turn == 0 ? most : (kept + refused) / 2;
    ExtractedSurface surface = contour_of(cut_by_triangles(budget, progress), progress);
    const std::uint64_t found = surface.contour.triangles.size();
    (found <= most ? kept : refused) = budget;
    if (found > most) continue;
    const bool is_enough = turn == 0 || static_cast<double>(found) >= kEnough * static_cast<double>(most);
    if (!best || found > best->contour.triangles.size()) best = std::move(surface);
    if (is_enough) break;
  }
  return best ? std::move(*best) : contour_of({StoredDiamonds<Sample>::kRanks, 0, {}}, progress);
}

template <class Sample>
ExtractedSurface SurfaceExtractor<Sample>::extract(const SurfaceRequest& request, Progress& progress) {
  request_ = request;
  // What was lost to another surface is met with and told again.
  lost_ = LostRegions(subtree_bisections_ / 3);
  region_.reset();
  if (request.region) {
    const Vec3 spacing = std::ldexp(1.0, -diamonds_.levels()) * diamonds_.domain().box().size();
    const auto in_samples = [&](const Vec3& p) {
      Vec3 result;
      for (int axis = 0; axis < 3; ++axis)
        result[axis] = (p[axis] - diamonds_.domain().box().min[axis]) / spacing[axis];
      return result;
    };
    region_ = {in_samples(request.region->min), in_samples(request.region->max)};
  }
  std::vector<PageId> lost;
  for (;;) {
    try {
      ExtractedSurface surface = extract_once(progress);
      surface.lost = lost;
      return surface;
    } catch (const PageLost& missing) {
      const auto [level, block] = missing.page;
      const std::string what =
          fmt::format("the page of level {} at {}, {}, {}", level, block.i, block.j, block.k);
      if (request.strict) fail("{} is damaged", what);
      if (level == diamonds_.grid().top() || std::find(lost.begin(), lost.end(), missing.page) != lost.end())
        fail("{} is damaged, without which there is no surface", what);
      lost.push_back(missing.page);
      lost_.add(missing.page);
    }
  }
}

template class SurfaceExtractor<std::uint8_t>;
template class SurfaceExtractor<std::uint16_t>;
template class SurfaceExtractor<std::int16_t>;
template class SurfaceExtractor<float>;

}  // namespace adamas
