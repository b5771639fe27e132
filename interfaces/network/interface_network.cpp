#include "interfaces/network/interface_network.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "interfaces/network/network_on_demand.h"
#include "interfaces/network/weld.h"

namespace adamas::interfaces {

InterfaceNetwork::InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain)
    : InterfaceNetwork(mesh, domain, find_bodies(mesh, domain ? &*domain : nullptr)) {}

InterfaceNetwork::InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain, Bodies bodies)
    : domain_(domain),
      points_(mesh.points),
      inconsistencies_(bodies.inconsistent_edges + bodies.inconsistent_rays),
      on_demand_(std::make_shared<OnDemand>()) {
  if (bodies.sides.size() != mesh.triangles.size()) {
    fail("{}: expected the bodies of {} triangles, found {}", mesh.source, mesh.triangles.size(),
         bodies.sides.size());
  }
  group(mesh, bodies);
  LoopProgress::check();
  find_adjacency();
  LoopProgress::check();
  find_borders();
  LoopProgress::check();
  open_ = find_open_border();
  find_flat();
  LoopProgress::check();
  build_trees();
}

void InterfaceNetwork::group(const InterfaceMesh& mesh, const Bodies& bodies) {
  struct Entry {
    BodyId a, b;
    std::uint32_t source;
    ClosestPointTree::Triangle points;
  };
  const std::vector<std::uint32_t> welded = weld_points(points_);
  LoopProgress::check();
  std::vector<Entry> entries;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    const auto [front, back] = bodies.sides[t];
    const ClosestPointTree::Triangle v{welded[p[0]], welded[p[1]], welded[p[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0] || front == back) continue;
    if (std::max(front, back).value >= bodies.materials.size()) {
      fail("{}: triangle {}: body {} of {} does not exist", mesh.source, t, std::max(front, back).value,
           bodies.materials.size());
    }
    if (front < back) {
      entries.push_back({front, back, t, v});
    } else {
      entries.push_back({back, front, t, {v[0], v[2], v[1]}});
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) {
    return std::tie(x.a, x.b, x.source) < std::tie(y.a, y.b, y.source);
  });
  LoopProgress::check();
  for (const Entry& e : entries) {
    const auto t = static_cast<std::uint32_t>(triangles_.size());
    if (interfaces_.empty() || interfaces_.back().a != e.a || interfaces_.back().b != e.b) {
      interfaces_.push_back({e.a, e.b, t, 0, {}});
    }
    ++interfaces_.back().count;
    for (const std::uint32_t v : e.points) interfaces_.back().bounds.extend(points_[v]);
    triangles_.push_back(e.points);
    interface_of_.push_back(InterfaceId(interfaces_.size() - 1));
    const Vec3 &p = points_[e.points[0]], &q = points_[e.points[1]], &r = points_[e.points[2]];
    normals_.push_back(normalized(cross(q - p, r - p)));
  }

  IdVector<InterfaceId, std::array<BodyId, 2>> sides;
  for (const Interface& i : interfaces_) sides.push_back({i.a, i.b});
  table_ = InterfaceTable(bodies.materials, std::move(sides));
}

void InterfaceNetwork::find_adjacency() {
  point_starts_.assign(points_.size() + 1, 0);
  for (const auto& t : triangles_) {
    for (const std::uint32_t v : t) ++point_starts_[v + 1];
  }
  std::partial_sum(point_starts_.begin(), point_starts_.end(), point_starts_.begin());
  std::vector<std::uint32_t> next(point_starts_.begin(), point_starts_.end() - 1);
  point_triangles_.resize(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t v : triangles_[t]) point_triangles_[next[v]++] = t;
  }
}

void InterfaceNetwork::find_borders() {
  struct HalfEdge {
    std::uint32_t low, high, triangle, edge;
  };
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      half_edges.push_back({std::min(a, b), std::max(a, b), t, i});
    }
  }
  // Triangles are numbered interface by interface, so those of one interface are neighbours here.
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  LoopProgress::check();
  borders_.assign(triangles_.size(), 0);
  const auto mark = [&](const HalfEdge& h, bool of_interface) {
    const unsigned bit = (of_interface ? kEdgeOfInterface : kEdgeOfNetwork) + h.edge;
    borders_[h.triangle] = static_cast<std::uint16_t>(borders_[h.triangle] | (1u << bit));
    mark_border_corner(h.triangle, h.low, of_interface);
    mark_border_corner(h.triangle, h.high, of_interface);
  };
  const auto same_edge = [&](std::size_t i, std::size_t j) {
    return j < half_edges.size() && half_edges[i].low == half_edges[j].low &&
           half_edges[i].high == half_edges[j].high;
  };
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    const bool before = i > 0 && same_edge(i, i - 1), after = same_edge(i, i + 1);
    const InterfaceId interface = interface_of_[half_edges[i].triangle];
    if (!before && !after) mark(half_edges[i], false);
    if (before && interface_of_[half_edges[i - 1].triangle] == interface) continue;
    if (after && interface_of_[half_edges[i + 1].triangle] == interface) continue;
    mark(half_edges[i], true);
  }
}

bool InterfaceNetwork::find_open_border() const {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (unsigned i = 0; i < 3; ++i) {
      if ((borders_[t] >> (kEdgeOfNetwork + i) & 1u) == 0) continue;
      const Vec3 &a = points_[triangles_[t][i]], &b = points_[triangles_[t][(i + 1) % 3]];
      // Beyond the domain nothing is open, and an edge in its boundary ends there.
      if (domain_ && (!domain_->contains(0.5 * (a + b)) || on_domain_boundary(0.5 * (a + b)))) continue;
      return true;
    }
  }
  return false;
}

void InterfaceNetwork::mark_border_corner(std::uint32_t triangle, std::uint32_t point, bool of_interface) {
  for (std::uint32_t i = point_starts_[point]; i < point_starts_[point + 1]; ++i) {
    const std::uint32_t t = point_triangles_[i];
    if (of_interface && interface_of_[t] != interface_of_[triangle]) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned bit = (of_interface ? kCornerOfInterface : kCornerOfNetwork) + k;
      if (triangles_[t][k] == point) borders_[t] = static_cast<std::uint16_t>(borders_[t] | (1u << bit));
    }
  }
}

void InterfaceNetwork::find_flat() {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto& v = triangles_[t];
    if (!is_flat({points_[v[0]], points_[v[1]], points_[v[2]]})) continue;
    borders_[t] = static_cast<std::uint16_t>(borders_[t] | (1u << kFlat));
    for (const std::uint32_t p : v) {
      for (std::uint32_t i = point_starts_[p]; i < point_starts_[p + 1]; ++i) {
        std::uint16_t& bits = borders_[point_triangles_[i]];
        bits = static_cast<std::uint16_t>(bits | (1u << kNearFlat));
      }
    }
  }
}

void InterfaceNetwork::build_trees() {
  const std::span<const ClosestPointTree::Triangle> all(triangles_);
  tree_ = ClosestPointTree(points_, all);
  std::vector<Box3> boxes;
  for (const Interface& i : interfaces_) boxes.push_back(i.bounds);
  box_tree_ = BoxTree(boxes);
  if (interfaces_.size() == 1) return;
  trees_.resize(interfaces_.size());
  parallel_for(interfaces_.size(), 1, [&](std::size_t i) {
    const Interface& interface = interfaces_[InterfaceId(i)];
    trees_[InterfaceId(i)] = ClosestPointTree(points_, all.subspan(interface.first, interface.count));
  });
}

}  // namespace adamas::interfaces
