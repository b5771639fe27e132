#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/assert.h"
#include "core/base/parallel.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/network_on_demand.h"
#include "interfaces/network/pseudonormals.h"

namespace adamas::interfaces {

namespace {

/// Where there are flat triangles, points closer to each other than this part of the size of the network are
/// one.
constexpr double kTouch = 1e-10;

/// From here on a winding number leaves no doubt.
constexpr double kSure = 0.75;

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
  if (near_flat(closest->triangle, closest->feature)) return body_by_touch(p, *closest, flagged);
  if (closest->feature == TriangleFeature::kFace) {
    return dot(offset, normals_[closest->triangle]) >= 0 ? interface.a : interface.b;
  }
  if (on_border(closest->triangle, closest->feature, kEdgeOfNetwork, kCornerOfNetwork)) {
    const BodyId continued = body_by_arc(offset, closest->triangle, closest->feature);
    return on_domain_boundary(closest->point) ? continued : body_beyond_border(p, continued, flagged);
  }

  Pseudonormals normals;
  for_each_at(closest->triangle, closest->feature, [&](std::uint32_t t, double weight) {
    const Interface& at = interfaces_[interface_of_[t]];
    normals.add(at.a, weight * normals_[t]);
    normals.add(at.b, -weight * normals_[t]);
  });
  const auto best = normals.greatest(offset);
  return best.clear ? best.body : body_by_arc(offset, closest->triangle, closest->feature);
}

bool InterfaceNetwork::near_flat(std::uint32_t triangle, TriangleFeature feature) const {
  return bit(borders_[triangle], feature == TriangleFeature::kFace ? kFlat : kNearFlat);
}

bool InterfaceNetwork::find_touching(const ClosestPointTree& tree, std::uint32_t first, const Vec3& p,
                                     unsigned edge_bit, std::vector<Touch>& out) const {
  out.clear();
  const double reach = kTouch * tree_.bounds().diagonal();
  const Vec3 margin{reach, reach, reach};
  thread_local std::vector<std::uint32_t> found;
  tree.overlapping({p - margin, p + margin}, found);
  bool border = false;
  for (const std::uint32_t local : found) {
    const std::uint32_t t = first + local;
    const std::array<Vec3, 3>& c = triangle_corners(t);
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

/// The body that winding numbers tell where they leave no doubt, else `continued`, the body that the sheet at
/// the border tells.
BodyId InterfaceNetwork::body_beyond_border(const Vec3& p, BodyId continued, bool* flagged) const {
  std::call_once(on_demand_->winding_built, [this] { on_demand_->winding.emplace(*this, domain_); });
  const BodyWinding::Answer answer = on_demand_->winding->at(p);
  const bool sure = answer.number >= kSure;
  if (flagged != nullptr) *flagged = !sure || table_.material(answer.body) != table_.material(continued);
  return sure ? answer.body : continued;
}

BodyId InterfaceNetwork::body_by_touch(const Vec3& p, const ClosestPoint& closest, bool* flagged) const {
  thread_local std::vector<Touch> touching;
  const bool border = find_touching(tree_, 0, closest.point, kEdgeOfNetwork, touching);
  Pseudonormals normals;
  for (const auto& [t, weight] : touching) {
    if (weight == 0) continue;
    const Interface& at = interfaces_[interface_of_[t]];
    normals.add(at.a, weight * normals_[t]);
    normals.add(at.b, -weight * normals_[t]);
  }
  const auto best = normals.greatest(p - closest.point);
  const BodyId body = best.body.valid() ? best.body : interfaces_[interface_of_[closest.triangle]].a;
  return border && !on_domain_boundary(closest.point) ? body_beyond_border(p, body, flagged) : body;
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
    // The search goes farther than the bound itself, since squares of roots are not exact.
    const double bound = best ? std::sqrt(best->squared_distance) * (1 + 1e-15) : max_distance;
    if (squared_distance(interfaces_[i].bounds, p) > bound * bound) continue;
    auto closest = tree(i).closest(p, bound);
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
    std::call_once(on_demand_->vertices_built, [this] { build_vertex_trees(); });
  thread_local std::vector<std::uint32_t> candidates;
  box_tree_.near(p, radius, candidates);
  for (const std::uint32_t i : candidates) {
    if (const auto found = near_interface(InterfaceId(i), p, radius, body_of_p, mode)) out.push_back(*found);
  }
}

/// The nearest vertex of an interface in the form of a closest point: as a corner of one of its triangles.
std::optional<ClosestPoint> InterfaceNetwork::nearest_vertex(InterfaceId i, const Vec3& p,
                                                             double radius) const {
  const OnDemand::Vertices& vertices = on_demand_->vertices[i];
  const auto nearest = vertices.tree.closest(p, radius);
  if (!nearest) return std::nullopt;
  const OnDemand::Corner& corner = vertices.corners[nearest->triangle];
  return ClosestPoint{triangle_corners(corner.triangle)[feature_index(corner.feature)],
                      nearest->squared_distance, corner.triangle - interfaces_[i].first, corner.feature};
}

std::optional<NearInterface> InterfaceNetwork::near_interface(InterfaceId i, const Vec3& p, double radius,
                                                              BodyId body, DistanceMode mode) const {
  const Interface& interface = interfaces_[i];
  const auto closest =
      mode == DistanceMode::kExact ? tree(i).closest(p, radius) : nearest_vertex(i, p, radius);
  if (!closest) return std::nullopt;
  const std::uint32_t triangle = interface.first + closest->triangle;
  const TriangleFeature feature = closest->feature;
  const double distance = std::sqrt(closest->squared_distance);
  Vec3 normal;
  bool border = false;
  if (near_flat(triangle, feature)) {
    thread_local std::vector<Touch> touching;
    border = find_touching(tree(i), interface.first, closest->point, kEdgeOfInterface, touching);
    for (const Touch& touch : touching) normal += touch.weight * normals_[touch.triangle];
    normal = normalized(normal);
  } else {
    border = on_border(triangle, feature, kEdgeOfInterface, kCornerOfInterface);
    normal = interface_normal(triangle, feature);
  }
  const double height = dot(p - closest->point, normal);
  const bool continued = mode == DistanceMode::kExact && border;
  double value = continued ? height : (height >= 0 ? distance : -distance);
  // A point on the continued plane is on both sides of it: there the sign tells nothing.
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
  thread_local std::vector<Touch> touching;
  return find_touching(tree(i), interfaces_[i].first, closest, kEdgeOfNetwork, touching);
}

void InterfaceNetwork::build_vertex_trees() const {
  auto& trees = on_demand_->vertices;
  trees.resize(interfaces_.size());
  parallel_for(interfaces_.size(), 1, [&](std::size_t i) {
    const Interface& interface = interfaces_[InterfaceId(i)];
    std::map<std::uint32_t, OnDemand::Corner> corners;
    for (std::uint32_t t = interface.first; t < interface.first + interface.count; ++t) {
      for (unsigned k = 0; k < 3; ++k)
        corners.try_emplace(triangles_[t][k], OnDemand::Corner{t, vertex_feature(k)});
    }
    std::vector<ClosestPointTree::Triangle> vertices;
    for (const auto& [point, corner] : corners) {
      vertices.push_back({point, point, point});
      trees[InterfaceId(i)].corners.push_back(corner);
    }
    trees[InterfaceId(i)].tree = ClosestPointTree(points_, vertices);
  });
}

}  // namespace adamas::interfaces
