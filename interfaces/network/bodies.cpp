#include "interfaces/network/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/disjoint_sets.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_forest.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

constexpr int kRandomRays = 24;
constexpr double kCleanWeight = 1e-7;  // hits closer to an edge, or at smaller angles, do not count
constexpr double kCleanAngle = 1e-6;

/// Returns a random number in [0, 1).
double next_random(std::uint64_t& state) {
  return static_cast<double>(next_splitmix64(state) >> 11) * 0x1p-53;
}

Vec3 random_direction(std::uint64_t& state) {
  const double z = 2 * next_random(state) - 1;
  const double angle = 2 * M_PI * next_random(state);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Returns the parameter at which a ray from inside leaves a box.
double exit_of(const Box3& box, const Vec3& origin, const Vec3& direction) {
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? box.max[axis] : box.min[axis];
    leave = std::min(leave, std::max(0.0, (wall - origin[axis]) / direction[axis]));
  }
  return leave;
}

/// Moves a point a little into the box, so that rays cannot miss, by round-off, the ends of interfaces at its
/// boundary.
Vec3 pulled_inside(const Box3& box, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    const double pull = 1e-9 * box.size()[axis];
    p[axis] = std::clamp(p[axis], box.min[axis] + pull, box.max[axis] - pull);
  }
  return p;
}

/// Finds which connected parts of a region's boundary see each other through the region. A *side* is twice
/// the number of a triangle, plus 1 for its back.
class BodyRays {
 public:
  static constexpr std::uint32_t kInfinity = 0xffffffffu;
  struct Result {
    std::vector<std::uint32_t> seen;  ///< the sides of the same material that are seen; kInfinity for rays
                                      ///< that reach infinity
    std::size_t inconsistent = 0;     ///< the number of rays that arrived at a side of another material
  };

  /// The arguments must outlive this object; `domain` may be null.
  BodyRays(const InterfaceMesh& mesh, const ClosestPointTree& tree, const Box3* domain)
      : mesh_(mesh), tree_(tree), domain_(domain) {}
  /// Sends rays from a part, which is given by its sides.
  [[nodiscard]] Result shoot(const std::vector<std::uint32_t>& part) const;

 private:
  [[nodiscard]] MaterialId material(std::uint32_t side) const {
    const InterfaceTriangle& t = mesh_.triangles[side / 2];
    return side % 2 == 0 ? t.front : t.back;
  }
  [[nodiscard]] Vec3 normal(std::uint32_t side) const;
  [[nodiscard]] Vec3 corner(std::uint32_t side, std::size_t i) const {
    return mesh_.points[mesh_.triangles[side / 2].points[i]];
  }
  [[nodiscard]] bool flat(std::uint32_t side) const {
    return is_flat({corner(side, 0), corner(side, 1), corner(side, 2)});
  }
  void shoot_from_extremes(const std::vector<std::uint32_t>& part, Result& result) const;
  /// Follows a ray from a side. If it leaves the domain, it continues along the domain's faces to the
  /// greatest corner, which counts as infinity.
  void follow(std::uint32_t side, Vec3 origin, Vec3 direction, Result& result) const;
  void arrive(std::uint32_t side, const Vec3& direction, const RayHit& hit, Result& result) const;

  const InterfaceMesh& mesh_;
  const ClosestPointTree& tree_;
  const Box3* domain_;
};

Vec3 BodyRays::normal(std::uint32_t side) const {
  const Vec3 n = normalized(cross(corner(side, 1) - corner(side, 0), corner(side, 2) - corner(side, 0)));
  return side % 2 == 0 ? n : -n;
}

BodyRays::Result BodyRays::shoot(const std::vector<std::uint32_t>& part) const {
  Result result;
  shoot_from_extremes(part, result);
  std::uint64_t random = part.front();
  for (int ray = 0; ray < kRandomRays; ++ray) {
    const auto pick = static_cast<std::size_t>(next_random(random) * static_cast<double>(part.size()));
    const std::uint32_t side = part[std::min(pick, part.size() - 1)];
    const double a = 0.05 + 0.9 * next_random(random), b = 0.05 + 0.9 * next_random(random);
    const double u = std::min(a, b), v = std::abs(a - b);
    const Vec3 origin = u * corner(side, 0) + v * corner(side, 1) + (1 - u - v) * corner(side, 2);
    Vec3 direction = random_direction(random);
    if (dot(direction, normal(side)) < 0) direction = -direction;
    follow(side, origin, direction, result);
  }
  sort_unique(result.seen);
  return result;
}

