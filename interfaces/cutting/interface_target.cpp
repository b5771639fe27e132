#include "interfaces/cutting/interface_target.h"

#include <algorithm>

#include "core/base/hash.h"
#include "interfaces/cutting/bisected_cells.h"

namespace adamas::interfaces {

namespace {

using BodySet = std::vector<std::uint32_t>;

void add_unique(BodySet& list, std::uint32_t body) {
  const auto place = std::lower_bound(list.begin(), list.end(), body);
  if (place == list.end() || *place != body) list.insert(place, body);
}

}  // namespace

InterfaceTarget::InterfaceTarget(const ExtractedInterfaces& interfaces, double tolerance)
    : tolerance_(tolerance) {
  const auto& points = interfaces.mesh.points;
  std::vector<ClosestPointTree::Triangle> triangles;
  std::vector<BodySet> at_point(points.size());
  std::map<std::uint64_t, BodySet> at_edge;
  for (std::size_t t = 0; t < interfaces.bodies.size(); ++t) {
    const auto& corners = interfaces.mesh.triangles[t].points;
    triangles.push_back(corners);
    BodySet pair;
    for (const BodyId body : interfaces.bodies[t]) add_unique(pair, body.value);
    parts_[pair].triangles.push_back(corners);
    for (const std::uint32_t body : pair) boundaries_[body].triangles.push_back(corners);
    for (std::size_t i = 0; i < 3; ++i) {
      for (const std::uint32_t body : pair) {
        add_unique(at_point[corners[i]], body);
        add_unique(at_edge[edge_key(corners[i], corners[(i + 1) % 3])], body);
      }
    }
  }
  // Lines and points are stored as triangles whose last corners coincide.
  for (const auto& [key, bodies] : at_edge) {
    const auto a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
    if (bodies.size() >= 3) parts_[bodies].triangles.push_back({a, b, b});
  }
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (at_point[p].size() >= 4) parts_[at_point[p]].triangles.push_back({p, p, p});
  }
  for (auto& [bodies, part] : parts_) part.tree = ClosestPointTree(points, part.triangles);
  for (auto& [body, boundary] : boundaries_) boundary.tree = ClosestPointTree(points, boundary.triangles);
  all_ = ClosestPointTree(points, triangles);
}

std::optional<Vec3> InterfaceTarget::closest(const LabelledMesh::Sides& sides, const Vec3& p,
                                             double within) const {
  const std::size_t bodies = sides.bodies();
  const auto found =
      parts_.find(BodySet(sides.values.begin(), sides.values.begin() + static_cast<std::ptrdiff_t>(bodies)));
  // A contact that the interfaces do not have, for example in a corner of a cell, may be at any of them.
  const ClosestPointTree& tree = found == parts_.end() ? all_ : found->second.tree;
  const auto hit = tree.closest(p, within);
  if (!hit) return std::nullopt;
  return hit->point;
}

bool InterfaceTarget::allows(const LabelledMesh::Sides& sides, const Vec3& p, bool is_misplaced) const {
  if (sides.bodies() < 2) return true;
  if (is_misplaced) return all_.closest(p, tolerance_).has_value();
  if (closest(sides, p, tolerance_)) return true;
  if (sides.bodies() > 2) return false;
  // If a third body between the two is thinner than the tolerance, each is still where it should be.
  return std::all_of(sides.values.begin(), sides.values.begin() + 2, [&](std::uint32_t body) {
    const auto found = boundaries_.find(body);
    return found != boundaries_.end() && found->second.tree.is_within(p, tolerance_);
  });
}

}  // namespace adamas::interfaces
