#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/mending.h"

namespace adamas::interfaces {

namespace {

std::array<double, 3> as_array(const Vec3& p) { return {p.x, p.y, p.z}; }

/// An edge of a single triangle inside the domain, from a corner of that triangle to the next one.
struct BorderEdge {
  std::uint32_t triangle, corner;
  std::array<std::uint32_t, 2> ends;  ///< welded
};

/// The open borders of a mesh.
struct Borders {
  Borders(const InterfaceMesh& mesh, const Box3* domain);
  [[nodiscard]] bool has(std::uint32_t point) const {
    return std::binary_search(points.begin(), points.end(), point);
  }
  std::vector<BorderEdge> edges;      ///< by triangle and corner
  std::vector<std::uint32_t> points;  ///< their ends, ascending
  std::vector<std::uint32_t> welded;  ///< of each point of the mesh the lowest one with the same coordinates
  std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours;  ///< of each point along the borders
  ClosestPointTree tree;                                           ///< of the edges
};

Borders::Borders(const InterfaceMesh& mesh, const Box3* domain) {
  const EdgeFans fans(mesh, domain);
  EdgeFans::Fan fan;
  for (std::uint32_t p = 0; p < mesh.points.size(); ++p) welded.push_back(fans.welded(p));
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    if (fans.valence(edge) != 1 || fans.on_domain_boundary(edge)) continue;
    fans.fan(edge, fan);
    const std::uint32_t t = fan.blades.front().triangle;
    const auto [low, high] = fans.ends(edge);
    const auto& p = mesh.triangles[t].points;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = welded[p[i]], b = welded[p[(i + 1) % 3]];
      if (std::min(a, b) == low && std::max(a, b) == high) edges.push_back({t, i, {a, b}});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
    return std::tie(a.triangle, a.corner) < std::tie(b.triangle, b.corner);
  });
  std::vector<ClosestPointTree::Triangle> segments;
  for (const BorderEdge& e : edges) {
    points.insert(points.end(), e.ends.begin(), e.ends.end());
    neighbours[e.ends[0]].push_back(e.ends[1]);
    neighbours[e.ends[1]].push_back(e.ends[0]);
    segments.push_back({e.ends[0], e.ends[1], e.ends[1]});
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  tree = ClosestPointTree(mesh.points, segments);
}

class GapClosing {
 public:
  GapClosing(InterfaceMesh& mesh, const Box3* domain, double tolerance)
      : mesh_(mesh), domain_(domain), tolerance_(tolerance) {}

  ClosedGaps run() {
    Borders borders(mesh_, domain_);
    if (borders.edges.empty()) return {};
    move_onto_faces(borders);
    if (result_.points_on_faces.count > 0) borders = Borders(mesh_, domain_);
    weld(borders);
    if (result_.welded_points.count > 0) borders = Borders(mesh_, domain_);
    split(borders);
    return result_;
  }

 private:
  /// A possible weld: two points of borders near each other.
  struct Pair {
    double squared_distance;
    std::uint32_t a, b;  ///< a before b by their coordinates
  };
  /// Points that become one.
  struct Cluster {
    std::vector<std::uint32_t> points, neighbours;
  };

  /// Gives all points of the mesh that are welded to `point` another place.
  void move(const Borders& borders, const std::map<std::uint32_t, Vec3>& places, Mended& kind) {
    for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
      const auto at = places.find(borders.welded[p]);
      if (at == places.end()) continue;
      if (borders.welded[p] == p) kind.add(at->second);
      mesh_.points[p] = at->second;
    }
  }

