#include "interfaces/network/interface_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "core/base/sort_unique.h"
#include "core/base/typed_id.h"
#include "interfaces/network/body_winding.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

/// Sums the weighted normals towards each body at a point of the bodies' boundaries. If the weights are
/// angles, the body whose sum has the greatest product with the offset of a point contains that point
/// (docs/method.md, Signed distances at vertices).
class Pseudonormals {
 public:
  struct Greatest {
    BodyId body;
    bool clear = false;  ///< whether the product is positive and greater than all others
  };
  void add(BodyId body, const Vec3& normal) {
    std::size_t i = 0;
    while (i < count_ && entries_[i].body != body) ++i;
    if (i == entries_.size()) {
      overflow_ = true;
      return;
    }
    if (i == count_) entries_[count_++] = {body, {}};
    entries_[i].normal += normal;
  }
  [[nodiscard]] Greatest greatest(const Vec3& offset) const {
    Greatest best;
    double first = -std::numeric_limits<double>::infinity(), second = first;
    for (std::size_t i = 0; i < count_; ++i) {
      const double value = dot(offset, entries_[i].normal);
      const bool better = value > first || (value == first && entries_[i].body < best.body);
      second = std::max(second, better ? first : value);
      if (better) first = value, best.body = entries_[i].body;
    }
    const double margin = kAmbiguous * norm(offset);
    best.clear = !overflow_ && first > margin && first - second > margin;
    return best;
  }

 private:
  /// Products that are closer to each other than this, relative to the distance, are ambiguous.
  static constexpr double kAmbiguous = 1e-7;
  struct Entry {
    BodyId body;
    Vec3 normal;
  };
  std::array<Entry, 16> entries_;
  std::size_t count_ = 0;
  bool overflow_ = false;
};

/// Near flat triangles, points closer to each other than this, relative to the size of the network, are
/// equal.
constexpr double kTouch = 1e-10;

/// The least winding number that is certain.
constexpr double kCertain = 0.75;

double corner_angle(const Vec3& at, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - at, v = c - at;
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

bool bit(std::uint16_t bits, unsigned i) { return ((bits >> i) & 1u) != 0; }

/// The directions x from a point of an edge or a corner into a triangle: those with dot(x, left) >= 0 and
/// dot(x, right) >= 0.
struct Sector {
  Vec3 left, right, middle;
};

Sector sector_at_corner(const Vec3& at, const Vec3& b, const Vec3& c, const Vec3& normal) {
  const Vec3 u = normalized(b - at), v = normalized(c - at);
  return {cross(normal, u), cross(v, normal), normalized(u + v)};
}

Sector sector_at_edge(const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 inward = cross(normal, normalized(b - a));
  return {inward, inward, inward};
}

}  // namespace

/// The structures that a network builds when they are first needed.
struct InterfaceNetwork::OnDemand {
  /// A vertex as a corner of one of its triangles.
  struct Corner {
    std::uint32_t triangle;
    TriangleFeature feature;
  };
  /// The vertices of an interface, for distances to the nearest one. Each vertex is stored in the tree as a
  /// triangle with three equal corners.
  struct Vertices {
    std::vector<Corner> corners;  ///< indexed by triangle of the tree
    ClosestPointTree tree;
  };
  std::once_flag vertices_built;
  IdVector<InterfaceId, Vertices> vertices;

  /// The winding numbers, for networks with gaps.
  std::once_flag winding_built;
  std::optional<BodyWinding> winding;
};

InterfaceNetwork::InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain)
    : InterfaceNetwork(mesh, domain, find_bodies(mesh, domain ? &*domain : nullptr)) {}

