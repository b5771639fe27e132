#include "interfaces/network/edge_fans.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"

namespace adamas::interfaces {

namespace {

constexpr double kTieAngle = 1e-3;         // blades with closer angles may be swapped to make their materials
                                           // match
constexpr double kFlat = 1e-8;             // the least ratio of height to length; below it, round-off decides
                                           // the angle
constexpr std::size_t kMostSteps = 20000;  // the greatest number of steps of the search for another order

Vec3 any_perpendicular(const Vec3& v) {
  const Vec3 a{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  const Vec3 axis = a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0} : (a.y <= a.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
  return normalized(cross(v, axis));
}

bool may_swap(const Blade& a, const Blade& b) {
  const double apart = std::abs(a.angle - b.angle);
  return a.flat || b.flat || apart < kTieAngle || 2 * M_PI - apart < kTieAngle;
}

}  // namespace

std::vector<std::uint32_t> weld_points(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Vec3 &a = points[i], &b = points[j];
    return std::tie(a.x, a.y, a.z, i) < std::tie(b.x, b.y, b.z, j);
  });
  std::vector<std::uint32_t> welded(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

template <class Visit>
void EdgeFans::for_each_half_edge(Visit&& visit) const {
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& p = mesh_.triangles[t].points;
    const std::array<std::uint32_t, 3> v{welded_[p[0]], welded_[p[1]], welded_[p[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = v[i], b = v[(i + 1) % 3];
      visit(std::min(a, b), HalfEdge{std::max(a, b), 2 * t + (a < b ? 1u : 0u)});
    }
  }
}

EdgeFans::EdgeFans(const InterfaceMesh& mesh, const Box3* domain, double boundary)
    : mesh_(mesh), domain_(domain), boundary_(boundary), welded_(weld_points(mesh.points)) {
  LoopProgress::check();
  std::vector<std::uint32_t> starts(mesh.points.size() + 1, 0);
  for_each_half_edge([&](std::uint32_t low, const HalfEdge&) { ++starts[low + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  half_edges_.resize(starts.back());
  std::vector<std::uint32_t> next = starts;
  for_each_half_edge([&](std::uint32_t low, const HalfEdge& h) { half_edges_[next[low]++] = h; });
  release_memory(next);
  LoopProgress::check();
  sort_half_edges(std::move(starts));
}

/// Sorts the half edges of each lower end, which begin at `starts`, and finds the edges.
void EdgeFans::sort_half_edges(std::vector<std::uint32_t> starts) {
  std::size_t count = 0;
  const auto is_first = [&](std::uint32_t low, std::uint32_t i) {
    return i == starts[low] || half_edges_[i].high != half_edges_[i - 1].high;
  };
  parallel_for(starts.size() - 1, 4096, [&](std::size_t low) {
    std::sort(half_edges_.begin() + starts[low], half_edges_.begin() + starts[low + 1],
              [](const HalfEdge& a, const HalfEdge& b) {
                return std::tie(a.high, a.packed) < std::tie(b.high, b.packed);
              });
  });
  for (std::uint32_t low = 0; low + 1 < starts.size(); ++low) {
    for (std::uint32_t i = starts[low]; i < starts[low + 1]; ++i) count += is_first(low, i) ? 1 : 0;
  }
  edges_.reserve(count + 1);
  for (std::uint32_t low = 0; low + 1 < starts.size(); ++low) {
    for (std::uint32_t i = starts[low]; i < starts[low + 1]; ++i) {
      if (is_first(low, i)) edges_.push_back({low, i});
    }
  }
  edges_.push_back({0, static_cast<std::uint32_t>(half_edges_.size())});
}

std::array<std::uint32_t, 2> EdgeFans::ends(std::size_t edge) const {
  return {edges_[edge].low, half_edges_[edges_[edge].first].high};
}

Vec3 EdgeFans::outward(std::size_t edge) const {
  const auto [low, high] = ends(edge);
  return outward_of_edge(domain_, mesh_.points[low], mesh_.points[high], boundary_);
}

bool EdgeFans::on_domain_boundary(std::size_t edge) const { return outward(edge) != Vec3{}; }

void EdgeFans::fan(std::size_t edge, Fan& fan) const { order(edge, outward(edge), fan); }

void EdgeFans::wedges(std::size_t edge, Fan& fan) const {
  const Vec3 normal = outward(edge);
  if (valence(edge) > 2 || normal != Vec3{}) return order(edge, normal, fan);
  fan.blades.clear();
  fan.outside_wedge = Fan::kNone;
  for (std::uint32_t i = edges_[edge].first; i < edges_[edge + 1].first; ++i)
    fan.blades.push_back({half_edges_[i].triangle(), half_edges_[i].forward()});
  fan.consistent = consistent(fan);
}

/// Sets `fan` to the blades of an edge in the order of their angles. `normal`: outward() of the edge.
void EdgeFans::order(std::size_t edge, const Vec3& normal, Fan& fan) const {
  fan.blades.clear();
  fan.outside_wedge = Fan::kNone;
  const auto [low, high] = ends(edge);
  const Vec3 origin = mesh_.points[low];
  const Vec3 along = normalized(mesh_.points[high] - origin);
  const double length = distance(mesh_.points[high], origin);
  const Vec3 x = any_perpendicular(along), y = cross(along, x);
  for (std::uint32_t i = edges_[edge].first; i < edges_[edge + 1].first; ++i) {
    const HalfEdge& h = half_edges_[i];
    const auto& p = mesh_.triangles[h.triangle()].points;
    Vec3 third;
    for (const std::uint32_t v : p) {
      if (welded_[v] != low && welded_[v] != high) third = mesh_.points[v] - origin;
    }
    const double u = dot(third, x), v = dot(third, y);
    const bool flat = std::hypot(u, v) <= kFlat * std::max(norm(third), length);
    fan.blades.push_back({h.triangle(), h.forward(), flat, std::atan2(v, u)});
  }
  std::stable_sort(fan.blades.begin(), fan.blades.end(),
                   [](const Blade& a, const Blade& b) { return a.angle < b.angle; });
  if (normal != Vec3{}) {
    const double angle = std::atan2(dot(normal, y), dot(normal, x));
    const auto next = std::upper_bound(fan.blades.begin(), fan.blades.end(), angle,
                                       [](double value, const Blade& b) { return value < b.angle; });
    fan.outside_wedge =
        static_cast<std::size_t>(next == fan.blades.begin() ? fan.blades.end() - fan.blades.begin() - 1
                                                            : next - fan.blades.begin() - 1);
  }
  fan.consistent = consistent(fan) || reorder_ties(fan);
}

bool EdgeFans::consistent(const Fan& fan) const {
  const std::size_t n = fan.blades.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i == fan.outside_wedge || n == 1) continue;
    const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % n];
    if (material(a.triangle, side_ahead(a)) != material(b.triangle, side_behind(b))) return false;
  }
  return true;
}

/// Looks for an order in which materials match and only blades with nearly equal angles have been swapped.
bool EdgeFans::reorder_ties(Fan& fan) const {
  const std::size_t n = fan.blades.size();
  if (n < 3) return false;
  std::size_t steps = 0;
  std::vector<std::size_t> order;
  // Without a boundary the order is cyclic, so the first blade can be fixed.
  if (fan.outside_wedge == Fan::kNone) order.push_back(0);
  if (!extend_order(fan, order, steps)) return false;
  std::vector<Blade> blades;
  for (const std::size_t i : order) blades.push_back(fan.blades[i]);
  fan.blades = std::move(blades);
  return true;
}

bool EdgeFans::extend_order(const Fan& fan, std::vector<std::size_t>& order, std::size_t& steps) const {
  const std::size_t n = fan.blades.size();
  const auto fits = [&](std::size_t i, std::size_t j, std::size_t wedge) {
    const Blade &a = fan.blades[i], &b = fan.blades[j];
    return wedge == fan.outside_wedge ||
           material(a.triangle, side_ahead(a)) == material(b.triangle, side_behind(b));
  };
  if (++steps > kMostSteps) return false;
  if (order.size() == n) return fits(order.back(), order.front(), n - 1);
  for (std::size_t next = 0; next < n; ++next) {
    if (std::find(order.begin(), order.end(), next) != order.end()) continue;
    if (!order.empty() && !fits(order.back(), next, order.size() - 1)) continue;
    bool allowed = true;
    for (std::size_t i = 0; i < next && allowed; ++i) {
      const bool placed = std::find(order.begin(), order.end(), i) != order.end();
      allowed = placed || may_swap(fan.blades[i], fan.blades[next]);
    }
    if (!allowed) continue;
    order.push_back(next);
    if (extend_order(fan, order, steps)) return true;
    order.pop_back();
  }
  return false;
}

std::vector<std::array<std::uint32_t, 2>> junction_lines(const InterfaceMesh& mesh) {
  return junction_lines(mesh.points.size(), mesh.triangles.size(),
                        [&](std::uint32_t t) { return mesh.triangles[t]; });
}

namespace {

/// Marks the points at which three materials meet, or triangles between parts of one material. Only edges
/// between such points can be junction lines.
std::vector<char> junction_points(std::size_t points, std::size_t triangles,
                                  const std::function<InterfaceTriangle(std::uint32_t)>& triangle_at) {
  std::vector<std::array<MaterialId, 2>> first(points);
  std::vector<char> marked(points, 0);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const InterfaceTriangle& triangle = triangle_at(t);
    for (const std::uint32_t p : triangle.points) {
      if (!first[p][0].valid()) first[p] = {triangle.front, triangle.back};
      const auto is_known = [&](MaterialId m) { return m == first[p][0] || m == first[p][1]; };
      if (triangle.front == triangle.back || !is_known(triangle.front) || !is_known(triangle.back))
        marked[p] = 1;
    }
  }
  return marked;
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> junction_lines(
    std::size_t points, std::size_t triangles,
    const std::function<InterfaceTriangle(std::uint32_t)>& triangle_at) {
  struct Use {
    std::array<std::uint32_t, 2> edge;
    std::uint32_t triangle;
  };
  const std::vector<char> marked = junction_points(points, triangles, triangle_at);
  std::vector<Use> uses;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto p = triangle_at(t).points;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(p[i], p[(i + 1) % 3]);
      if (low != high && marked[low] != 0 && marked[high] != 0) uses.push_back({{low, high}, t});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
  });
  std::vector<std::array<std::uint32_t, 2>> lines;
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    const InterfaceTriangle one = triangle_at(uses[first].triangle);
    bool third = false;
    for (; last < uses.size() && uses[last].edge == uses[first].edge; ++last) {
      const InterfaceTriangle other = triangle_at(uses[last].triangle);
      for (const MaterialId m : {other.front, other.back}) third = third || (m != one.front && m != one.back);
    }
    if (third) lines.push_back(uses[first].edge);
  }
  return lines;
}

}  // namespace adamas::interfaces
