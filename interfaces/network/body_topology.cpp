#include "interfaces/network/body_topology.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/network/bodies.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

/// Returns the number of a corner of a side of a triangle; both sides have three.
std::uint32_t corner_index(std::uint32_t triangle, int side, std::size_t corner) {
  return 6 * triangle + 3 * static_cast<std::uint32_t>(side) + static_cast<std::uint32_t>(corner);
}

/// Counts faces, edges and points of bodies' boundaries.
class EulerCounter {
 public:
  /// Triangles count with their first corner, and edges with their lower end. `counts`: by point, whether
  /// what belongs to it is counted; all triangles round these points must be there.
  EulerCounter(const InterfaceMesh& mesh, const EdgeFans& fans, std::vector<char> counts)
      : mesh_(mesh), fans_(fans), counts_(std::move(counts)), corners_(6 * mesh.triangles.size()) {}

  /// Calls add(body, number) with parts of the Euler characteristics.
  template <class Add>
  void count(Add&& add) {
    const auto body = [&](std::uint32_t triangle, int side) {
      return BodyId(fans_.material(triangle, side).value);
    };
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (counts_at(t, 0)) add(body(t, 0), 1), add(body(t, 1), 1);
    }
    EdgeFans::Fan fan;
    for (std::size_t edge = 0; edge < fans_.size(); ++edge) {
      const auto [low, high] = fans_.ends(edge);
      if (counts_[low] == 0 && counts_[high] == 0) continue;
      fans_.wedges(edge, fan);
      join_corners(edge, fan);
      if (counts_[low] != 0) count_edge(fan, [&](std::uint32_t t, int side) { add(body(t, side), -1); });
    }
    for (std::uint32_t c = 0; c < 6 * mesh_.triangles.size(); ++c) {
      if (counts_at(c / 6, c % 3) && corners_.find(c) == c) add(body(c / 6, static_cast<int>(c % 6 / 3)), 1);
    }
  }

 private:
  [[nodiscard]] bool counts_at(std::uint32_t triangle, std::size_t corner) const {
    return counts_[fans_.welded(mesh_.triangles[triangle].points[corner])] != 0;
  }

  /// Calls visit(blade, next blade, whether the wedge between them is one of a single body) round an edge.
  template <class Visit>
  void for_each_wedge(const EdgeFans::Fan& fan, Visit&& visit) const {
    const std::size_t n = fan.blades.size();
    if (!fan.consistent && fan.outside_wedge == EdgeFans::Fan::kNone && visit_wedges_of_pairs(fan, visit))
      return;
    for (std::size_t i = 0; i < n; ++i) {
      const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % n];
      visit(a, b, n > 1 && i != fan.outside_wedge && ahead(a) == behind(b));
    }
  }

  [[nodiscard]] MaterialId ahead(const Blade& b) const {
    return fans_.material(b.triangle, EdgeFans::side_ahead(b));
  }
  [[nodiscard]] MaterialId behind(const Blade& b) const {
    return fans_.material(b.triangle, EdgeFans::side_behind(b));
  }

  /// Does the same by the bodies alone where each has just two sides at the edge, which must bound one wedge:
  /// angles of triangles that are all but flat may be wrong. Returns false, without a visit, elsewhere.
  template <class Visit>
  bool visit_wedges_of_pairs(const EdgeFans::Fan& fan, Visit&& visit) const {
    const auto& blades = fan.blades;
    for (const Blade& a : blades) {
      const auto is_behind = [&](const Blade& b) { return behind(b) == ahead(a); };
      const auto is_ahead = [&](const Blade& b) { return ahead(b) == ahead(a); };
      if (std::ranges::count_if(blades, is_behind) != 1 || std::ranges::count_if(blades, is_ahead) != 1)
        return false;
    }
    for (const Blade& a : blades)
      visit(a, *std::ranges::find_if(blades, [&](const Blade& b) { return behind(b) == ahead(a); }), true);
    return true;
  }

  /// Joins the corners of triangles that bound the same wedge.
  void join_corners(std::size_t edge, const EdgeFans::Fan& fan) {
    for_each_wedge(fan, [&](const Blade& a, const Blade& b, bool of_one_body) {
      if (!of_one_body) return;
      for (const std::uint32_t end : fans_.ends(edge))
        corners_.join(corner_index(a.triangle, EdgeFans::side_ahead(a), corner_at(a.triangle, end)),
                      corner_index(b.triangle, EdgeFans::side_behind(b), corner_at(b.triangle, end)));
    });
  }

  /// Visits one side for each wedge of one body between two sides, and each side without a neighbour.
  template <class Visit>
  void count_edge(const EdgeFans::Fan& fan, Visit&& visit) const {
    for_each_wedge(fan, [&](const Blade& a, const Blade& b, bool of_one_body) {
      visit(a.triangle, EdgeFans::side_ahead(a));
      if (!of_one_body) visit(b.triangle, EdgeFans::side_behind(b));
    });
  }

  [[nodiscard]] std::size_t corner_at(std::uint32_t triangle, std::uint32_t point) const {
    const auto& p = mesh_.triangles[triangle].points;
    return fans_.welded(p[0]) == point ? 0 : fans_.welded(p[1]) == point ? 1 : 2;
  }

  const InterfaceMesh& mesh_;
  const EdgeFans& fans_;
  std::vector<char> counts_;
  DisjointSets corners_;
};