InterfaceNetwork::InterfaceNetwork(InterfaceMesh mesh, std::optional<Box3> domain, Bodies bodies)
    : domain_(domain),
      inconsistencies_(bodies.inconsistent_edges + bodies.inconsistent_rays),
      on_demand_(std::make_shared<OnDemand>()) {
  if (bodies.sides.size() != mesh.triangles.size()) {
    fail("{}: expected the bodies of {} triangles, found {}", mesh.source, mesh.triangles.size(),
         bodies.sides.size());
  }
  std::vector<ClosestPointTree::Triangle> triangles = group(mesh, bodies);
  release_memory(bodies.sides);
  release_memory(mesh.triangles);
  mesh.points.shrink_to_fit();
  LoopProgress::check();
  forest_ = ClosestPointForest(
      std::move(mesh.points), std::move(triangles), interfaces_.size(),
      [this](std::uint32_t t) { return interface_of_[t].value; }, interfaces_of_bodies_and_materials());
  std::vector<Box3> boxes;
  for (InterfaceId i(0); i.value < interfaces_.size(); ++i.value) boxes.push_back(tree(i).bounds());
  box_tree_ = BoxTree(boxes);
  LoopProgress::check();
  find_adjacency();
  LoopProgress::check();
  find_borders();
  LoopProgress::check();
  open_ = find_open_border();
  find_flat();
}

std::vector<ClosestPointTree::Triangle> InterfaceNetwork::group(const InterfaceMesh& mesh,
                                                                const Bodies& bodies) {
  using Pair = std::array<BodyId, 2>;
  const std::vector<std::uint32_t> welded = weld_points(mesh.points);
  LoopProgress::check();
  // Calls visit(points, pair of bodies) for the triangles that count, oriented towards the lower body.
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& p = mesh.triangles[t].points;
      const auto [front, back] = bodies.sides[t];
      const ClosestPointTree::Triangle v{welded[p[0]], welded[p[1]], welded[p[2]]};
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0] || front == back) continue;
      if (std::max(front, back).value >= bodies.materials.size()) {
        fail("{}: triangle {}: body {} of {} does not exist", mesh.source, t, std::max(front, back).value,
             bodies.materials.size());
      }
      if (front < back) visit(v, Pair{front, back});
      if (back < front) visit(ClosestPointTree::Triangle{v[0], v[2], v[1]}, Pair{back, front});
    }
  };
  constexpr std::size_t kFewPairs = 4096;
  IdVector<InterfaceId, Pair> pairs;
  std::size_t most = kFewPairs;
  for_each([&](const auto&, const Pair& pair) {
    if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
    if (pairs.size() < most) return;
    sort_unique(pairs);
    most = 2 * pairs.size() + kFewPairs;
  });
  sort_unique(pairs);
  pairs.shrink_to_fit();
  LoopProgress::check();
  InterfaceId last;
  const auto number_of = [&](const Pair& pair) {
    if (!last.valid() || pairs[last] != pair)
      last = InterfaceId(
          static_cast<std::size_t>(std::lower_bound(pairs.begin(), pairs.end(), pair) - pairs.begin()));
    return last;
  };
  for (const auto& [a, b] : pairs) interfaces_.push_back({a, b, 0, 0});
  for_each([&](const auto&, const Pair& pair) { ++interfaces_[number_of(pair)].count; });
  std::uint32_t count = 0;
  IdVector<InterfaceId, std::uint32_t> next;
  for (Interface& interface : interfaces_) {
    interface.first = count;
    next.push_back(count);
    count += interface.count;
  }
  interface_of_.reserve(count);
  for (InterfaceId i(0); i.value < interfaces_.size(); ++i.value)
    interface_of_.insert(interface_of_.end(), interfaces_[i].count, i);
  std::vector<ClosestPointTree::Triangle> triangles(count);
  for_each([&](const auto& points, const Pair& pair) { triangles[next[number_of(pair)]++] = points; });
  table_ = InterfaceTable(bodies.materials, std::move(pairs));
  return triangles;
}

/// Returns lists of interfaces: those of each body, and then those of each material.
std::vector<std::vector<std::uint32_t>> InterfaceNetwork::interfaces_of_bodies_and_materials() const {
  std::size_t materials = 0;
  for (const MaterialId m : table_.body_materials())
    materials = std::max<std::size_t>(materials, m.value + 1);
  std::vector<std::vector<std::uint32_t>> lists(table_.body_count() + materials);
  for (BodyId body(0); body.value < table_.body_count(); ++body.value) {
    auto& of_material = lists[table_.body_count() + table_.material(body).value];
    for (const auto& [other, i] : table_.neighbours(body)) {
      lists[body.value].push_back(i.value);
      of_material.push_back(i.value);
    }
  }
  for (auto& list : lists) sort_unique(list);
  return lists;
}