  void move_onto_faces(const Borders& borders) {
    if (domain_ == nullptr) return;
    std::map<std::uint32_t, Vec3> places;
    for (const BorderEdge& e : borders.edges) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double face : {domain_->min[axis], domain_->max[axis]}) {
          const auto off = [&](std::uint32_t p) { return std::abs(mesh_.points[p][axis] - face); };
          if (off(e.ends[0]) > tolerance_ || off(e.ends[1]) > tolerance_) continue;
          for (const std::uint32_t p : e.ends) {
            if (off(p) > 0) places.try_emplace(p, mesh_.points[p]).first->second[axis] = face;
          }
        }
      }
    }
    move(borders, places, result_.points_on_faces);
  }

  [[nodiscard]] bool before(std::uint32_t a, std::uint32_t b) const {
    return as_array(mesh_.points[a]) < as_array(mesh_.points[b]);
  }
  void find_near(const Borders& borders, const Vec3& p, std::vector<std::uint32_t>& edges) const {
    const Vec3 margin{tolerance_, tolerance_, tolerance_};
    borders.tree.overlapping({p - margin, p + margin}, edges);
  }

  /// Whether a border runs from one point to the other by a single point between them, nearer to both: no gap
  /// is between them then, and as one point they would fold the border.
  [[nodiscard]] bool follow_each_other(const Borders& borders, std::uint32_t p, std::uint32_t q) const {
    const std::vector<std::uint32_t>&of_p = borders.neighbours.at(p), &of_q = borders.neighbours.at(q);
    const double apart = squared_norm(mesh_.points[q] - mesh_.points[p]);
    std::size_t common = 0;
    bool between = false;
    for (const std::uint32_t n : of_p) {
      if (std::find(of_q.begin(), of_q.end(), n) == of_q.end()) continue;
      ++common;
      between = std::max(squared_norm(mesh_.points[n] - mesh_.points[p]),
                         squared_norm(mesh_.points[n] - mesh_.points[q])) < apart;
    }
    return common == 1 && between;
  }

  [[nodiscard]] std::vector<Pair> find_pairs(const Borders& borders) const {
    std::vector<Pair> pairs;
    std::vector<std::uint32_t> near;
    for (const std::uint32_t p : borders.points) {
      find_near(borders, mesh_.points[p], near);
      for (const std::uint32_t e : near) {
        for (const std::uint32_t q : borders.edges[e].ends) {
          const double squared = squared_norm(mesh_.points[q] - mesh_.points[p]);
          if (squared > tolerance_ * tolerance_ || !before(p, q) || follow_each_other(borders, p, q))
            continue;
          pairs.push_back({squared, p, q});
        }
      }
    }
    std::sort(pairs.begin(), pairs.end(), [this](const Pair& x, const Pair& y) {
      const auto key = [this](const Pair& p) {
        return std::tuple(p.squared_distance, as_array(mesh_.points[p.a]), as_array(mesh_.points[p.b]));
      };
      return key(x) < key(y);
    });
    return pairs;
  }

  void weld(const Borders& borders) {
    const std::vector<Pair> pairs = find_pairs(borders);
    if (pairs.empty()) return;
    std::map<std::uint32_t, Cluster> clusters;  // by their first points
    std::map<std::uint32_t, std::uint32_t> cluster_of;
    for (const Pair& p : pairs) {
      for (const std::uint32_t point : {p.a, p.b}) {
        clusters[point].points = {point};
        cluster_of[point] = point;
      }
    }
    for (const InterfaceTriangle& t : mesh_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto at = clusters.find(borders.welded[t.points[i]]);
        if (at == clusters.end()) continue;
        for (const std::size_t k : {(i + 1) % 3, (i + 2) % 3})
          at->second.neighbours.push_back(borders.welded[t.points[k]]);
      }
    }
    for (const Pair& p : pairs) {
      const std::uint32_t a = cluster_of[p.a], b = cluster_of[p.b];
      if (a == b || touch(clusters[a], clusters[b])) continue;
      Cluster from = std::move(clusters[b]);
      clusters.erase(b);
      for (const std::uint32_t point : from.points) cluster_of[point] = a;
      Cluster& to = clusters[a];
      to.points.insert(to.points.end(), from.points.begin(), from.points.end());
      to.neighbours.insert(to.neighbours.end(), from.neighbours.begin(), from.neighbours.end());
    }
    std::map<std::uint32_t, Vec3> places;
    for (const auto& [first, cluster] : clusters) {
      if (cluster.points.size() < 2) continue;
      const Vec3 place = place_of(cluster);
      for (const std::uint32_t p : cluster.points) {
        if (mesh_.points[p] != place) places[p] = place;
      }
    }
    move(borders, places, result_.welded_points);
  }

  /// The first of the points by coordinates, but on all faces of the domain that any of them lies on.
  [[nodiscard]] Vec3 place_of(const Cluster& cluster) const {
    const auto less = [this](std::uint32_t a, std::uint32_t b) { return before(a, b); };
    Vec3 place = mesh_.points[*std::min_element(cluster.points.begin(), cluster.points.end(), less)];
    for (const std::uint32_t p : cluster.points) {
      const Vec3 outward = outward_of_edge(domain_, mesh_.points[p], mesh_.points[p]);
      for (int axis = 0; axis < 3; ++axis) {
        if (outward[axis] != 0) place[axis] = outward[axis] < 0 ? domain_->min[axis] : domain_->max[axis];
      }
    }
    return place;
  }

  /// Whether a triangle has corners in both.
  static bool touch(const Cluster& a, const Cluster& b) {
    return std::any_of(a.neighbours.begin(), a.neighbours.end(), [&b](std::uint32_t p) {
      return std::find(b.points.begin(), b.points.end(), p) != b.points.end();
    });
  }

  /// Points that lie on an edge, from its start on.
  using OnEdge = std::vector<std::uint32_t>;

  void split(const Borders& borders) {
    std::vector<OnEdge> found(borders.edges.size());
    std::vector<std::uint32_t> near;
    for (const std::uint32_t p : borders.points) {
      find_near(borders, mesh_.points[p], near);
      for (const std::uint32_t e : near) {
        if (lies_on(borders, p, borders.edges[e])) found[e].push_back(p);
      }
    }
    for (std::size_t e = 0, next = 0; e < found.size(); e = next) {
      const std::uint32_t t = borders.edges[e].triangle;
      std::array<OnEdge, 3> on;
      for (; next < found.size() && borders.edges[next].triangle == t; ++next) {
        const Vec3 start = mesh_.points[borders.edges[next].ends[0]];
        const auto key = [&](std::uint32_t p) {
          return std::pair(squared_norm(mesh_.points[p] - start), as_array(mesh_.points[p]));
        };
        std::sort(found[next].begin(), found[next].end(),
                  [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
        if (!found[next].empty()) result_.split_edges.add(mesh_.points[found[next].front()]);
        on[borders.edges[next].corner] = std::move(found[next]);
      }
      const InterfaceTriangle whole = mesh_.triangles[t];
      parts_.clear();
      divide(whole.points, on);
      if (parts_.size() == 1) continue;
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const InterfaceTriangle part{parts_[i], whole.front, whole.back};
        if (i == 0) {
          mesh_.triangles[t] = part;
        } else {
          mesh_.triangles.push_back(part);
        }
      }
    }
  }

  [[nodiscard]] bool lies_on(const Borders& borders, std::uint32_t p, const BorderEdge& e) const {
    for (const std::uint32_t corner : mesh_.triangles[e.triangle].points) {
      if (borders.welded[corner] == p) return false;
    }
    const Vec3 &at = mesh_.points[p], &a = mesh_.points[e.ends[0]], &b = mesh_.points[e.ends[1]];
    const Vec3 edge = b - a;
    const double along = dot(at - a, edge) / squared_norm(edge);
    if (!(along > 0 && along < 1)) return false;
    if (distance(at, a) <= tolerance_ || distance(at, b) <= tolerance_) return false;
    return distance(at, a + along * edge) <= tolerance_;
  }

  /// Divides a triangle at points on its edges; `on[i]` are those from corner i to the next.
  void divide(const std::array<std::uint32_t, 3>& corners, const std::array<OnEdge, 3>& on) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (on[i].empty()) continue;
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
      const std::uint32_t middle = on[i].front();
      divide({a, middle, c}, {OnEdge{}, OnEdge{}, on[(i + 2) % 3]});
      divide({middle, b, c}, {OnEdge(on[i].begin() + 1, on[i].end()), on[(i + 1) % 3], OnEdge{}});
      return;
    }
    parts_.push_back(corners);
  }

  InterfaceMesh& mesh_;
  const Box3* domain_;
  double tolerance_;
  std::vector<std::array<std::uint32_t, 3>> parts_;  ///< of the triangle that is divided
  ClosedGaps result_;
};

}  // namespace

ClosedGaps close_gaps(InterfaceMesh& mesh, const Box3* domain, double tolerance) {
  if (!(tolerance > 0)) return {};
  return GapClosing(mesh, domain, tolerance).run();
}

}  // namespace adamas::interfaces
