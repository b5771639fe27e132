#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/assert.h"
#include "core/base/parallel.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/vertex_trees.h"

namespace adamas {

namespace {

/// Greatest dot products closer to each other than this, relative to the distance, decide nothing.
constexpr double kAmbiguous = 1e-7;

double corner_angle(const Vec3& at, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - at, v = c - at;
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

bool bit(std::uint16_t bits, unsigned i) { return ((bits >> i) & 1u) != 0; }

/// The directions from a point of an edge or a corner into a triangle: x with dot(x, left) >= 0 and dot(x,
/// right) >= 0.
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

template <class Visit>
void InterfaceNetwork::for_each_at(std::uint32_t triangle, TriangleFeature feature, Visit&& visit) const {
  if (feature == TriangleFeature::kFace) {
    visit(triangle, 1.0);
    return;
  }
  const unsigned i = feature_index(feature);
  const std::uint32_t from = triangles_[triangle][i], to = triangles_[triangle][(i + 1) % 3];
  for (std::uint32_t k = point_starts_[from]; k < point_starts_[from + 1]; ++k) {
    const std::uint32_t t = point_triangles_[k];
    const auto& v = triangles_[t];
    if (is_edge(feature)) {
      if (v[0] == to || v[1] == to || v[2] == to) visit(t, 1.0);
      continue;
    }
    const std::size_t c = v[0] == from ? 0 : (v[1] == from ? 1 : 2);
    visit(t, corner_angle(points_[from], points_[v[(c + 1) % 3]], points_[v[(c + 2) % 3]]));
  }
}

bool InterfaceNetwork::on_border(std::uint32_t triangle, TriangleFeature feature, unsigned edge_bit,
                                 unsigned corner_bit) const {
  if (feature == TriangleFeature::kFace) return false;
  return bit(borders_[triangle], (is_edge(feature) ? edge_bit : corner_bit) + feature_index(feature));
}

bool InterfaceNetwork::on_domain_boundary(const Vec3& p) const {
  if (!domain_) return false;
  const double tolerance = 1e-9 * domain_->diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] <= domain_->min[axis] + tolerance || p[axis] >= domain_->max[axis] - tolerance) return true;
  }
  return false;
}

BodyId InterfaceNetwork::body_at(const Vec3& p, bool* flagged) const {
  if (flagged != nullptr) *flagged = false;
  const auto closest = tree_.closest(p);
  if (!closest) return BodyId(0);
  const Vec3 offset = p - closest->point;
  const Interface& interface = interfaces_[interface_of_[closest->triangle]];
  if (closest->feature == TriangleFeature::kFace) {
    return dot(offset, normals_[closest->triangle]) >= 0 ? interface.a : interface.b;
  }
  if (on_border(closest->triangle, closest->feature, kEdgeOfNetwork, kCornerOfNetwork)) {
    if (flagged != nullptr) *flagged = !on_domain_boundary(closest->point);
    return body_by_arc(offset, closest->triangle, closest->feature);
  }

  struct Candidate {
    BodyId body;
    Vec3 normal;
  };
  std::array<Candidate, 16> candidates;
  std::size_t count = 0;
  const auto add = [&](BodyId body, const Vec3& normal) {
    std::size_t i = 0;
    while (i < count && candidates[i].body != body) ++i;
    if (i == candidates.size()) return;
    if (i == count) candidates[count++] = {body, {}};
    candidates[i].normal += normal;
  };
  for_each_at(closest->triangle, closest->feature, [&](std::uint32_t t, double weight) {
    const Interface& at = interfaces_[interface_of_[t]];
    add(at.a, weight * normals_[t]);
    add(at.b, -weight * normals_[t]);
  });
  Candidate best{{}, {}};
  double greatest = -std::numeric_limits<double>::infinity(), second = greatest;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = dot(offset, candidates[i].normal);
    const bool better = value > greatest || (value == greatest && candidates[i].body < best.body);
    second = std::max(second, better ? greatest : value);
    if (better) greatest = value, best = candidates[i];
  }
  const double margin = kAmbiguous * norm(offset);
  if (greatest <= margin || greatest - second <= margin || count == candidates.size()) {
    return body_by_arc(offset, closest->triangle, closest->feature);
  }
  return best.body;
}

