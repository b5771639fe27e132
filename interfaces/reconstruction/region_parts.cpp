#include "interfaces/reconstruction/region_parts.h"

#include <algorithm>

#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/data/contact_mesh.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

void RegionParts::settle(InterfaceMesh& mesh) {
  LoopProgress::check();
  std::vector<Part> seen;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const Part part : {t.front.value, t.back.value}) {
      if (is_inner(part)) seen.push_back(part);
    }
  }
  std::sort(seen.begin(), seen.end());
  sort_unique(inner_parts_);
  std::erase_if(inner_parts_, [&](const auto& entry) {
    return !std::binary_search(seen.begin(), seen.end(), entry.first);
  });
  LoopProgress::check();
  for (const auto& [part, material] : inner_parts_) inner_parents_.emplace(part, part);
  std::erase_if(mesh.triangles, [&](const InterfaceTriangle& t) {
    if (material_of(t.front.value) != material_of(t.back.value)) return false;
    join(t.front.value, t.back.value);
    return true;
  });
}

MaterialId RegionParts::material_of(Part part) const {
  if (!is_inner(part)) return material_of_(part);
  return std::lower_bound(inner_parts_.begin(), inner_parts_.end(), std::pair{part, MaterialId(0)})->second;
}

/// Returns the keys of edges at which parts of one material may meet that are not yet joined: those with an
/// inner part, or where the boundary of a part is open.
std::vector<std::uint64_t> RegionParts::loose_edges(const InterfaceMesh& mesh) {
  // The sides of triangles by the lower ends of their edges; a side is three times the triangle's number plus
  // that of its first corner.
  const auto edge_of = [&](std::uint32_t side) {
    const auto& p = mesh.triangles[side / 3].points;
    const std::uint32_t a = p[side % 3], b = p[(side + 1) % 3];
    return std::pair(std::min(a, b), std::max(a, b));
  };
  const auto sides = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  std::vector<std::uint32_t> first_of(mesh.points.size() + 2, 0), by_end(sides);
  for (std::uint32_t side = 0; side < sides; ++side) ++first_of[edge_of(side).first + 2];
  for (std::size_t p = 2; p < first_of.size(); ++p) first_of[p] += first_of[p - 1];
  LoopProgress::check();
  for (std::uint32_t side = 0; side < sides; ++side) by_end[first_of[edge_of(side).first + 1]++] = side;
  LoopProgress::check();
  std::vector<std::uint64_t> loose;
  std::size_t edges = 0;
  std::vector<std::pair<Part, int>> balance;
  const auto count = [&](Part part, int times) {
    const Part root = find(part);
    const auto found =
        std::find_if(balance.begin(), balance.end(), [&](const auto& entry) { return entry.first == root; });
    if (found == balance.end()) {
      balance.emplace_back(root, times);
    } else {
      found->second += times;
    }
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      round;  // the higher ends of a point's edges, with sides
  for (std::uint32_t point = 0; point < mesh.points.size(); ++point) {
    round.clear();
    for (std::uint32_t n = first_of[point]; n < first_of[point + 1]; ++n)
      round.emplace_back(edge_of(by_end[n]).second, by_end[n]);
    std::sort(round.begin(), round.end());
    for (std::size_t first = 0, last = 0; first < round.size(); first = last) {
      LoopProgress::check_step(edges++);
      balance.clear();
      bool has_inner = false;
      for (; last < round.size() && round[last].first == round[first].first; ++last) {
        const InterfaceTriangle& t = mesh.triangles[round[last].second / 3];
        const int way = t.points[round[last].second % 3] == point ? 1 : -1;
        count(t.front.value, way);
        count(t.back.value, -way);
        has_inner = has_inner || is_inner(t.front.value) || is_inner(t.back.value);
      }
      const bool open =
          std::any_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; });
      if (has_inner || open) loose.push_back(edge_key(point, round[first].first));
    }
  }
  return loose;
}

