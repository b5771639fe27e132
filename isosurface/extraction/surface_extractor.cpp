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
typename SurfaceExtractor<Sample>::Vertices SurfaceExtractor<Sample>::vertices(const Diamond& diamond,
                                                                               bool with_middle) {
  Vertices result;
  const int count = diamond.tetrahedron_count();
  if (diamonds_.domain().boundary_count(diamond.point()) == 0) {
    result.slots = (1u << count) - 1;
  } else {
    for (const int slot : diamond.tetrahedra(diamonds_.domain())) result.slots |= 1u << slot;
  }
  const auto [a, b] = diamond.split_edge();
  result.begin = diamonds_.sample(a);
  result.end = diamonds_.sample(b);
  if (with_middle) result.middle = diamonds_.sample(diamond.point());
  // Tetrahedron `slot` has the vertices `slot` and `slot` + 1 of the ring.
  const unsigned used = result.slots | result.slots << 1 | result.slots >> (count - 1);
  for (int r = 0; r < count; ++r) {
    if ((used >> r & 1) != 0) result.ring[static_cast<std::size_t>(r)] = diamonds_.sample(diamond.ring(r));
  }
  result.ring[static_cast<std::size_t>(count)] = result.ring[0];
  const auto above = [&](double value) {
    result.finite = result.finite && std::isfinite(value);
    return unsigned{value >= request_.isovalue};
  };
  result.above = above(result.begin) | above(result.end) << 1 | above(result.middle) << 2;
  for (int r = 0; r <= count; ++r) result.above |= above(result.ring[static_cast<std::size_t>(r)]) << (3 + r);
  return result;
}

namespace {

unsigned above(const std::array<double, 4>& values, double isovalue) {
  unsigned bits = 0;
  for (std::size_t v = 0; v < 4; ++v) bits |= unsigned{values[v] >= isovalue} << v;
  return bits;
}

bool is_uncrossed(unsigned above) { return above == 0 || above == 15; }

std::array<double, 4> half_values(const TetrahedronHalf& half, const std::array<double, 4>& values,
                                  double middle) {
  std::array<double, 4> result;
  for (std::size_t v = 0; v < 4; ++v) result[v] = half.vertices[v] < 4 ? values[half.vertices[v]] : middle;
  return result;
}

}  // namespace

template <class Sample>
bool SurfaceExtractor<Sample>::is_split_finely(LatticePoint p, int more) {
  // Diamonds below the samples are never split.
  if (cut_ == nullptr || diamonds_.level(p) < 0) return false;
  if (follows_split(p)) return true;
  if (more == 0) return false;
  for (const LatticePoint child : Diamond(p).children(diamonds_.domain())) {
    if (is_split_finely(child, more - 1)) return true;
  }
  return false;
}

template <class Sample>
bool SurfaceExtractor<Sample>::follows_split(LatticePoint p) {
  const auto [known, is_new] = following_.insert(p);
  if (!is_new) return *known != 0;
  Points ancestors{p}, parents;
  for (int g = 0; g < subtree_bisections_; ++g) {
    parents.clear();
    for (const LatticePoint a : ancestors) {
      for (const LatticePoint parent : Diamond(a).parents(diamonds_.domain())) parents.push_back(parent);
    }
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    ancestors.swap(parents);
  }
  const bool result = std::any_of(ancestors.begin(), ancestors.end(),
                                  [this](LatticePoint a) { return is_split(a, rank(a), *cut_); });
  *following_.find(p) = result ? 1 : 0;
  return result;
}

template <class Sample>
template <class Fn>
void SurfaceExtractor<Sample>::for_each_crossed(LatticePoint diamond, int slot,
                                                const std::array<double, 4>& values, int bisections,
                                                Fn&& fn) {
  if (bisections == 0 && !is_split_finely(diamond)) {
    const unsigned bits = above(values, request_.isovalue);
    if (kTetrahedronContours[bits].triangle_count != 0)
      fn(CrossedTetrahedron{diamond, static_cast<std::uint8_t>(slot), static_cast<std::uint8_t>(bits),
                            values});
    return;
  }
  const Diamond d(diamond);
  const double middle = diamonds_.sample(diamond);
  for (const int end : {0, 1}) {
    const TetrahedronHalf& half = DiamondHalves::of(d.type_index(), slot, end);
    for_each_crossed(d.child(half.child), half.slot, half_values(half, values, middle),
                     std::max(0, bisections - 1), fn);
  }
}

template <class Sample>
bool SurfaceExtractor<Sample>::is_inside(const Diamond& diamond) const {
  const LatticePoint p = diamond.point(), last = diamonds_.last_sample();
  const std::int32_t s = diamond.scale();
  if (p.i + s > last.i || p.j + s > last.j || p.k + s > last.k) return false;
  if (!request_.region) return true;
  const Vec3 low = domain().position(p - LatticePoint{s, s, s}),
             high = domain().position(p + LatticePoint{s, s, s});
  return request_.region->contains(low) && request_.region->contains(high);
}

