#include "interfaces/network/body_winding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "core/base/parallel.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/interface_network.h"

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
    add_second_order(node, 0.75, normal, offset);
    for (const Vec3& p : corners_[i]) {
      add_second_order(node, 1.0 / 12, normal, p - node.center);
      node.radius = std::max(node.radius, distance(p, node.center));
    }
  }
}

void WindingTree::add_second_order(Node& node, double weight, const Vec3& normal, const Vec3& offset) {
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

namespace {

/// The number of triangles at which the bodies' parts of the sphere at infinity are measured.
constexpr std::size_t kSamples = 64;
/// The distance of the measured points from these triangles, relative to the root of their area.
constexpr double kInFront = 1e-3;
/// If no interface reaches the domain's boundary, a body with at least this part of the sphere at infinity
/// has all of it.
constexpr double kSurrounds = 0.75;

}  // namespace

BodyWinding::BodyWinding(const InterfaceNetwork& network, const std::optional<Box3>& domain)
    : table_(network.table()) {
  trees_.resize(table_.interface_count());
  parallel_for(trees_.size(), 1, [&](std::size_t i) {
    const auto& interface = network.interface(InterfaceId(i));
    trees_[InterfaceId(i)] =
        WindingTree(network.points(), network.triangles().subspan(interface.first, interface.count));
  });
  if (domain) find_strips(network, *domain);
  find_offsets(network, domain);
}

void BodyWinding::find_strips(const InterfaceNetwork& network, const Box3& domain) {
  center_ = domain.center();
  // Edges with triangles of an interface in both directions are not on its border.
  std::map<std::tuple<InterfaceId, std::uint32_t, std::uint32_t>, int> edges;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& v = network.triangles()[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = v[i], b = v[(i + 1) % 3];
      if (is_inside_domain(domain, 0.5 * (network.points()[a] + network.points()[b]))) continue;
      edges[{network.interface_of(t), std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto [interface, low, high] = edge;
    const Vec3 &a = network.points()[low], &b = network.points()[high];
    for (int i = 0; i < std::abs(count); ++i)
      strips_.push_back(count > 0 ? Strip{interface, a, b} : Strip{interface, b, a});
  }
}

/// Finds the part of the sphere at infinity that belongs to each body. Beside a triangle the body is known,
/// and the difference between its winding number and the sum of angles is that part. If there are gaps, the
/// samples differ, and their median is taken.
void BodyWinding::find_offsets(const InterfaceNetwork& network, const std::optional<Box3>& domain) {
  struct Sample {
    double area;
    std::array<double, 3> place;
    std::uint32_t triangle;
  };
  std::vector<Sample> samples;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& c = network.triangle_corners(t);
    const Vec3 middle = centroid(c);
    if (domain && !domain->contains(middle)) continue;
    samples.push_back({0.5 * norm(cross(c[1] - c[0], c[2] - c[0])), {middle.x, middle.y, middle.z}, t});
  }
  const std::size_t count = std::min(samples.size(), kSamples);
  std::partial_sort(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count), samples.end(),
                    [](const Sample& a, const Sample& b) {
                      return std::tie(b.area, a.place, a.triangle) < std::tie(a.area, b.place, b.triangle);
                    });
  const std::size_t bodies = table_.body_count();
  offsets_.assign(bodies, 0.0);
  if (count == 0) return;
  IdVector<BodyId, std::vector<double>> left(bodies);
  IdVector<BodyId, double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    const Sample& s = samples[i];
    const Vec3 middle{s.place[0], s.place[1], s.place[2]};
    sum_angles(middle + kInFront * std::sqrt(s.area) * network.normal(s.triangle), numbers);
    numbers[network.interface(network.interface_of(s.triangle)).a] -= 1;
    for (BodyId b(0); b.value < bodies; ++b.value) left[b].push_back(-numbers[b]);
  }
  BodyId greatest(0);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    std::vector<double>& values = left[b];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    offsets_[b] = *middle;
    if (offsets_[b] > offsets_[greatest]) greatest = b;
  }
  if (!strips_.empty() || offsets_[greatest] < kSurrounds) return;
  offsets_.assign(bodies, 0.0);
  offsets_[greatest] = 1;
}

void BodyWinding::sum_angles(const Vec3& p, IdVector<BodyId, double>& numbers) const {
  numbers.assign(table_.body_count(), 0.0);
  const auto add = [&](InterfaceId i, double behind) {
    const auto& [front, back] = table_.sides(i);
    numbers[front] -= behind;
    numbers[back] += behind;
  };
  for (InterfaceId i(0); i.value < trees_.size(); ++i.value) add(i, trees_[i].at(p));
  for (const Strip& s : strips_) {
    const Vec3 from = s.from - p, to = s.to - p;
    const Vec3 from_infinity = s.from - center_, to_infinity = s.to - center_;
    add(s.interface,
        (solid_angle(to, from, from_infinity) + solid_angle(to, from_infinity, to_infinity)) / (4 * M_PI));
  }
}

void BodyWinding::numbers_at(const Vec3& p, IdVector<BodyId, double>& numbers) const {
  sum_angles(p, numbers);
  for (BodyId b(0); b.value < numbers.size(); ++b.value) numbers[b] += offsets_[b];
}

BodyWinding::Answer BodyWinding::at(const Vec3& p) const {
  thread_local IdVector<BodyId, double> numbers;
  numbers_at(p, numbers);
  // Bodies are in the order of their materials.
  Answer best{BodyId(0), -std::numeric_limits<double>::infinity()};
  for (BodyId b(0); b.value < numbers.size();) {
    const MaterialId material = table_.material(b);
    BodyId greatest = b;
    double sum = 0;
    for (; b.value < numbers.size() && table_.material(b) == material; ++b.value) {
      sum += numbers[b];
      if (numbers[b] > numbers[greatest]) greatest = b;
    }
    if (sum > best.number) best = {greatest, sum};
  }
  return best;
}

}  // namespace adamas::interfaces
