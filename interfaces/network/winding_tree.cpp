#include "interfaces/network/winding_tree.h"

#include <algorithm>
#include <cmath>

namespace adamas::interfaces {

namespace {

constexpr std::uint32_t kLeafSize = 8;
/// Parts farther away than this many of their radii are approximated by their expansion.
constexpr double kFar = 3;
constexpr std::size_t kStackSize = 128;

Vec3 centroid(const std::array<Vec3, 3>& c) { return (1.0 / 3) * (c[0] + c[1] + c[2]); }
Vec3 doubled_normal(const std::array<Vec3, 3>& c) { return cross(c[1] - c[0], c[2] - c[0]); }

}  // namespace

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double x = norm(a), y = norm(b), z = norm(c);
  return 2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
}

WindingTree::WindingTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  for (const Triangle& t : triangles) corners_.push_back({points[t[0]], points[t[1]], points[t[2]]});
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(corners_.size()));
}

void WindingTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  summarize(nodes_[node], begin, end);
  nodes_[node].first = begin;
  nodes_[node].count = end - begin;
  if (end - begin <= kLeafSize) return;
  Box3 box;
  for (std::uint32_t i = begin; i < end; ++i) box.extend(centroid(corners_[i]));
  const Vec3 size = box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(corners_.begin() + begin, corners_.begin() + middle, corners_.begin() + end,
                   [axis](const auto& a, const auto& b) { return centroid(a)[axis] < centroid(b)[axis]; });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = first;
  nodes_[node].count = 0;
  build(first, begin, middle);
  build(first + 1, middle, end);
}

void WindingTree::summarize(Node& node, std::uint32_t begin, std::uint32_t end) const {
  double area = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vec3 normal = doubled_normal(corners_[i]);
    area += norm(normal);
    node.normal += 0.5 * normal;
    node.center += norm(normal) * centroid(corners_[i]);
  }
  node.center = area > 0 ? (1 / area) * node.center : corners_[begin][0];
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vec3 normal = 0.5 * doubled_normal(corners_[i]), offset = centroid(corners_[i]) - node.center;
    for (int axis = 0; axis < 3; ++axis)
      node.moments[static_cast<std::size_t>(axis)] += normal[axis] * offset;
    // The mean of a quadratic function over a triangle is computed from its corners and its centroid.
    add_second(node, 0.75, normal, offset);
    for (const Vec3& p : corners_[i]) {
      add_second(node, 1.0 / 12, normal, p - node.center);
      node.radius = std::max(node.radius, distance(p, node.center));
    }
  }
}

void WindingTree::add_second(Node& node, double weight, const Vec3& normal, const Vec3& offset) {
  const Vec3 n = weight * normal;
  const Vec3& d = offset;
  node.second += 2 * dot(d, n) * d + squared_norm(d) * n;
  const std::array<double, 10> cubic{n.x * d.x * d.x,
                                     n.y * d.y * d.y,
                                     n.z * d.z * d.z,
                                     n.y * d.x * d.x + 2 * n.x * d.x * d.y,
                                     n.z * d.x * d.x + 2 * n.x * d.x * d.z,
                                     n.x * d.y * d.y + 2 * n.y * d.x * d.y,
                                     n.z * d.y * d.y + 2 * n.y * d.y * d.z,
                                     n.x * d.z * d.z + 2 * n.z * d.x * d.z,
                                     n.y * d.z * d.z + 2 * n.z * d.y * d.z,
                                     2 * (n.x * d.y * d.z + n.y * d.x * d.z + n.z * d.x * d.y)};
  for (std::size_t i = 0; i < cubic.size(); ++i) node.cubic[i] += cubic[i];
}

/// Returns the integral of n . f over the triangles, with f(r) = r / |r|^3 expanded round the centre to
/// second order.
double WindingTree::far_angle(const Node& node, const Vec3& r) {
  const double squared = squared_norm(r);
  const double cubed = squared * std::sqrt(squared);
  double trace = 0, along = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3& row = node.moments[static_cast<std::size_t>(axis)];
    trace += row[axis];
    along += r[axis] * dot(row, r);
  }
  const std::array<double, 10>& c = node.cubic;
  const double cubic = r.x * r.x * (c[0] * r.x + c[3] * r.y + c[4] * r.z) +
                       r.y * r.y * (c[5] * r.x + c[1] * r.y + c[6] * r.z) +
                       r.z * r.z * (c[7] * r.x + c[8] * r.y + c[2] * r.z) + c[9] * r.x * r.y * r.z;
  const double second = (7.5 * cubic / squared - 1.5 * dot(node.second, r)) / squared;
  return (dot(node.normal, r) + trace - 3 * along / squared + second) / cubed;
}

double WindingTree::at(const Vec3& p) const {
  if (nodes_.empty()) return 0;
  double angle = 0;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Vec3 offset = node.center - p;
    if (squared_norm(offset) > kFar * kFar * node.radius * node.radius) {
      angle += far_angle(node, offset);
    } else if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
    } else {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        angle += solid_angle(corners_[i][0] - p, corners_[i][1] - p, corners_[i][2] - p);
    }
  }
  return angle / (4 * M_PI);
}

}  // namespace adamas::interfaces