void InterfaceNetwork::find_adjacency() {
  point_starts_.assign(points().size() + 1, 0);
  for (const auto& t : triangles()) {
    for (const std::uint32_t v : t) ++point_starts_[v + 1];
  }
  std::partial_sum(point_starts_.begin(), point_starts_.end(), point_starts_.begin());
  // Each start moves on to the next one while the triangles are filled in, and back after that.
  point_triangles_.resize(3 * triangles().size());
  for (std::uint32_t t = 0; t < triangles().size(); ++t) {
    for (const std::uint32_t v : triangles()[t]) point_triangles_[point_starts_[v]++] = t;
  }
  for (std::size_t p = points().size(); p > 0; --p) point_starts_[p] = point_starts_[p - 1];
  point_starts_[0] = 0;
}

void InterfaceNetwork::find_borders() {
  // An edge of a triangle at its lower point.
  struct HalfEdge {
    std::uint32_t high, triangle, edge;
  };
  borders_.assign(triangles().size(), 0);
  std::vector<HalfEdge> half_edges;
  for (std::uint32_t low = 0; low < points().size(); ++low) {
    LoopProgress::check_step(low);
    half_edges.clear();
    for (std::uint32_t k = point_starts_[low]; k < point_starts_[low + 1]; ++k) {
      const std::uint32_t t = point_triangles_[k];
      const auto& v = triangles()[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [first, second] = std::minmax(v[i], v[(i + 1) % 3]);
        if (first == low) half_edges.push_back({second, t, i});
      }
    }
    // Triangles are numbered interface by interface, so those of one interface are neighbours here.
    std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
    });
    const auto same_edge = [&](std::size_t i, std::size_t j) {
      return j < half_edges.size() && half_edges[i].high == half_edges[j].high;
    };
    const auto mark = [&](const HalfEdge& h, bool of_interface) {
      const unsigned bit = (of_interface ? kEdgeOfInterface : kEdgeOfNetwork) + h.edge;
      borders_[h.triangle] = static_cast<std::uint16_t>(borders_[h.triangle] | (1u << bit));
      mark_border_corner(h.triangle, low, of_interface);
      mark_border_corner(h.triangle, h.high, of_interface);
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
}

bool InterfaceNetwork::find_open_border() const {
  for (std::uint32_t t = 0; t < triangles().size(); ++t) {
    for (unsigned i = 0; i < 3; ++i) {
      if (!bit(borders_[t], kEdgeOfNetwork + i)) continue;
      const Vec3 &a = points()[triangles()[t][i]], &b = points()[triangles()[t][(i + 1) % 3]];
      // Edges outside the domain or in its boundary are not open.
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
      if (triangles()[t][k] == point) borders_[t] = static_cast<std::uint16_t>(borders_[t] | (1u << bit));
    }
  }
}

void InterfaceNetwork::find_flat() {
  for (std::uint32_t t = 0; t < triangles().size(); ++t) {
    const auto& v = triangles()[t];
    if (!is_flat({points()[v[0]], points()[v[1]], points()[v[2]]})) continue;
    borders_[t] = static_cast<std::uint16_t>(borders_[t] | (1u << kFlat));
    for (const std::uint32_t p : v) {
      for (std::uint32_t i = point_starts_[p]; i < point_starts_[p + 1]; ++i) {
        std::uint16_t& bits = borders_[point_triangles_[i]];
        bits = static_cast<std::uint16_t>(bits | (1u << kNearFlat));
      }
    }
  }
}

template <class Visit>
void InterfaceNetwork::for_each_at(std::uint32_t triangle, TriangleFeature feature, Visit&& visit) const {
  if (feature == TriangleFeature::kFace) {
    visit(triangle, 1.0);
    return;
  }
  const unsigned i = feature_index(feature);
  const std::uint32_t from = triangles()[triangle][i], to = triangles()[triangle][(i + 1) % 3];
  for (std::uint32_t k = point_starts_[from]; k < point_starts_[from + 1]; ++k) {
    const std::uint32_t t = point_triangles_[k];
    const auto& v = triangles()[t];
    if (is_edge(feature)) {
      if (v[0] == to || v[1] == to || v[2] == to) visit(t, 1.0);
      continue;
    }
    const std::size_t c = v[0] == from ? 0 : (v[1] == from ? 1 : 2);
    visit(t, corner_angle(points()[from], points()[v[(c + 1) % 3]], points()[v[(c + 2) % 3]]));
  }
}