void BodyRays::shoot_from_extremes(const std::vector<std::uint32_t>& part, Result& result) const {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Vec3 direction;
      direction[axis] = sign;
      // Among equally far corners, as on a face of the domain, the one farthest along the ray's further way
      // is taken.
      std::array<double, 3> farthest{};
      std::uint32_t best = kInfinity;
      std::size_t best_corner = 0;
      for (const std::uint32_t side : part) {
        if (dot(normal(side), direction) < 1e-3) continue;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vec3 p = corner(side, i);
          const std::array<double, 3> reach{sign * p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
          if (best == kInfinity || reach > farthest) farthest = reach, best = side, best_corner = i;
        }
      }
      if (best == kInfinity) continue;
      const Vec3 middle = (1.0 / 3) * (corner(best, 0) + corner(best, 1) + corner(best, 2));
      follow(best, 0.95 * corner(best, best_corner) + 0.05 * middle, direction, result);
    }
  }
}

void BodyRays::follow(std::uint32_t side, Vec3 origin, Vec3 direction, Result& result) const {
  if (domain_ != nullptr && !domain_->contains(origin)) return;
  if (flat(side) || std::abs(dot(normal(side), direction)) < kCleanAngle) return;
  const double leave =
      domain_ == nullptr ? std::numeric_limits<double>::infinity() : exit_of(*domain_, origin, direction);
  if (const auto hit = tree_.first_hit(origin, direction, leave, side / 2))
    return arrive(side, direction, *hit, result);
  if (domain_ != nullptr) {
    origin = pulled_inside(*domain_, origin + leave * direction);
    const Vec3 last = pulled_inside(*domain_, domain_->max);
    for (int axis = 0; axis < 3; ++axis) {
      direction = {};
      direction[axis] = 1;
      if (!(origin[axis] < last[axis])) continue;
      const auto hit =
          tree_.first_hit(origin, direction, last[axis] - origin[axis], ClosestPointTree::kNoTriangle);
      if (hit) return arrive(side, direction, *hit, result);
      origin[axis] = last[axis];
    }
  }
  result.seen.push_back(kInfinity);
}

void BodyRays::arrive(std::uint32_t side, const Vec3& direction, const RayHit& hit, Result& result) const {
  const auto& w = hit.weights;
  const double facing = dot(normal(2 * hit.triangle), direction);
  const bool clean = std::min({w[0], w[1], w[2]}) >= kCleanWeight && std::abs(facing) >= kCleanAngle;
  if (!clean || flat(2 * hit.triangle)) return;
  const std::uint32_t seen = 2 * hit.triangle + (facing < 0 ? 0 : 1);
  if (material(seen) == material(side)) {
    result.seen.push_back(seen);
  } else {
    ++result.inconsistent;
  }
}

std::uint32_t side_index(std::uint32_t triangle, int side) {
  return 2 * triangle + static_cast<std::uint32_t>(side);
}

MaterialId side_material(const InterfaceMesh& mesh, std::uint32_t side) {
  const InterfaceTriangle& t = mesh.triangles[side / 2];
  return side % 2 == 0 ? t.front : t.back;
}

/// Marks triangles in which two points coincide: they bound nothing.
std::vector<char> find_collapsed(const InterfaceMesh& mesh, const EdgeFans& fans) {
  std::vector<char> collapsed(mesh.triangles.size());
  for (std::size_t t = 0; t < collapsed.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    const std::uint32_t a = fans.welded(p[0]), b = fans.welded(p[1]), c = fans.welded(p[2]);
    collapsed[t] = a == b || b == c || c == a;
  }
  return collapsed;
}

/// Joins sides that face the same wedge. Returns the number of edges whose materials do not match.
std::size_t join_round_edges(const EdgeFans& fans, DisjointSets& sets) {
  std::size_t inconsistent = 0;
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    fans.wedges(edge, fan);
    if (!fan.consistent) ++inconsistent;
    const std::size_t n = fan.blades.size();
    if (n == 1) continue;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == fan.outside_wedge) continue;
      const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % n];
      const int ahead = EdgeFans::side_ahead(a), behind = EdgeFans::side_behind(b);
      if (fans.material(a.triangle, ahead) != fans.material(b.triangle, behind)) continue;
      sets.join(side_index(a.triangle, ahead), side_index(b.triangle, behind));
    }
  }
  return inconsistent;
}

/// Returns the sides of each connected part, for materials with more than one part.
std::vector<std::vector<std::uint32_t>> parts_to_join(const InterfaceMesh& mesh,
                                                      const std::vector<char>& collapsed,
                                                      DisjointSets& sets) {
  const auto count = static_cast<std::uint32_t>(2 * mesh.triangles.size());
  IdVector<MaterialId, std::size_t> parts_of(mesh.materials.size(), 0);
  for (std::uint32_t side = 0; side < count; ++side) {
    if (sets.find(side) == side && collapsed[side / 2] == 0) ++parts_of[side_material(mesh, side)];
  }
  std::vector<std::uint32_t> part_of(count, 0);
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::uint32_t side = 0; side < count; ++side) {
    if (collapsed[side / 2] != 0 || parts_of[side_material(mesh, side)] < 2) continue;
    const std::uint32_t root = sets.find(side);
    if (root == side) {
      part_of[root] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[part_of[root]].push_back(side);
  }
  return parts;
}