void RegionParts::join_round_edges(const InterfaceMesh& mesh, const Box3& domain) {
  const std::vector<std::uint64_t> edges = loose_edges(mesh);
  if (edges.empty()) return;
  // These are the triangles at those edges, with points numbered anew.
  InterfaceMesh near;
  std::vector<std::array<Part, 2>> parts;
  std::vector<std::uint32_t> original;
  std::unordered_map<std::uint32_t, std::uint32_t> renumbered;
  std::vector<char> is_low_end(mesh.points.size(), 0);
  for (const std::uint64_t edge : edges) is_low_end[edge >> 32] = 1;
  std::size_t step = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    LoopProgress::check_step(step++);
    bool touches = false;
    for (std::size_t i = 0; i < 3 && !touches; ++i) {
      const std::uint64_t edge = edge_key(t.points[i], t.points[(i + 1) % 3]);
      touches = is_low_end[edge >> 32] != 0 && std::binary_search(edges.begin(), edges.end(), edge);
    }
    if (!touches) continue;
    std::array<std::uint32_t, 3> points{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, fresh] =
          renumbered.try_emplace(t.points[i], static_cast<std::uint32_t>(original.size()));
      if (fresh) {
        original.push_back(t.points[i]);
        near.points.push_back(mesh.points[t.points[i]]);
      }
      points[i] = at->second;
    }
    near.triangles.push_back({points, material_of(t.front.value), material_of(t.back.value)});
    parts.push_back({t.front.value, t.back.value});
  }
  const EdgeFans fans(near, &domain, kWeldTolerance);
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    LoopProgress::check_step(edge);
    const auto [low, high] = fans.ends(edge);
    if (!std::binary_search(edges.begin(), edges.end(), edge_key(original[low], original[high]))) continue;
    fans.wedges(edge, fan);
    const std::size_t count = fan.blades.size();
    for (std::size_t i = 0; i < count && count > 1; ++i) {
      if (i == fan.outside_wedge) continue;
      const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % count];
      const auto ahead = static_cast<std::size_t>(EdgeFans::side_ahead(a)),
                 behind = static_cast<std::size_t>(EdgeFans::side_behind(b));
      if (fans.material(a.triangle, EdgeFans::side_ahead(a)) ==
          fans.material(b.triangle, EdgeFans::side_behind(b)))
        join(parts[a.triangle][ahead], parts[b.triangle][behind]);
    }
  }
}

RegionParts::Part RegionParts::find(Part part) {
  const auto parent = [&](Part p) -> Part& { return p < parent_.size() ? parent_[p] : inner_parents_.at(p); };
  while (parent(part) != part) {
    parent(part) = parent(parent(part));
    part = parent(part);
  }
  return part;
}

void RegionParts::join(Part a, Part b) {
  a = find(a), b = find(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  (b < parent_.size() ? parent_[b] : inner_parents_.at(b)) = a;
}

RegionParts::Bodies RegionParts::bodies() {
  Bodies result;
  result.of_part.resize(parent_.size());
  for (Part p = 0; p < parent_.size(); ++p) {
    const Part root = find(p);
    if (root == p) {
      result.of_part[p] = result.materials.next_id();
      result.materials.push_back(material_of(p));
    } else {
      result.of_part[p] = result.of_part[root];
    }
  }
  for (const auto& [part, material] : inner_parts_) {
    const Part root = find(part);
    if (root < result.of_part.size()) {
      result.of_inner_part[part] = result.of_part[root];
    } else if (root == part) {
      result.of_inner_part[part] = result.materials.next_id();
      result.materials.push_back(material);
    } else {
      result.of_inner_part[part] = result.of_inner_part.at(root);
    }
  }
  return result;
}

std::vector<std::array<BodyId, 2>> RegionParts::Bodies::name_sides(
    std::vector<InterfaceTriangle>& triangles) const {
  std::vector<std::array<BodyId, 2>> bodies(triangles.size());
  parallel_for(triangles.size(), 1 << 14, [&](std::size_t n) {
    InterfaceTriangle& t = triangles[n];
    bodies[n] = {of(t.front.value), of(t.back.value)};
    t.front = materials[bodies[n][0]];
    t.back = materials[bodies[n][1]];
  });
  return bodies;
}

void drop_unused_points(InterfaceMesh& mesh) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused);
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const std::uint32_t p : t.points) number[p] = 0;
  }
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == kUnused) continue;
    mesh.points[count] = mesh.points[p];
    number[p] = count++;
  }
  mesh.points.resize(count);
  for (InterfaceTriangle& t : mesh.triangles) {
    for (std::uint32_t& p : t.points) p = number[p];
  }
}

}  // namespace adamas::interfaces
