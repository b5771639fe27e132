#include "isosurface/extraction/joined_surface.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/base/large_pages.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::isosurface {

namespace {

constexpr std::uint32_t kNone = ContourBuilder::kNone;

/// Calls visit(key, number) for the shared points that may belong to vertices on a plane.
template <class Visit>
void for_each_on_plane(const SurfaceSlab& slab, std::int32_t plane, const Visit& visit) {
  slab.shared.for_each([&](LatticePoint key, std::uint32_t number) {
    if (key.k >= 2 * plane - 1 && key.k <= 2 * plane + 1) visit(key, number);
  });
}

/// Reserves memory for more elements, and for the expected total: `part` is the part of all elements that
/// there will be then.
template <class T>
void make_room(std::vector<T>& all, std::size_t more, double part) {
  const std::size_t size = all.size() + more;
  constexpr double kSpare = 1.05;
  if (size > all.capacity())
    reserve_in_large_pages(
        all, std::max(size, static_cast<std::size_t>(kSpare * static_cast<double>(size) / part)));
}

/// Calls gather(n, found) for numbers from `begin` to `end` - 1, in threads, with a list for each part of the
/// range. Returns the concatenated lists.
template <class T, class Gather>
std::vector<T> gather_in_threads(std::size_t begin, std::size_t end, const Gather& gather) {
  constexpr std::size_t kPart = 1 << 15;
  const std::size_t count = end - begin;
  std::vector<std::vector<T>> parts((count + kPart - 1) / kPart);
  parallel_chunks(count, kPart, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) gather(begin + n, parts[first / kPart]);
  });
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Adds the numbers of points next to some vertices to a map, by key.
template <class Patches>
void add_numbers_near(const LatticeMap<bool>& vertices, std::int32_t sample,
                      const std::vector<EdgePoint>& edge_points, const Patches& patches,
                      LatticeMap<std::uint32_t>& numbers) {
  const auto in_samples = [sample](LatticePoint p) {
    return LatticePoint{p.i / sample, p.j / sample, p.k / sample};
  };
  // Most points are next to other vertices than these. A small table of hashes excludes nearly all of them.
  constexpr int kBits = 16;
  const auto place = [](LatticePoint p) { return static_cast<std::size_t>(hash_value(p) >> (64 - kBits)); };
  std::vector<bool> may_have(std::size_t{1} << kBits);
  vertices.for_each([&](LatticePoint p, bool) { may_have[place(p)] = true; });
  const auto is_near = [&](LatticePoint p) { return may_have[place(p)] && vertices.find(p) != nullptr; };
  using Found = std::pair<LatticePoint, std::uint32_t>;
  const auto edges_found =
      gather_in_threads<Found>(0, edge_points.size(), [&](std::size_t n, std::vector<Found>& found) {
        const EdgePoint& p = edge_points[n];
        if (is_near(in_samples(p.nearer_end())))
          found.emplace_back(in_samples(p.first) + in_samples(p.second), static_cast<std::uint32_t>(n));
      });
  const auto patches_found =
      gather_in_threads<Found>(0, patches.size(), [&](std::size_t n, std::vector<Found>& found) {
        const PointsOfVertex& points = patches[n].edge_points;
        if (points.points != 0 && is_near(points.vertex))
          found.emplace_back(point_key(points.vertex, std::countr_zero(points.points)),
                             kFirstPatch + static_cast<std::uint32_t>(n));
      });
  for (const auto& [key, number] : edges_found) *numbers.insert(key).first = number;
  for (const auto& [key, number] : patches_found) *numbers.insert(key).first = number;
}

}  // namespace

void SurfaceSlab::clear(std::int32_t first_plane, std::int32_t last_plane) {
  first = first_plane;
  last = last_plane;
  edge_points.clear();
  edge_positions.clear();
  patches.clear();
  triangles.clear();
  shared.clear();
  crossed_cells = 0;
  coinciding.clear();
}

