#include "isosurface/extraction/joined_surface.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/base/large_pages.h"
#include "core/base/sort_unique.h"
#include "isosurface/contour/coinciding_patches.h"

namespace adamas {

namespace {

constexpr std::uint32_t kNone = ContourBuilder::kNone;

/// Calls visit(key, number) for the shared points that may belong to vertices on a plane.
template <class Visit>
void for_each_on_plane(const SurfaceSlab& slab, std::int32_t plane, const Visit& visit) {
  slab.shared.for_each([&](LatticePoint key, std::uint32_t number) {
    if (key.k >= 2 * plane - 1 && key.k <= 2 * plane + 1) visit(key, number);
  });
}

/// Makes room for more elements, and for as many as there will be in all by what part of them this is.
template <class T>
void make_room(std::vector<T>& all, std::size_t more, double part) {
  const std::size_t size = all.size() + more;
  constexpr double kSpare = 1.05;
  if (size > all.capacity())
    reserve_in_large_pages(all, std::max(size, static_cast<std::size_t>(kSpare * static_cast<double>(size) / part)));
}

}  // namespace

void SurfaceSlab::clear(std::int32_t first_plane, std::int32_t last_plane) {
  first = first_plane;
  last = last_plane;
  edge_points.clear();
  edge_positions.clear();
  patches.clear();
  triangles.clear();
  shared = {};
  crossed_cells = 0;
  coinciding.clear();
}

void SurfaceSlab::find_coinciding(std::int32_t sample) {
  const auto edges = static_cast<std::uint32_t>(edge_points.size());
  const auto count = edges + static_cast<std::uint32_t>(patches.size());
  std::vector<bool> is_suspect(count), is_joined(count);
  for (std::uint32_t p = 0; p < edges; ++p) {
    const std::int32_t k = edge_points[p].nearer_end().k / sample;
    is_suspect[p] = k != first && k != last;
  }
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    is_joined[edges + p] = true;
    is_suspect[edges + p] = patches[p].vertex.k != first && patches[p].vertex.k != last;
  }
  const auto place = [edges](std::uint32_t n) { return n < kFirstPatch ? n : n - kFirstPatch + edges; };
  coinciding = CoincidingPatches::find(count, is_suspect, is_joined, [&](const auto& visit) {
    for (const auto& [a, b, c] : triangles) {
      const std::array<std::uint32_t, 3> t{place(a), place(b), place(c)};
      for (std::size_t n = 0; n < 3; ++n) {
        if (is_suspect[t[n]]) visit(t, n);
      }
    }
  });
  std::erase_if(coinciding, [edges](std::uint32_t p) { return p < edges; });
  for (std::uint32_t& p : coinciding) p -= edges;
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
    const std::int32_t k = vertex_plane(slab.edge_points[n]);
    if (k == slab.first || k == slab.last) suspects_.push_back(edge_numbers[n]);
  }
  for (std::size_t n = 0; n < patch_numbers.size(); ++n) {
    if (patch_numbers[n] != kNone) continue;
    const SurfaceSlab::Patch& patch = slab.patches[n];
    patch_numbers[n] = kFirstPatch + static_cast<std::uint32_t>(patches_.size());
    patches_.push_back({position(patch.joined), patch.vertex, patch.points});
    if (patch.vertex.k == slab.last) on_plane_.emplace(patch_numbers[n], patch.joined);
    if (patch.vertex.k == slab.first || patch.vertex.k == slab.last) suspects_.push_back(patch_numbers[n]);
  }
  for (const Triangle& t : slab.triangles) triangles_.push_back({number(t[0]), number(t[1]), number(t[2])});
  for (const std::uint32_t p : slab.coinciding) coinciding_.push_back(patch_numbers[p] - kFirstPatch);
  shared_ = {};
  for_each_on_plane(slab, slab.last,
                    [&](LatticePoint key, std::uint32_t n) { *shared_.insert(key).first = number(n); });
  crossed_cells_ += slab.crossed_cells;
}