bool InterfaceNetwork::on_border(std::uint32_t triangle, TriangleFeature feature, unsigned edge_bit,
                                 unsigned corner_bit) const {
  if (feature == TriangleFeature::kFace) return false;
  return bit(borders_[triangle], (is_edge(feature) ? edge_bit : corner_bit) + feature_index(feature));
}

bool InterfaceNetwork::on_domain_boundary(const Vec3& p) const {
  return domain_ && !is_inside_domain(*domain_, p);
}

BodyId InterfaceNetwork::body_at(const Vec3& p, bool* flagged) const {
  if (flagged != nullptr) *flagged = false;
  const auto closest = tree().closest(p);
  if (!closest) return BodyId(0);
  const Vec3 offset = p - closest->point;
  const Interface& interface = interfaces_[interface_of_[closest->triangle]];
  if (near_flat(closest->triangle, closest->feature)) return body_by_touching(p, *closest, flagged);
  if (closest->feature == TriangleFeature::kFace) {
    return dot(offset, normal(closest->triangle)) >= 0 ? interface.a : interface.b;
  }
  if (on_border(closest->triangle, closest->feature, kEdgeOfNetwork, kCornerOfNetwork)) {
    const BodyId continued = body_by_arc(offset, closest->triangle, closest->feature);
    return on_domain_boundary(closest->point) ? continued : body_beyond_border(p, continued, flagged);
  }

  Pseudonormals normals;
  for_each_at(closest->triangle, closest->feature, [&](std::uint32_t t, double weight) {
    const Interface& at = interfaces_[interface_of_[t]];
    normals.add(at.a, weight * normal(t));
    normals.add(at.b, -weight * normal(t));
  });
  const auto best = normals.greatest(offset);
  return best.clear ? best.body : body_by_arc(offset, closest->triangle, closest->feature);
}

bool InterfaceNetwork::near_flat(std::uint32_t triangle, TriangleFeature feature) const {
  return bit(borders_[triangle], feature == TriangleFeature::kFace ? kFlat : kNearFlat);
}

bool InterfaceNetwork::find_touching(const ClosestPointTree& tree, const Vec3& p, unsigned edge_bit,
                                     std::vector<TouchingTriangle>& out) const {
  out.clear();
  const double reach = kTouch * this->tree().bounds().diagonal();
  const Vec3 margin{reach, reach, reach};
  thread_local std::vector<std::uint32_t> found;
  tree.overlapping({p - margin, p + margin}, found);
  bool border = false;
  for (const std::uint32_t t : found) {
    const std::array<Vec3, 3> c = triangle_corners(t);
    double weight = 2 * M_PI;
    for (unsigned i = 0; i < 3; ++i) {
      if (detail::closest_on_edge(p, c, i).squared_distance > 4 * reach * reach) continue;
      weight = std::min(weight, M_PI);
      border = border || bit(borders_[t], edge_bit + i);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (distance(p, c[i]) <= 2 * reach) weight = corner_angle(c[i], c[(i + 1) % 3], c[(i + 2) % 3]);
    }
    out.push_back({t, bit(borders_[t], kFlat) ? 0 : weight});
  }
  return border;
}

/// Returns the body by winding numbers if they are certain, else `continued`, the body by the interface at
/// the border.
BodyId InterfaceNetwork::body_beyond_border(const Vec3& p, BodyId continued, bool* flagged) const {
  std::call_once(on_demand_->winding_built, [this] { on_demand_->winding.emplace(*this, domain_); });
  const BodyWinding::Answer answer = on_demand_->winding->at(p);
  const bool sure = answer.number >= kCertain;
  if (flagged != nullptr) *flagged = !sure || table_.material(answer.body) != table_.material(continued);
  return sure ? answer.body : continued;
}