std::vector<PointsOfVertex> SurfaceSlab::separate(std::int32_t sample, CoincidingPatches& coincidences) {
  const auto edges = static_cast<std::uint32_t>(edge_points.size());
  first_separated = edges;
  // Patches have places behind those of edge points.
  std::vector<CoincidingPatches::Suspect> suspects;
  for (std::uint32_t p = 0; p < edges; ++p) {
    if (!on_plane(edge_points[p].nearer_end().k / sample)) suspects.push_back({p, false});
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (!on_plane(patches[p].edge_points.vertex.k)) suspects.push_back({edges + p, true});
  }
  const auto place = [edges](std::uint32_t n) { return n < kFirstPatch ? n : n - kFirstPatch + edges; };
  std::vector<std::uint32_t> found =
      coincidences.find(edges + patches.size(), suspects, [&](const auto& visit) {
        for (const auto& [a, b, c] : triangles) visit({place(a), place(b), place(c)});
      });
  sort_unique(found);
  std::vector<PointsOfVertex> result;
  for (const std::uint32_t p : found) {
    if (p < edges) continue;
    PointsOfVertex& points = patches[p - edges].edge_points;
    if (on_plane(points.vertex.k)) {
      coinciding.push_back(p - edges);
    } else {
      result.push_back(points);
      // The first point of the patch has this key.
      shared.erase(point_key(points.vertex, std::countr_zero(points.points)));
      points.points = 0;
    }
  }
  return result;
}

void SurfaceSlab::share(const LatticeMap<bool>& vertices, std::int32_t sample) {
  add_numbers_near(vertices, sample, edge_points, patches, shared);
}

Vec3 JoinedSurface::position(const JoinedPoint& joined) const {
  Vec3 result = joined.position();
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = std::clamp(result[axis], box_.min[axis], box_.max[axis]);
  return result;
}

void JoinedSurface::append(const SurfaceSlab& slab, double part) {
  std::vector<std::uint32_t> edge_numbers(slab.edge_points.size(), kNone);
  std::vector<std::uint32_t> patch_numbers(slab.patches.size(), kNone);
  const auto number = [&](std::uint32_t n) -> std::uint32_t& {
    return n < kFirstPatch ? edge_numbers[n] : patch_numbers[n - kFirstPatch];
  };
  for_each_on_plane(slab, slab.first, [&](LatticePoint key, std::uint32_t n) {
    const std::uint32_t* const known = shared_.find(key);
    if (known == nullptr) return;
    number(n) = *known;
    if (n < kFirstPatch) return;
    JoinedPoint& joined = on_plane_[*known];
    joined.add_triangles_of(slab.patches[n - kFirstPatch].joined);
    patches_[*known - kFirstPatch].position = position(joined);
  });
  on_plane_.clear();
  make_room(edge_points_, edge_numbers.size(), part);
  make_room(edge_positions_, edge_numbers.size(), part);
  make_room(patches_, patch_numbers.size(), part);
  make_room(triangles_, slab.triangles.size(), part);
  for (std::size_t n = 0; n < edge_numbers.size(); ++n) {
    if (edge_numbers[n] != kNone) continue;
    edge_numbers[n] = static_cast<std::uint32_t>(edge_points_.size());
    edge_points_.push_back(slab.edge_points[n]);
    edge_positions_.push_back(slab.edge_positions[n]);
    const std::int32_t k = slab.edge_points[n].nearer_end().k / sample_;
    if (n >= slab.first_separated) {
      separated_.push_back(edge_numbers[n]);
    } else if (k == slab.first || k == slab.last) {
      suspects_.push_back(edge_numbers[n]);
    }
  }
  for (std::size_t n = 0; n < patch_numbers.size(); ++n) {
    if (patch_numbers[n] != kNone) continue;
    const SurfaceSlab::Patch& patch = slab.patches[n];
    if (patch.edge_points.points == 0) continue;
    patch_numbers[n] = kFirstPatch + static_cast<std::uint32_t>(patches_.size());
    patches_.push_back({position(patch.joined), patch.edge_points});
    const std::int32_t k = patch.edge_points.vertex.k;
    if (k == slab.last) on_plane_.emplace(patch_numbers[n], patch.joined);
    if (k == slab.first || k == slab.last) suspects_.push_back(patch_numbers[n]);
  }
  for (const Triangle& triangle : slab.triangles) {
    const Triangle t{number(triangle[0]), number(triangle[1]), number(triangle[2])};
    if (t[0] != kNone && t[1] != kNone && t[2] != kNone) triangles_.push_back(t);
  }
  for (const std::uint32_t p : slab.coinciding) coinciding_.push_back(patch_numbers[p] - kFirstPatch);
  shared_.clear();
  for_each_on_plane(slab, slab.last,
                    [&](LatticePoint key, std::uint32_t n) { *shared_.insert(key).first = number(n); });
  crossed_cells_ += slab.crossed_cells;
}