template <class Sample>
std::int64_t SurfaceExtractor<Sample>::count_clipped(const CrossedTetrahedron& tetrahedron) const {
  ContourBuilder builder(domain(), request_.isovalue, {request_.least_parameter, diamonds_.last_sample()});
  builder.add(tetrahedron);
  Contour contour = builder.finish();
  if (request_.region) clip_contour(contour, *request_.region);
  return static_cast<std::int64_t>(contour.triangles.size());
}

template <class Sample>
std::int64_t SurfaceExtractor<Sample>::count_triangles(LatticePoint diamond, int slot,
                                                       const std::array<double, 4>& values) {
  std::int64_t count = 0;
  for_each_crossed(diamond, slot, values, subtree_bisections_, [&](const CrossedTetrahedron& t) {
    if (!is_inside(Diamond(t.diamond))) {
      count += count_clipped(t);
    } else if (std::all_of(t.values.begin(), t.values.end(),
                           [](double value) { return std::isfinite(value); })) {
      count += kTetrahedronContours[t.above].triangle_count;
    }
  });
  return count;
}

template <class Sample>
std::int64_t SurfaceExtractor<Sample>::added_triangles(LatticePoint p) {
  const Diamond diamond(p);
  const Vertices v = vertices(diamond, true);
  // With subtrees a tetrahedron may be crossed though all of its vertices are on one side.
  const bool by_sides = subtree_bisections_ == 0 && v.finite && is_inside(diamond);
  const auto triangles = [](unsigned above) {
    return std::int64_t{kTetrahedronContours[above].triangle_count};
  };
  std::int64_t added = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((v.slots >> slot & 1) == 0) continue;
    if (by_sides) {
      added -= triangles(v.above_of(slot, {0, 1, 2, 3}));
    } else {
      added -= count_triangles(p, slot, v.tetrahedron(slot));
    }
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      if (by_sides) {
        added += triangles(v.above_of(slot, half.vertices));
      } else {
        added += count_triangles(diamond.child(half.child), half.slot,
                                 half_values(half, v.tetrahedron(slot), v.middle));
      }
    }
  }
  return added;
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
  cut_ = nullptr;
  const Diamond root(root_);
  const Vertices v = vertices(root, false);
  std::int64_t triangles = 0;
  for (int slot = 0; slot < root.tetrahedron_count(); ++slot)
    triangles += count_triangles(root_, slot, v.tetrahedron(slot));
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
        const std::int64_t added = added_triangles(points[n]);
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
ExtractedSurface SurfaceExtractor<Sample>::contour_of(const Cut& cut, Progress& progress) {
  ExtractedSurface surface;
  const Domain& domain = diamonds_.domain();
  diamonds_.set_contour(request_.isovalue, cut.rank);
  cut_ = subtree_bisections_ > 0 ? &cut : nullptr;
  following_ = {};
  ContourBuilder builder(domain, request_.isovalue, {request_.least_parameter, diamonds_.last_sample()});
  const auto emit = [&](LatticePoint diamond, int slot, const std::array<double, 4>& values) {
    for_each_crossed(diamond, slot, values, subtree_bisections_,
                     [&](const CrossedTetrahedron& t) { builder.add(t); });
  };
  const auto note_error = [&](int rank) {
    surface.max_error = std::max(surface.max_error, diamonds_.error(rank));
  };
  Points current, next;
  surface.tetrahedra = static_cast<std::uint64_t>(Diamond(root_).tetrahedron_count());
  if (const int r = rank(root_); is_split(root_, r, cut)) {
    current.push_back(root_);
  } else {
    note_error(r);
    const Vertices v = vertices(Diamond(root_), false);
    for (int slot = 0; slot < Diamond(root_).tetrahedron_count(); ++slot)
      emit(root_, slot, v.tetrahedron(slot));
  }
  for (int g = 0; !current.empty(); ++g) {
    progress.step("extracting", g / (3.0 * diamonds_.levels()));
    next.clear();
    sort_by_page(current);
    for (const LatticePoint p : current) {
      const Diamond diamond(p);
      const Vertices v = vertices(diamond, true);
      ++surface.diamonds;
      surface.tetrahedra += static_cast<std::uint64_t>(diamond.tetrahedron_count(domain));
      for (int c = 0; c < diamond.child_count(); ++c) {
        const LatticePoint child = diamond.child(c);
        if (!domain.contains(child) || is_beyond(Diamond(child), diamonds_.last_sample())) continue;
        const int r = rank(child);
        if (is_split(child, r, cut)) {
          if (leads_to(p, child)) next.push_back(child);
          continue;
        }
        // What cannot be had has no greater error than what it comes from.
        note_error(lost_.empty() || !is_lost(child) ? r : rank(p));
        for (const auto& half : diamond.type().child_tetrahedra[static_cast<std::size_t>(c)]) {
          if ((v.slots >> half.slot & 1) == 0) continue;
          if (subtree_bisections_ == 0 && is_uncrossed(v.above_of(half.slot, half.vertices))) continue;
          emit(child, half.child_slot,
               half_values({{}, half.child_slot, half.vertices}, v.tetrahedron(half.slot), v.middle));
        }
      }
    }
    current.swap(next);
  }
  cut_ = nullptr;
  surface.tetrahedra <<= subtree_bisections_;
  surface.contour = builder.finish();
  if (request_.region) clip_contour(surface.contour, *request_.region);
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
