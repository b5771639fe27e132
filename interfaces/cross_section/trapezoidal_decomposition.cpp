#include "interfaces/cross_section/trapezoidal_decomposition.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <set>

#include "adamas/geometry.h"
#include "core/base/sort_unique.h"
#include "interfaces/network/box_tree.h"

namespace adamas::interfaces {

namespace {

using Rounded = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Exact::Point_2;

/// Returns segments directed from the lower end to the greater one, in lexicographic order; those without a
/// length are left out.
std::vector<PlaneSegment> ascending(std::span<const PlaneSegment> segments) {
  std::vector<PlaneSegment> result;
  for (const auto& [a, b] : segments) {
    if (a != b) result.push_back({std::min(a, b), std::max(a, b)});
  }
  return result;
}

int side(const PlaneSegment& s, const PlanePoint& p) {
  const auto at = [](const PlanePoint& q) { return Rounded::Point_2(q[0], q[1]); };
  return CGAL::orientation(at(s[0]), at(s[1]), at(p));
}

/// A vertex of the decomposition on a segment.
struct Node {
  ExactPoint point;
  std::uint32_t segment;
};

/// Appends the points at which one of two segments has to be divided because of the other.
void append_meetings(std::span<const PlaneSegment> segments, std::uint32_t i, std::uint32_t j,
                     std::vector<Node>& nodes) {
  const PlaneSegment &a = segments[i], &b = segments[j];
  const std::array<int, 2> of_a{side(b, a[0]), side(b, a[1])}, of_b{side(a, b[0]), side(a, b[1])};
  const auto exact = [](const PlanePoint& p) { return ExactPoint(p[0], p[1]); };
  for (std::size_t end = 0; end < 2; ++end) {
    if (of_a[end] == 0 && b[0] < a[end] && a[end] < b[1]) nodes.push_back({exact(a[end]), j});
    if (of_b[end] == 0 && a[0] < b[end] && b[end] < a[1]) nodes.push_back({exact(b[end]), i});
  }
  if (of_a[0] * of_a[1] >= 0 || of_b[0] * of_b[1] >= 0) return;
  const Exact::Line_2 first(exact(a[0]), exact(a[1])), second(exact(b[0]), exact(b[1]));
  const auto crossing = CGAL::intersection(first, second);
  const auto& point = boost::get<ExactPoint>(*crossing);
  nodes.push_back({point, i});
  nodes.push_back({point, j});
}

/// Returns all ends of segments and the points where they meet.
std::vector<Node> find_nodes(std::span<const PlaneSegment> segments) {
  std::vector<Box3> boxes(segments.size());
  std::vector<Node> nodes;
  for (std::uint32_t s = 0; s < segments.size(); ++s) {
    for (const auto& [x, y] : segments[s]) {
      boxes[s].extend({x, y, 0});
      nodes.push_back({ExactPoint(x, y), s});
    }
  }
  std::vector<std::array<std::uint32_t, 2>> pairs;
  std::mutex mutex;
  BoxTree(boxes).for_each_touching_pair([&](std::uint32_t i, std::uint32_t j) {
    const std::lock_guard lock(mutex);
    pairs.push_back({i, j});
  });
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [i, j] : pairs) append_meetings(segments, i, j, nodes);
  return nodes;
}

/// Segments divided where they meet: the edges are distinct and have only ends in common. Vertices are
/// numbered in lexicographic order, and each edge runs from the lower one to the greater one.
struct PlanarGraph {
  explicit PlanarGraph(std::span<const PlaneSegment> segments);

  std::vector<ExactPoint> exact;
  std::vector<PlanePoint> rounded;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< ascending
};

PlanarGraph::PlanarGraph(std::span<const PlaneSegment> segments) {
  std::vector<Node> nodes = find_nodes(segments);
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
    const auto order = CGAL::compare_xy(a.point, b.point);
    return order != CGAL::EQUAL ? order == CGAL::SMALLER : a.segment < b.segment;
  });
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> last(segments.size(), kNone);
  for (const Node& node : nodes) {
    if (exact.empty() || exact.back() != node.point) exact.push_back(node.point);
    const auto vertex = static_cast<std::uint32_t>(exact.size() - 1);
    if (last[node.segment] != kNone && last[node.segment] != vertex)
      edges.push_back({last[node.segment], vertex});
    last[node.segment] = vertex;
  }
  sort_unique(edges);
  for (const ExactPoint& p : exact) rounded.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y())});
}