std::vector<PointsOfVertex> JoinedSurface::separate(CoincidingPatches& coincidences) {
  // The triangles that were added last are all triangles of the points that were added with them; points of
  // slabs have others too.
  constexpr int kRoundsOfSlabs = 2;
  const std::vector<std::uint32_t> suspects = std::exchange(suspects_, std::exchange(separated_, {}));
  find_coinciding(coincidences, suspects, rounds_++ < kRoundsOfSlabs ? 0 : first_added_);
  first_added_ = triangles_.size();
  sort_unique(coinciding_);
  std::vector<PointsOfVertex> result;
  for (const std::uint32_t p : std::exchange(coinciding_, {}))
    result.push_back({patches_[p].edge_points.vertex, std::exchange(patches_[p].edge_points.points, 0)});
  return result;
}

void JoinedSurface::find_coinciding(CoincidingPatches& coincidences,
                                    const std::vector<std::uint32_t>& numbers, std::size_t first_triangle) {
  const auto place = [edges = edge_count()](std::uint32_t n) {
    return n < kFirstPatch ? n : n - kFirstPatch + edges;
  };
  std::vector<CoincidingPatches::Suspect> suspects;
  for (const std::uint32_t n : numbers) suspects.push_back({place(n), n >= kFirstPatch});
  std::vector<bool> is_suspect(edge_count() + patches_.size());
  for (const CoincidingPatches::Suspect& s : suspects) is_suspect[s.patch] = true;
  const auto with_suspects = gather_in_threads<Triangle>(
      first_triangle, triangles_.size(), [&](std::size_t n, std::vector<Triangle>& gathered) {
        const auto& [a, b, c] = triangles_[n];
        const Triangle t{place(a), place(b), place(c)};
        if ((is_suspect[t[0]] || is_suspect[t[1]] || is_suspect[t[2]]) && !is_apart(a) && !is_apart(b) &&
            !is_apart(c))
          gathered.push_back(t);
      });
  const std::vector<std::uint32_t> found =
      coincidences.find(is_suspect.size(), suspects, [&](const auto& visit) {
        for (const Triangle& t : with_suspects) visit(t);
      });
  for (const std::uint32_t p : found) {
    if (p >= edge_count() && patches_[p - edge_count()].edge_points.points != 0)
      coinciding_.push_back(p - edge_count());
  }
}

SurfaceSlab JoinedSurface::addition(const LatticeMap<bool>& vertices) const {
  SurfaceSlab result;
  result.first_edge = edge_count();
  add_numbers_near(vertices, sample_, edge_points_, patches_, result.shared);
  return result;
}

void JoinedSurface::add(const SurfaceSlab& addition) {
  for (std::size_t n = 0; n < addition.edge_points.size(); ++n)
    suspects_.push_back(static_cast<std::uint32_t>(edge_points_.size() + n));
  edge_points_.insert(edge_points_.end(), addition.edge_points.begin(), addition.edge_points.end());
  edge_positions_.insert(edge_positions_.end(), addition.edge_positions.begin(),
                         addition.edge_positions.end());
  triangles_.insert(triangles_.end(), addition.triangles.begin(), addition.triangles.end());
}

Contour JoinedSurface::finish() {
  Contour result;
  const auto edges = static_cast<std::uint32_t>(edge_points_.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(patches_.size());
  std::uint32_t next = edges;
  for (const Patch& patch : patches_) numbers.push_back(patch.edge_points.points == 0 ? kNone : next++);
  const auto number = [&](std::uint32_t n) { return n < kFirstPatch ? n : numbers[n - kFirstPatch]; };
  std::size_t kept = 0;
  for (const Triangle& triangle : triangles_) {
    const Triangle t{number(triangle[0]), number(triangle[1]), number(triangle[2])};
    if (t[0] != kNone && t[1] != kNone && t[2] != kNone) triangles_[kept++] = t;
  }
  triangles_.resize(kept);
  result.triangles = std::move(triangles_);
  result.edge_points = std::move(edge_points_);
  result.points = std::move(edge_positions_);
  reserve_in_large_pages(result.points, next);
  reserve_in_large_pages(result.vertex_points, next - edges);
  for (const Patch& patch : patches_) {
    if (patch.edge_points.points == 0) continue;
    result.points.push_back(patch.position);
    result.vertex_points.push_back({sample_ * patch.edge_points.vertex, sample_});
  }
  patches_ = {};
  return result;
}

}  // namespace adamas::isosurface