/// Follows the arc of directions from `offset` to the middle of the given triangle: the first triangle in the
/// way shows the side that faces the point. Right for any triangles that meet there, borders included, and
/// within a convex domain.
BodyId InterfaceNetwork::body_by_arc(const Vec3& offset, std::uint32_t triangle,
                                     TriangleFeature feature) const {
  const Vec3 from = normalized(offset);
  const unsigned corner = feature_index(feature);
  const std::uint32_t point = triangles_[triangle][corner];
  const auto sector_of = [&](std::uint32_t t) {
    const auto& v = triangles_[t];
    if (is_edge(feature)) {
      const std::uint32_t other = triangles_[triangle][(corner + 1) % 3];
      for (unsigned i = 0; i < 3; ++i) {
        const std::uint32_t a = v[i], b = v[(i + 1) % 3];
        if ((a == point && b == other) || (a == other && b == point)) {
          return sector_at_edge(points_[a], points_[b], normals_[t]);
        }
      }
    }
    const std::size_t c = v[0] == point ? 0 : (v[1] == point ? 1 : 2);
    return sector_at_corner(points_[point], points_[v[(c + 1) % 3]], points_[v[(c + 2) % 3]], normals_[t]);
  };
  const Vec3 to = sector_of(triangle).middle;
  double first = 2;
  BodyId body = interfaces_[interface_of_[triangle]].a;
  for_each_at(triangle, feature, [&](std::uint32_t t, double) {
    const double height = dot(normals_[t], from);
    const double at = t == triangle ? 1 : height / (height - dot(normals_[t], to));
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

std::optional<ClosestPoint> InterfaceNetwork::closest_of_body(BodyId body, const Vec3& p,
                                                              double max_distance) const {
  std::optional<ClosestPoint> best;
  for (const auto& [other, i] : table_.neighbours(body)) {
    // Wider than the bound itself, since squares of roots are not exact.
    const double bound = best ? std::sqrt(best->squared_distance) * (1 + 1e-15) : max_distance;
    if (squared_distance(interfaces_[i].bounds, p) > bound * bound) continue;
    auto closest = trees_[i].closest(p, bound);
    if (!closest || (best && closest->squared_distance >= best->squared_distance)) continue;
    closest->triangle += interfaces_[i].first;
    best = closest;
  }
  return best;
}

Vec3 InterfaceNetwork::interface_normal(std::uint32_t triangle, TriangleFeature feature) const {
  Vec3 sum;
  for_each_at(triangle, feature, [&](std::uint32_t t, double weight) {
    if (interface_of_[t] == interface_of_[triangle]) sum += weight * normals_[t];
  });
  return normalized(sum);
}

void InterfaceNetwork::near_interfaces(const Vec3& p, double radius, BodyId body_of_p,
                                       std::vector<NearInterface>& out, DistanceMode mode) const {
  out.clear();
  if (mode == DistanceMode::kNearestVertex)
    std::call_once(vertex_trees_->built, [this] { build_vertex_trees(); });
  thread_local std::vector<std::uint32_t> candidates;
  box_tree_.near(p, radius, candidates);
  for (const std::uint32_t i : candidates) {
    if (const auto found = near_interface(InterfaceId(i), p, radius, body_of_p, mode)) out.push_back(*found);
  }
}

std::optional<NearInterface> InterfaceNetwork::near_interface(InterfaceId i, const Vec3& p, double radius,
                                                              BodyId body, DistanceMode mode) const {
  const Interface& interface = interfaces_[i];
  const bool exact = mode == DistanceMode::kExact;
  const auto closest = (exact ? trees_[i] : vertex_trees_->trees[i].tree).closest(p, radius);
  if (!closest) return std::nullopt;
  std::uint32_t triangle = interface.first + closest->triangle;
  TriangleFeature feature = closest->feature;
  if (!exact) {
    const auto& corner = vertex_trees_->trees[i].corners[closest->triangle];
    triangle = corner.triangle;
    feature = corner.feature;
  }
  const double distance = std::sqrt(closest->squared_distance);
  const double height = dot(p - closest->point, interface_normal(triangle, feature));
  const bool continued = exact && on_border(triangle, feature, kEdgeOfInterface, kCornerOfInterface);
  double value = continued ? height : (height >= 0 ? distance : -distance);
  if (body == interface.a && value < 0) value = distance;
  if (body == interface.b && value > 0) value = -distance;
  return NearInterface{i, value, closest->point};
}

void InterfaceNetwork::build_vertex_trees() const {
  auto& trees = vertex_trees_->trees;
  trees.resize(interfaces_.size());
  parallel_for(interfaces_.size(), 1, [&](std::size_t i) {
    const Interface& interface = interfaces_[InterfaceId(i)];
    std::map<std::uint32_t, VertexTrees::Corner> corners;
    for (std::uint32_t t = interface.first; t < interface.first + interface.count; ++t) {
      for (unsigned k = 0; k < 3; ++k)
        corners.try_emplace(triangles_[t][k], VertexTrees::Corner{t, vertex_feature(k)});
    }
    std::vector<ClosestPointTree::Triangle> vertices;
    for (const auto& [point, corner] : corners) {
      vertices.push_back({point, point, point});
      trees[InterfaceId(i)].corners.push_back(corner);
    }
    trees[InterfaceId(i)].tree = ClosestPointTree(points_, vertices);
  });
}

}  // namespace adamas