BodyId InterfaceNetwork::body_by_touching(const Vec3& p, const ClosestPoint& closest, bool* flagged) const {
  thread_local std::vector<TouchingTriangle> touching;
  const bool border = find_touching(tree(), closest.point, kEdgeOfNetwork, touching);
  Pseudonormals normals;
  for (const auto& [t, weight] : touching) {
    if (weight == 0) continue;
    const Interface& at = interfaces_[interface_of_[t]];
    normals.add(at.a, weight * normal(t));
    normals.add(at.b, -weight * normal(t));
  }
  const auto best = normals.greatest(p - closest.point);
  const BodyId body = best.body.valid() ? best.body : interfaces_[interface_of_[closest.triangle]].a;
  return border && !on_domain_boundary(closest.point) ? body_beyond_border(p, body, flagged) : body;
}

/// Returns the body on the side, facing the point, of the first triangle that the arc of directions from
/// `offset` to the middle of the given triangle meets. This is right for any triangles that meet there, also
/// at borders, and within a convex domain.
BodyId InterfaceNetwork::body_by_arc(const Vec3& offset, std::uint32_t triangle,
                                     TriangleFeature feature) const {
  const Vec3 from = normalized(offset);
  const unsigned corner = feature_index(feature);
  const std::uint32_t point = triangles()[triangle][corner];
  const auto sector_of = [&](std::uint32_t t) {
    const auto& v = triangles()[t];
    if (is_edge(feature)) {
      const std::uint32_t other = triangles()[triangle][(corner + 1) % 3];
      for (unsigned i = 0; i < 3; ++i) {
        const std::uint32_t a = v[i], b = v[(i + 1) % 3];
        if ((a == point && b == other) || (a == other && b == point)) {
          return sector_at_edge(points()[a], points()[b], normal(t));
        }
      }
    }
    const std::size_t c = v[0] == point ? 0 : (v[1] == point ? 1 : 2);
    return sector_at_corner(points()[point], points()[v[(c + 1) % 3]], points()[v[(c + 2) % 3]], normal(t));
  };
  const Vec3 to = sector_of(triangle).middle;
  double first = 2;
  BodyId body = interfaces_[interface_of_[triangle]].a;
  for_each_at(triangle, feature, [&](std::uint32_t t, double) {
    const double height = dot(normal(t), from);
    const double at = t == triangle ? 1 : height / (height - dot(normal(t), to));
    if (height == 0 || !(at >= 0 && at <= 1) || at >= first) return;
    const Sector sector = sector_of(t);
    const Vec3 x = (1 - at) * from + at * to;
    if (t != triangle && (dot(x, sector.left) < -1e-12 || dot(x, sector.right) < -1e-12)) return;
    first = at;
    const Interface& interface = interfaces_[interface_of_[t]];
    body = height > 0 ? interface.a : interface.b;
  });
  return body;
}

Vec3 InterfaceNetwork::interface_normal(std::uint32_t triangle, TriangleFeature feature) const {
  Vec3 sum;
  for_each_at(triangle, feature, [&](std::uint32_t t, double weight) {
    if (interface_of_[t] == interface_of_[triangle]) sum += weight * normal(t);
  });
  return normalized(sum);
}

void InterfaceNetwork::near_interfaces(const Vec3& p, double radius, BodyId body_of_p,
                                       std::vector<NearInterface>& out, DistanceMode mode) const {
  out.clear();
  if (mode == DistanceMode::kNearestVertex)
    std::call_once(on_demand_->vertices_built, [this] { build_vertex_trees(); });
  thread_local std::vector<std::uint32_t> candidates;
  box_tree_.near(p, radius, candidates);
  for (const std::uint32_t i : candidates) {
    if (const auto found = near_interface(InterfaceId(i), p, radius, body_of_p, mode)) out.push_back(*found);
  }
}

/// Returns the nearest vertex of an interface as a closest point, which is a corner of one of its triangles.
std::optional<ClosestPoint> InterfaceNetwork::nearest_vertex(InterfaceId i, const Vec3& p,
                                                             double radius) const {
  const OnDemand::Vertices& vertices = on_demand_->vertices[i];
  const auto nearest = vertices.tree.closest(p, radius);
  if (!nearest) return std::nullopt;
  const OnDemand::Corner& corner = vertices.corners[nearest->triangle];
  return ClosestPoint{triangle_corners(corner.triangle)[feature_index(corner.feature)],
                      nearest->squared_distance, corner.triangle, corner.feature};
}

