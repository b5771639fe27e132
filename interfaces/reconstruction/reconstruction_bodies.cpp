// How the parts of materials' regions are joined to bodies.

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/data/contact_mesh.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas::interfaces {

void Reconstruction::join_points() {
  parent_.resize(lattice_.point_count());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (std::uint32_t k = 0; k < lattice_.points(2); ++k) {
    LoopProgress::check();
    for (std::uint32_t j = 0; j < lattice_.points(1); ++j) {
      for (std::uint32_t i = 0; i < lattice_.points(0); ++i) {
        const std::uint32_t p = lattice_.point_index({i, j, k});
        for (std::uint32_t d = 1; d < 8; ++d) {
          const MaterialLattice::Index other{i + (d & 1u), j + (d >> 1 & 1u), k + (d >> 2)};
          if (other[0] >= lattice_.points(0) || other[1] >= lattice_.points(1) ||
              other[2] >= lattice_.points(2))
            continue;
          const std::uint32_t q = lattice_.point_index(other);
          if (parent_[p] != parent_[q] && lattice_.is_one_region(lattice_.owner(p), lattice_.owner(q)))
            join(p, q);
        }
      }
    }
  }
}

/// Inner parts that no triangle touches own nothing and are dropped. Triangles with one material on both
/// sides, which welding leaves where it closed what lay between, are dropped as well, and join the parts on
/// their sides.
void Reconstruction::settle_parts(InterfaceMesh& mesh) {
  LoopProgress::check();
  std::vector<Part> seen;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const Part part : {t.front.value, t.back.value}) {
      if (is_inner(part)) seen.push_back(part);
    }
  }
  std::sort(seen.begin(), seen.end());
  std::sort(inner_parts_.begin(), inner_parts_.end());
  inner_parts_.erase(std::unique(inner_parts_.begin(), inner_parts_.end()), inner_parts_.end());
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

MaterialId Reconstruction::material_of(Part part) const {
  if (!is_inner(part)) return lattice_.material(lattice_.owner(part));
  return std::lower_bound(inner_parts_.begin(), inner_parts_.end(), std::pair{part, MaterialId(0)})->second;
}

/// Edges, by their points, round which parts of one material may meet that are not yet one: where there is an
/// inner part, or the boundary of a part is open.
std::vector<std::uint64_t> Reconstruction::loose_edges(const InterfaceMesh& mesh) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>>
      all;  // edges with the triangle, and the side they are of
  all.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    for (std::uint32_t i = 0; i < 3; ++i) all.emplace_back(edge_key(p[i], p[(i + 1) % 3]), 3 * t + i);
  }
  LoopProgress::check();
  std::sort(all.begin(), all.end());
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
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    LoopProgress::check_step(edges++);
    balance.clear();
    bool has_inner = false;
    for (; last < all.size() && all[last].first == all[first].first; ++last) {
      const InterfaceTriangle& t = mesh.triangles[all[last].second / 3];
      const std::uint32_t i = all[last].second % 3;
      const int way = t.points[i] < t.points[(i + 1) % 3] ? 1 : -1;
      count(t.front.value, way);
      count(t.back.value, -way);
      has_inner = has_inner || is_inner(t.front.value) || is_inner(t.back.value);
    }
    const bool open =
        std::any_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; });
    if (has_inner || open) loose.push_back(all[first].first);
  }
  return loose;
}

/// Joins parts of one material that meet round an edge, with nothing between them.
void Reconstruction::join_round_edges(const InterfaceMesh& mesh, const Box3& domain) {
  const std::vector<std::uint64_t> edges = loose_edges(mesh);
  if (edges.empty()) return;
  // The triangles at those edges, with points of their own.
  InterfaceMesh near;
  std::vector<std::array<Part, 2>> parts;
  std::vector<std::uint32_t> original;
  std::unordered_map<std::uint32_t, std::uint32_t> renumbered;
  std::size_t step = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    LoopProgress::check_step(step++);
    bool touches = false;
    for (std::size_t i = 0; i < 3 && !touches; ++i)
      touches = std::binary_search(edges.begin(), edges.end(), edge_key(t.points[i], t.points[(i + 1) % 3]));
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
    fans.fan(edge, fan);
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

Reconstruction::Part Reconstruction::find(Part part) {
  const auto parent = [&](Part p) -> Part& { return p < parent_.size() ? parent_[p] : inner_parents_.at(p); };
  while (parent(part) != part) {
    parent(part) = parent(parent(part));
    part = parent(part);
  }
  return part;
}

void Reconstruction::join(Part a, Part b) {
  a = find(a), b = find(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  (b < parent_.size() ? parent_[b] : inner_parents_.at(b)) = a;
}

void Reconstruction::number_bodies() {
  body_materials_ = {};
  body_of_inner_part_.clear();
  body_of_point_.resize(lattice_.point_count());
  for (Part p = 0; p < lattice_.point_count(); ++p) {
    const Part root = find(p);
    if (root == p) {
      body_of_point_[p] = body_materials_.next_id();
      body_materials_.push_back(lattice_.material(lattice_.owner(p)));
    } else {
      body_of_point_[p] = body_of_point_[root];
    }
  }
  for (const auto& [part, material] : inner_parts_) {
    const Part root = find(part);
    if (root < body_of_point_.size()) {
      body_of_inner_part_[part] = body_of_point_[root];
    } else if (root == part) {
      body_of_inner_part_[part] = body_materials_.next_id();
      body_materials_.push_back(material);
    } else {
      body_of_inner_part_[part] = body_of_inner_part_.at(root);
    }
  }
  inner_parts_ = {};
  parent_ = {};
  inner_parents_ = {};
}

BodyId Reconstruction::body_at(const Vec3& p) const {
  const auto location = lattice_.locate(p);
  const auto corners = lattice_.tetrahedron(location.cell, location.path);
  std::array<std::uint32_t, 4> points{};
  for (std::size_t c = 0; c < 4; ++c) points[c] = lattice_.point_index(corners[c]);
  if (lattice_.have_one_owner(points)) return body_of_point_[points[0]];
  OwnershipProblem problem;
  lattice_.ownership(points, problem);
  const std::uint32_t owner = problem.owner(location.weights);
  keep_owners(problem);
  const Part part = part_in(location.cell, location.path, points, problem.candidates, owner);
  if (part < body_of_point_.size()) return body_of_point_[part];
  const auto found = body_of_inner_part_.find(part);
  return found != body_of_inner_part_.end() ? found->second : body_of_point_[points[0]];
}

}  // namespace adamas::interfaces
