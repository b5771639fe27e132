#include "interfaces/network/bodies.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "interfaces/network/body_rays.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

std::uint32_t side_index(std::uint32_t triangle, int side) {
  return 2 * triangle + static_cast<std::uint32_t>(side);
}

MaterialId side_material(const InterfaceMesh& mesh, std::uint32_t side) {
  const InterfaceTriangle& t = mesh.triangles[side / 2];
  return side % 2 == 0 ? t.front : t.back;
}

/// Triangles in which two points coincide bound nothing.
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
    fans.fan(edge, fan);
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

/// The sides of each connected part, for the materials that have more than one of them.
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

/// Joins parts that see each other through their region. Returns the number of inconsistent rays.
std::size_t join_by_rays(const InterfaceMesh& mesh, const std::vector<char>& collapsed, const Box3* domain,
                         DisjointSets& sets) {
  const auto parts = parts_to_join(mesh, collapsed, sets);
  if (parts.empty()) return 0;
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  const ClosestPointTree tree(mesh.points, triangles);
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

/// Parts without volume, which lie between triangles without area, are joined to a part of the same material
/// that they touch.
void join_flat_parts(const InterfaceMesh& mesh, const EdgeFans& fans, const std::vector<char>& collapsed,
                     DisjointSets& sets) {
  const auto count = static_cast<std::uint32_t>(2 * mesh.triangles.size());
  std::vector<char> solid(count, 0);  // of roots: has a triangle with an area
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
  Bodies bodies;
  DisjointSets sets(2 * mesh.triangles.size());
  const EdgeFans fans(mesh, domain);
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