ClosestPointTree tree_of(const InterfaceMesh& mesh) {
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  return ClosestPointForest(mesh.points, std::move(triangles)).all();
}

/// Joins parts that see each other through their region. Returns the number of inconsistent rays.
std::size_t join_by_rays(const InterfaceMesh& mesh, const std::vector<char>& collapsed, const Box3* domain,
                         DisjointSets& sets) {
  const auto parts = parts_to_join(mesh, collapsed, sets);
  if (parts.empty()) return 0;
  const ClosestPointTree tree = tree_of(mesh);
  const BodyRays rays(mesh, tree, domain);
  std::vector<BodyRays::Result> results(parts.size());
  parallel_for(parts.size(), 1, [&](std::size_t i) { results[i] = rays.shoot(parts[i]); });

  std::size_t inconsistent = 0;
  IdVector<MaterialId, std::uint32_t> reaches_infinity(mesh.materials.size(), BodyRays::kInfinity);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    inconsistent += results[i].inconsistent;
    for (const std::uint32_t seen : results[i].seen) {
      if (seen != BodyRays::kInfinity) {
        sets.join(parts[i].front(), seen);
        continue;
      }
      std::uint32_t& first = reaches_infinity[side_material(mesh, parts[i].front())];
      if (first == BodyRays::kInfinity) first = parts[i].front();
      sets.join(first, parts[i].front());
    }
  }
  return inconsistent;
}

/// Joins parts without volume, which lie between triangles without area, to a part of the same material that
/// they touch.
void join_flat_parts(const InterfaceMesh& mesh, const EdgeFans& fans, const std::vector<char>& collapsed,
                     DisjointSets& sets) {
  const auto count = static_cast<std::uint32_t>(2 * mesh.triangles.size());
  std::vector<char> solid(count, 0);  // 1 for a root whose part has a triangle with an area
  for (std::uint32_t side = 0; side < count; ++side) {
    const auto& p = mesh.triangles[side / 2].points;
    if (!is_flat({mesh.points[p[0]], mesh.points[p[1]], mesh.points[p[2]]})) solid[sets.find(side)] = 1;
  }
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> flat_sides;
  const auto for_each_point = [&](std::uint32_t side, const auto& visit) {
    for (const std::uint32_t p : mesh.triangles[side / 2].points) visit(fans.welded(p));
  };
  for (std::uint32_t side = 0; side < count; ++side) {
    if (collapsed[side / 2] != 0 || solid[sets.find(side)] != 0) continue;
    for_each_point(side, [&](std::uint32_t p) { flat_sides[p].push_back(side); });
  }
  if (flat_sides.empty()) return;
  std::vector<char> joined(count, 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joins;
  for (std::uint32_t side = 0; side < count; ++side) {
    if (collapsed[side / 2] != 0 || solid[sets.find(side)] == 0) continue;
    for_each_point(side, [&](std::uint32_t p) {
      const auto at = flat_sides.find(p);
      if (at == flat_sides.end()) return;
      for (const std::uint32_t flat : at->second) {
        const std::uint32_t root = sets.find(flat);
        if (joined[root] != 0 || side_material(mesh, flat) != side_material(mesh, side)) continue;
        joined[root] = 1;
        joins.emplace_back(flat, side);
      }
    });
  }
  for (const auto& [flat, side] : joins) sets.join(flat, side);
}

}  // namespace

Bodies find_bodies(const InterfaceMesh& mesh, const Box3* domain) {
  return find_bodies(mesh, EdgeFans(mesh, domain), domain);
}

Bodies find_bodies(const InterfaceMesh& mesh, const EdgeFans& fans, const Box3* domain) {
  Bodies bodies;
  DisjointSets sets(2 * mesh.triangles.size());
  const std::vector<char> collapsed = find_collapsed(mesh, fans);
  bodies.inconsistent_edges = join_round_edges(fans, sets);
  join_flat_parts(mesh, fans, collapsed, sets);
  bodies.inconsistent_rays = join_by_rays(mesh, collapsed, domain, sets);

  std::vector<std::uint32_t> roots;
  const auto count = static_cast<std::uint32_t>(2 * mesh.triangles.size());
  for (std::uint32_t side = 0; side < count; ++side) {
    if (collapsed[side / 2] == 0 && sets.find(side) == side) roots.push_back(side);
  }
  std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) {
    return side_material(mesh, a) < side_material(mesh, b);
  });
  std::vector<BodyId> body_of(count);
  for (const std::uint32_t root : roots) {
    body_of[root] = bodies.materials.next_id();
    bodies.materials.push_back(side_material(mesh, root));
  }
  bodies.sides.resize(mesh.triangles.size());
  for (std::uint32_t side = 0; side < count; ++side)
    bodies.sides[side / 2][side % 2] = body_of[sets.find(side)];
  return bodies;
}

}  // namespace adamas::interfaces