/// The triangles of a network at the points [first, last), as a mesh with bodies in place of materials. Its
/// points have the order that they have in the network.
class NetworkPart {
 public:
  NetworkPart(const InterfaceNetwork& network, std::uint32_t first, std::uint32_t last)
      : first_(first), last_(last) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t p = first; p < last; ++p) {
      for (const std::uint32_t t : network.triangles_at(p)) {
        const auto is_before = [&](std::uint32_t q) { return is_inside(q) && q < p; };
        if (std::ranges::none_of(network.triangles()[t], is_before)) triangles.push_back(t);
      }
    }
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t p : network.triangles()[t]) {
        if (!is_inside(p)) outside_.push_back(p);
      }
    }
    sort_unique(outside_);
    below_ = static_cast<std::uint32_t>(std::ranges::lower_bound(outside_, first) - outside_.begin());
    add_points(network);
    mesh_.triangles.reserve(triangles.size());
    for (const std::uint32_t t : triangles) {
      const auto& [front, back] = network.table().sides(network.interface_of(t));
      InterfaceTriangle triangle{network.triangles()[t], as_material(front), as_material(back)};
      for (std::uint32_t& p : triangle.points) p = number(p);
      mesh_.triangles.push_back(triangle);
    }
  }

  [[nodiscard]] InterfaceMesh& mesh() { return mesh_; }
  /// Marks the points of the mesh that are those from the first to the last one.
  [[nodiscard]] std::vector<char> inside() const {
    std::vector<char> result(mesh_.points.size(), 0);
    std::fill_n(result.begin() + below_, last_ - first_, char{1});
    return result;
  }

 private:
  [[nodiscard]] bool is_inside(std::uint32_t p) const { return first_ <= p && p < last_; }
  /// Returns the number in the mesh of a point of the network.
  [[nodiscard]] std::uint32_t number(std::uint32_t p) const {
    if (is_inside(p)) return below_ + (p - first_);
    const auto place = static_cast<std::uint32_t>(std::ranges::lower_bound(outside_, p) - outside_.begin());
    return place < below_ ? place : place + (last_ - first_);
  }
  void add_points(const InterfaceNetwork& network) {
    const auto points = network.points();
    mesh_.points.reserve(outside_.size() + (last_ - first_));
    for (std::size_t i = 0; i < below_; ++i) mesh_.points.push_back(points[outside_[i]]);
    mesh_.points.insert(mesh_.points.end(), points.begin() + first_, points.begin() + last_);
    for (std::size_t i = below_; i < outside_.size(); ++i) mesh_.points.push_back(points[outside_[i]]);
  }

  std::uint32_t first_, last_;
  std::vector<std::uint32_t> outside_;  ///< the other points, ascending
  std::uint32_t below_ = 0;             ///< how many of them come before the first one
  InterfaceMesh mesh_;
};

/// Numbers the bodies that a mesh has in place of materials; returns them by their numbers.
std::vector<MaterialId> number_bodies(InterfaceMesh& mesh) {
  std::vector<MaterialId> bodies;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const MaterialId body : {t.front, t.back}) {
      const std::size_t n = bodies.size();
      if (n < 2 || (bodies[n - 1] != body && bodies[n - 2] != body)) bodies.push_back(body);
    }
  }
  sort_unique(bodies);
  for (InterfaceTriangle& t : mesh.triangles) {
    for (MaterialId* side : {&t.front, &t.back})
      *side = MaterialId(static_cast<std::size_t>(std::ranges::lower_bound(bodies, *side) - bodies.begin()));
  }
  return bodies;
}

/// Returns the parts of the Euler characteristics that belong to the points [first, last).
std::vector<std::pair<BodyId, std::int64_t>> euler_at(const InterfaceNetwork& network, const Box3& domain,
                                                      std::size_t first, std::size_t last) {
  NetworkPart part(network, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
  const std::vector<MaterialId> bodies = number_bodies(part.mesh());
  const EdgeFans fans(part.mesh(), &domain);
  std::vector<std::pair<BodyId, std::int64_t>> found;
  for (const MaterialId body : bodies) found.emplace_back(body.value, 0);
  EulerCounter(part.mesh(), fans, part.inside()).count([&](BodyId number, std::int64_t by) {
    found[number.value].second += by;
  });
  return found;
}

}  // namespace

IdVector<BodyId, BodyTopology> body_topology(InterfaceMesh mesh, std::size_t bodies, const Box3& domain) {
  mesh.materials.assign(bodies, {});
  const EdgeFans fans(mesh, &domain);
  IdVector<BodyId, BodyTopology> result(bodies);
  for (const MaterialId body : find_bodies(mesh, fans, &domain).materials)
    ++result[BodyId(body.value)].pieces;
  EulerCounter(mesh, fans, std::vector<char>(mesh.points.size(), 1)).count([&](BodyId body, std::int64_t by) {
    result[body].euler += by;
  });
  return result;
}

IdVector<BodyId, BodyTopology> body_topology(const InterfaceNetwork& network, const Box3& domain,
                                             std::size_t points_at_once) {
  const std::size_t bodies = network.table().body_count();
  if (network.has_open_border() || network.inconsistencies() > 0) {
    NetworkPart all(network, 0, static_cast<std::uint32_t>(network.points().size()));
    return body_topology(std::move(all.mesh()), bodies, domain);
  }
  IdVector<BodyId, BodyTopology> result(bodies);
  const std::size_t points = network.points().size();
  const std::size_t blocks = (points + points_at_once - 1) / points_at_once;
  std::vector<std::vector<std::pair<BodyId, std::int64_t>>> found(blocks);
  parallel_for(blocks, 1, [&](std::size_t block) {
    LoopProgress::check();
    const std::size_t first = block * points_at_once;
    found[block] = euler_at(network, domain, first, std::min(points, first + points_at_once));
  });
  for (const auto& parts : found) {
    for (const auto& [body, by] : parts) result[body].euler += by;
  }
  for (InterfaceId i(0); i.value < network.table().interface_count(); ++i.value) {
    for (const BodyId body : network.table().sides(i)) result[body].pieces = 1;
  }
  return result;
}

}  // namespace adamas::interfaces