std::vector<JoinedSurface::Patch> JoinedSurface::take_apart() {
  const auto edges = static_cast<std::uint32_t>(edge_points_.size());
  std::vector<bool> is_suspect(count()), is_joined(count());
  for (const std::uint32_t n : std::exchange(suspects_, {})) is_suspect[place(n)] = true;
  for (std::uint32_t p = 0; p < patches_.size(); ++p) is_joined[edges + p] = patches_[p].points != 0;
  for (const std::uint32_t p :
       CoincidingPatches::find(count(), is_suspect, is_joined, [&](const auto& visit) {
         for (const auto& [a, b, c] : triangles_) {
           const Triangle t{place(a), place(b), place(c)};
           for (std::size_t n = 0; n < 3; ++n) {
             if (is_suspect[t[n]]) visit(t, n);
           }
         }
       })) {
    if (is_joined[p]) coinciding_.push_back(p - edges);
  }
  sort_unique(coinciding_);
  std::vector<Patch> result;
  for (const std::uint32_t p : coinciding_) {
    result.push_back(patches_[p]);
    patches_[p].points = 0;
  }
  if (!result.empty()) {
    std::erase_if(triangles_, [&](const Triangle& t) {
      return std::ranges::any_of(
          t, [&](std::uint32_t n) { return n >= kFirstPatch && patches_[n - kFirstPatch].points == 0; });
    });
  }
  coinciding_.clear();
  return result;
}

LatticeMap<std::uint32_t> JoinedSurface::numbers_near(const LatticeMap<bool>& vertices) const {
  LatticeMap<std::uint32_t> numbers;
  const auto in_samples = [this](LatticePoint p) {
    return LatticePoint{p.i / sample_, p.j / sample_, p.k / sample_};
  };
  for (std::uint32_t n = 0; n < edge_points_.size(); ++n) {
    const EdgePoint& p = edge_points_[n];
    if (vertices.find(in_samples(p.nearer_end())) != nullptr)
      *numbers.insert(in_samples(p.first) + in_samples(p.second)).first = n;
  }
  for (std::uint32_t n = 0; n < patches_.size(); ++n) {
    const Patch& p = patches_[n];
    if (p.points != 0 && vertices.find(p.vertex) != nullptr)
      *numbers.insert(point_key(p.vertex, std::countr_zero(p.points))).first = kFirstPatch + n;
  }
  return numbers;
}

void JoinedSurface::add(const SurfaceSlab& more) {
  for (std::size_t n = 0; n < more.edge_points.size(); ++n)
    suspects_.push_back(static_cast<std::uint32_t>(edge_points_.size() + n));
  edge_points_.insert(edge_points_.end(), more.edge_points.begin(), more.edge_points.end());
  edge_positions_.insert(edge_positions_.end(), more.edge_positions.begin(), more.edge_positions.end());
  triangles_.insert(triangles_.end(), more.triangles.begin(), more.triangles.end());
}

Contour JoinedSurface::finish() {
  Contour result;
  const auto edges = static_cast<std::uint32_t>(edge_points_.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(patches_.size());
  std::uint32_t next = edges;
  for (const Patch& patch : patches_) numbers.push_back(patch.points == 0 ? kNone : next++);
  for (Triangle& t : triangles_) {
    for (std::uint32_t& n : t) n = n < kFirstPatch ? n : numbers[n - kFirstPatch];
  }
  result.triangles = std::move(triangles_);
  result.edge_points = std::move(edge_points_);
  result.points = std::move(edge_positions_);
  reserve_in_large_pages(result.points, next);
  reserve_in_large_pages(result.vertex_points, next - edges);
  for (const Patch& patch : patches_) {
    if (patch.points == 0) continue;
    result.points.push_back(patch.position);
    result.vertex_points.push_back({sample_ * patch.vertex, sample_});
  }
  patches_ = {};
  return result;
}

}  // namespace adamas