std::optional<NearInterface> InterfaceNetwork::near_interface(InterfaceId i, const Vec3& p, double radius,
                                                              BodyId body, DistanceMode mode) const {
  const Interface& interface = interfaces_[i];
  const auto closest =
      mode == DistanceMode::kExact ? tree(i).closest(p, radius) : nearest_vertex(i, p, radius);
  if (!closest) return std::nullopt;
  const std::uint32_t triangle = closest->triangle;
  const TriangleFeature feature = closest->feature;
  const double distance = std::sqrt(closest->squared_distance);
  Vec3 normal;
  bool border = false;
  if (near_flat(triangle, feature)) {
    thread_local std::vector<TouchingTriangle> touching;
    border = find_touching(tree(i), closest->point, kEdgeOfInterface, touching);
    for (const TouchingTriangle& touch : touching) normal += touch.weight * this->normal(touch.triangle);
    normal = normalized(normal);
  } else {
    border = on_border(triangle, feature, kEdgeOfInterface, kCornerOfInterface);
    normal = interface_normal(triangle, feature);
  }
  const double height = dot(p - closest->point, normal);
  const bool continued = mode == DistanceMode::kExact && border;
  double value = continued ? height : (height >= 0 ? distance : -distance);
  // The sign for a point on the continued plane is meaningless.
  const double round_off = continued ? 1e-10 * radius : 0;
  if (body == interface.a && value < -round_off) value = distance;
  if (body == interface.b && value > round_off) value = -distance;
  const bool outside_of_both = body != interface.a && body != interface.b;
  const bool flagged = open_ && outside_of_both && on_open_border(i, triangle, feature, closest->point);
  return NearInterface{i, value, closest->point, flagged};
}

bool InterfaceNetwork::on_open_border(InterfaceId i, std::uint32_t triangle, TriangleFeature feature,
                                      const Vec3& closest) const {
  if (on_domain_boundary(closest)) return false;
  if (!near_flat(triangle, feature)) return on_border(triangle, feature, kEdgeOfNetwork, kCornerOfNetwork);
  thread_local std::vector<TouchingTriangle> touching;
  return find_touching(tree(i), closest, kEdgeOfNetwork, touching);
}

void InterfaceNetwork::build_vertex_trees() const {
  auto& trees = on_demand_->vertices;
  trees.resize(interfaces_.size());
  parallel_for(interfaces_.size(), 1, [&](std::size_t i) {
    const Interface& interface = interfaces_[InterfaceId(i)];
    std::map<std::uint32_t, OnDemand::Corner> corners;
    for (std::uint32_t t = interface.first; t < interface.first + interface.count; ++t) {
      for (unsigned k = 0; k < 3; ++k)
        corners.try_emplace(triangles()[t][k], OnDemand::Corner{t, vertex_feature(k)});
    }
    std::vector<ClosestPointTree::Triangle> vertices;
    for (const auto& [point, corner] : corners) {
      vertices.push_back({point, point, point});
      trees[InterfaceId(i)].corners.push_back(corner);
    }
    trees[InterfaceId(i)].tree = ClosestPointTree(points(), vertices);
  });
}

InterfaceMesh network_mesh(const InterfaceNetwork& network,
                           const IdVector<MaterialId, std::string>& materials, const std::string& source) {
  InterfaceMesh mesh;
  mesh.source = source;
  mesh.materials = materials;
  mesh.points.assign(network.points().begin(), network.points().end());
  mesh.triangles.reserve(network.triangles().size());
  const InterfaceTable& table = network.table();
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& [front, back] = table.sides(network.interface_of(t));
    mesh.triangles.push_back({network.triangles()[t], table.material(front), table.material(back)});
  }
  return mesh;
}

std::vector<std::array<BodyId, 2>> triangle_bodies(const InterfaceNetwork& network) {
  std::vector<std::array<BodyId, 2>> bodies;
  bodies.reserve(network.triangles().size());
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t)
    bodies.push_back(network.table().sides(network.interface_of(t)));
  return bodies;
}

}  // namespace adamas::interfaces