/// Sweeps over the plane from vertex to vertex, and holds the edges that a line along the second axis meets.
/// The line is tilted slightly, so that the lower one of two vertices on it comes first.
class Sweep {
 public:
  explicit Sweep(const PlanarGraph& graph) : graph_(graph), active_(Below{&graph.exact}) {}
  std::vector<Trapezoid> run();

 private:
  struct Edge {
    std::uint32_t from, to;
    mutable std::uint32_t open_since;  ///< the vertex where the trapezoid above this edge begins
  };
  /// Orders edges along the line, and vertices on the line relative to them. An edge that ends at a vertex is
  /// neither above nor below it.
  struct Below {
    using is_transparent = void;
    const std::vector<ExactPoint>* at;
    [[nodiscard]] int side(const Edge& e, std::uint32_t vertex) const {
      return CGAL::orientation((*at)[e.from], (*at)[e.to], (*at)[vertex]);
    }
    bool operator()(const Edge& e, std::uint32_t vertex) const { return side(e, vertex) > 0; }
    bool operator()(std::uint32_t vertex, const Edge& e) const { return side(e, vertex) < 0; }
    bool operator()(const Edge& a, const Edge& b) const {
      if (a.from == b.from) return side(a, b.to) > 0;
      return a.from < b.from ? side(a, b.from) > 0 : side(b, a.from) < 0;
    }
  };
  void close(const Edge& bottom, const Edge& top, std::uint32_t end);
  [[nodiscard]] double height(const Edge& e, double x) const;

  const PlanarGraph& graph_;
  std::set<Edge, Below> active_;
  std::vector<Trapezoid> result_;
};

std::vector<Trapezoid> Sweep::run() {
  auto edge = graph_.edges.begin();
  for (std::uint32_t v = 0; v < graph_.exact.size(); ++v) {
    const auto [first, last] = active_.equal_range(v);
    // The trapezoids at the vertex end, and others begin.
    const auto before = first == active_.begin() ? first : std::prev(first);
    for (auto bottom = before; bottom != last && std::next(bottom) != active_.end(); ++bottom)
      close(*bottom, *std::next(bottom), v);
    if (first != active_.begin()) before->open_since = v;
    active_.erase(first, last);
    for (; edge != graph_.edges.end() && (*edge)[0] == v; ++edge) active_.insert({v, (*edge)[1], v});
  }
  return std::move(result_);
}

double Sweep::height(const Edge& e, double x) const {
  const auto& [x0, y0] = graph_.rounded[e.from];
  const auto& [x1, y1] = graph_.rounded[e.to];
  if (x <= x0) return y0;
  if (x >= x1) return y1;
  return std::clamp(y0 + (x - x0) / (x1 - x0) * (y1 - y0), std::min(y0, y1), std::max(y0, y1));
}

void Sweep::close(const Edge& bottom, const Edge& top, std::uint32_t end) {
  const double left = graph_.rounded[bottom.open_since][0], right = graph_.rounded[end][0];
  if (!(left < right)) return;
  const double low_left = height(bottom, left), low_right = height(bottom, right);
  const double high_left = std::max(low_left, height(top, left)),
               high_right = std::max(low_right, height(top, right));
  Trapezoid trapezoid{{{left, low_left}, {right, low_right}}};
  if (high_right > low_right) trapezoid.corners.push_back({right, high_right});
  if (high_left > low_left) trapezoid.corners.push_back({left, high_left});
  if (trapezoid.corners.size() > 2) result_.push_back(std::move(trapezoid));
}

}  // namespace

PlanePoint Trapezoid::middle() const {
  PlanePoint sum{};
  for (const auto& [x, y] : corners) sum = {sum[0] + x, sum[1] + y};
  const auto count = static_cast<double>(corners.size());
  return {sum[0] / count, sum[1] / count};
}

std::vector<Trapezoid> trapezoidal_decomposition(std::span<const PlaneSegment> segments) {
  return Sweep(PlanarGraph(ascending(segments))).run();
}

}  // namespace adamas::interfaces
