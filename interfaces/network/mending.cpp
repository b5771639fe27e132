#include "interfaces/network/mending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "adamas/text.h"
#include "core/base/sort_unique.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/interface_mesh_check.h"

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
  std::vector<BorderEdge> edges;      ///< in the order of triangles and corners
  std::vector<std::uint32_t> points;  ///< the ends of the edges, ascending
  std::vector<std::uint32_t> welded;  ///< for each point of the mesh, the lowest one with the same
                                      ///< coordinates
  /// The neighbours of each point along the borders.
  std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours;
  ClosestPointTree tree;  ///< finds edges
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
  sort_unique(points);
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
  /// A set of points that become one.
  struct Cluster {
    std::vector<std::uint32_t> points, neighbours;
  };

  /// Moves points, with all points that are welded to them, to other places.
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

  /// Returns whether a border runs from one point to the other through a single point between them that is
  /// closer to both. Then there is no gap between them, and welding them would fold the border.
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

  /// Returns the first of the points by coordinates, moved onto all faces of the domain on which any of them
  /// lies.
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

  /// Returns whether a triangle has corners in both clusters.
  static bool touch(const Cluster& a, const Cluster& b) {
    return std::any_of(a.neighbours.begin(), a.neighbours.end(), [&b](std::uint32_t p) {
      return std::find(b.points.begin(), b.points.end(), p) != b.points.end();
    });
  }

  /// The points on an edge, ordered from its start.
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
  std::vector<std::array<std::uint32_t, 3>> parts_;  ///< the parts of the triangle that is divided
  ClosedGaps result_;
};

}  // namespace

ClosedGaps close_gaps(InterfaceMesh& mesh, const Box3* domain, double tolerance) {
  if (!(tolerance > 0)) return {};
  return GapClosing(mesh, domain, tolerance).run();
}

namespace {

using Corners = std::array<std::uint32_t, 3>;
/// The materials in front of a triangle and behind it, if its corners are in ascending order.
using Sides = std::pair<MaterialId, MaterialId>;

struct Item {
  Corners corners;  ///< the ranks of the corners in the order of coordinates, ascending
  std::uint32_t triangle;
  Sides sides;
};

/// A range of items on the same points: `items[begin, end)`.
struct Group {
  std::size_t begin, end;
};

bool is_odd(const Corners& c) { return (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2])); }

/// Returns the two sides of a stack of layers: the material that is in front once more than behind, and the
/// one that is behind once more than in front. Both are invalid if the stack has the same material on either
/// side; there is no result if this is no stack.
std::optional<Sides> ends_of_stack(const std::vector<Sides>& sides) {
  std::vector<std::pair<MaterialId, int>> balance;
  const auto count = [&balance](MaterialId m, int step) {
    const auto at = std::find_if(balance.begin(), balance.end(), [m](const auto& b) { return b.first == m; });
    if (at == balance.end()) {
      balance.emplace_back(m, step);
    } else {
      at->second += step;
    }
  };
  for (const auto& [front, back] : sides) count(front, 1), count(back, -1);
  Sides ends;
  for (const auto& [material, n] : balance) {
    if (n == 0) continue;
    MaterialId& end = n > 0 ? ends.first : ends.second;
    if (std::abs(n) > 1 || end.valid()) return std::nullopt;
    end = material;
  }
  return ends;
}

class Merging {
 public:
  Merging(InterfaceMesh& mesh, const Box3* domain, bool tolerant)
      : mesh_(mesh), domain_(domain), tolerant_(tolerant) {}

  CoincidentTriangles run() {
    find_groups();
    if (groups_.empty()) return {};
    removed_.assign(mesh_.triangles.size(), 0);
    for (const Group& g : groups_) merge(g);
    if (!tolerant_ && !cancelled_.empty()) check_holes();
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (removed_[t] == 0) mesh_.triangles[kept++] = mesh_.triangles[t];
    }
    mesh_.triangles.resize(kept);
    return result_;
  }

 private:
  void find_groups() {
    const std::vector<std::uint32_t> place = order_points();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const InterfaceTriangle& triangle = mesh_.triangles[t];
      Corners c;
      for (std::size_t i = 0; i < 3; ++i) c[i] = place[triangle.points[i]];
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      const bool odd = is_odd(c);
      std::sort(c.begin(), c.end());
      items_.push_back(
          {c, t, odd ? Sides{triangle.back, triangle.front} : Sides{triangle.front, triangle.back}});
    }
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
    });
    for (std::size_t begin = 0, end = 0; begin < items_.size(); begin = end) {
      while (end < items_.size() && items_[end].corners == items_[begin].corners) ++end;
      if (end - begin > 1) groups_.push_back({begin, end});
    }
    std::sort(groups_.begin(), groups_.end(), [this](const Group& a, const Group& b) {
      return items_[a.begin].triangle < items_[b.begin].triangle;
    });
  }

  /// Returns the rank of each point in the order of coordinates, which is the same for equal points, so that
  /// the result does not depend on the order of the points.
  std::vector<std::uint32_t> order_points() {
    std::vector<std::uint32_t> place(mesh_.points.size());
    std::iota(place.begin(), place.end(), 0u);
    at_ = place;
    const std::vector<Vec3>& p = mesh_.points;
    std::sort(at_.begin(), at_.end(), [&p](std::uint32_t a, std::uint32_t b) {
      return std::tie(p[a].x, p[a].y, p[a].z) < std::tie(p[b].x, p[b].y, p[b].z);
    });
    for (std::uint32_t i = 0; i < at_.size(); ++i)
      place[at_[i]] = i > 0 && p[at_[i]] == p[at_[i - 1]] ? place[at_[i - 1]] : i;
    return place;
  }
  [[nodiscard]] const Vec3& point(std::uint32_t place) const { return mesh_.points[at_[place]]; }

  void merge(const Group& group) {
    std::vector<Sides> sides;
    for (std::size_t i = group.begin; i < group.end; ++i) sides.push_back(items_[i].sides);
    std::optional<Sides> ends = ends_of_stack(sides);
    if (!ends) {
      std::sort(sides.begin(), sides.end());
      const auto same = std::unique(sides.begin(), sides.end());
      for (auto i = same; i != sides.end(); ++i) result_.duplicates.add(place(group));
      sides.erase(same, sides.end());
      ends = ends_of_stack(sides);
    }
    if (!ends && !tolerant_) refuse(group, "materials that contradict each other");
    const auto [front, back] = ends.value_or(sides.front());
    const bool remains = front.valid();
    Mended& kind = !ends ? result_.contradictions : (remains ? result_.thin_layers : result_.cancelled);
    for (std::size_t i = remains ? 1 : 0; i < sides.size(); ++i) kind.add(place(group));
    for (std::size_t i = group.begin; i < group.end; ++i) removed_[items_[i].triangle] = 1;
    if (!remains) return cancelled_.push_back(group);
    const Item& first = items_[group.begin];
    removed_[first.triangle] = 0;
    InterfaceTriangle& triangle = mesh_.triangles[first.triangle];
    const bool upwards = Sides{triangle.front, triangle.back} == first.sides;
    triangle.front = upwards ? front : back;
    triangle.back = upwards ? back : front;
  }

  /// Throws if a cancelled pair leaves a hole: faces between two touching parts may vanish, but no face of a
  /// closed surface.
  void check_holes() const {
    std::vector<std::array<std::uint32_t, 2>> edges;
    const auto for_each_edge = [](const Corners& c, const auto& visit) {
      visit(c[0], c[1]);
      visit(c[0], c[2]);
      visit(c[1], c[2]);
    };
    for (const Item& item : items_) {
      if (removed_[item.triangle] != 0) continue;
      for_each_edge(item.corners, [&](std::uint32_t a, std::uint32_t b) { edges.push_back({a, b}); });
    }
    std::sort(edges.begin(), edges.end());
    for (const Group& group : cancelled_) {
      for_each_edge(items_[group.begin].corners, [&](std::uint32_t a, std::uint32_t b) {
        const std::array<std::uint32_t, 2> edge{a, b};
        const auto [first, last] = std::equal_range(edges.begin(), edges.end(), edge);
        if (last - first != 1 || outward_of_edge(domain_, point(a), point(b)) != Vec3{}) return;
        refuse(group, "opposite faces");
      });
    }
  }

  [[nodiscard]] Vec3 place(const Group& group) const {
    const Corners& c = items_[group.begin].corners;
    return (1.0 / 3) * (point(c[0]) + point(c[1]) + point(c[2]));
  }

  [[noreturn]] void refuse(const Group& group, const char* what) const {
    std::string found;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const auto& [front, back] = items_[i].sides;
      found += fmt::format("{}{}: {}|{}", found.empty() ? "" : ", ", items_[i].triangle,
                           mesh_.materials[front], mesh_.materials[back]);
    }
    throw TolerableFault(fmt::format("{}: expected one triangle on the three points round {}, found {}, {}",
                                     mesh_.source, place_text(place(group)), what, found));
  }

  InterfaceMesh& mesh_;
  const Box3* domain_;
  bool tolerant_;
  std::vector<std::uint32_t> at_;  ///< the point with each rank
  std::vector<Item> items_;
  std::vector<Group> groups_;  ///< in the order of their first triangles
  std::vector<Group> cancelled_;
  std::vector<char> removed_;
  CoincidentTriangles result_;
};

}  // namespace

CoincidentTriangles merge_coincident_triangles(InterfaceMesh& mesh, const Box3* domain, bool tolerant) {
  return Merging(mesh, domain, tolerant).run();
}

namespace {

constexpr double kTieAngle = 1e-3;  // below this angle, the order of the blades round an edge is uncertain
/// The larger part of a sheet is right if it has at least this many times the triangles of the other.
constexpr std::size_t kClearMajority = 3;

/// Disjoint sets of triangles whose relative orientations are known.
class Sheets {
 public:
  explicit Sheets(std::size_t count) : parent_(count), turned_(count, 0), torn_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  struct Place {
    std::uint32_t sheet;  ///< the set's first triangle
    bool turned;          ///< whether the orientation is opposite to that triangle's
  };
  Place find(std::uint32_t triangle) {
    bool turned = false;
    std::uint32_t root = triangle;
    for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
    bool rest = turned;
    while (parent_[triangle] != root && triangle != root) {
      const std::uint32_t next = parent_[triangle];
      const bool step = turned_[triangle] != 0;
      parent_[triangle] = root;
      turned_[triangle] = rest ? 1 : 0;
      rest ^= step;
      triangle = next;
    }
    return {root, turned};
  }
  void join(std::uint32_t a, std::uint32_t b, bool turned) {
    const Place x = find(a), y = find(b);
    const bool between = x.turned ^ y.turned ^ turned;
    if (x.sheet == y.sheet) {
      if (between) torn_[x.sheet] = 1;
      return;
    }
    const std::uint32_t low = std::min(x.sheet, y.sheet), high = std::max(x.sheet, y.sheet);
    parent_[high] = low;
    turned_[high] = between ? 1 : 0;
    torn_[low] = torn_[low] != 0 || torn_[high] != 0;
  }
  /// Returns whether the orientations within a sheet contradict each other, as on a Moebius strip.
  [[nodiscard]] bool torn(std::uint32_t sheet) const { return torn_[sheet] != 0; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> turned_, torn_;
};

/// The blades to turn so that the materials match, for each of the one or two possible ways.
struct FanOrientations {
  std::size_t ways = 0;
  std::array<std::vector<bool>, 2> turned;
};

bool order_is_certain(const EdgeFans::Fan& fan) {
  const std::size_t n = fan.blades.size();
  if (n == 2) return true;
  for (std::size_t i = 0; i < n; ++i) {
    const double apart = std::abs(fan.blades[i].angle - fan.blades[(i + 1) % n].angle);
    if (fan.blades[i].flat || apart < kTieAngle || 2 * M_PI - apart < kTieAngle) return false;
  }
  return true;
}

FanOrientations orientations(const EdgeFans& fans, const EdgeFans::Fan& fan) {
  FanOrientations result;
  const std::size_t n = fan.blades.size();
  if (n < 2 || !order_is_certain(fan)) return result;
  const bool open = fan.outside_wedge != EdgeFans::Fan::kNone;
  const std::size_t first = open ? (fan.outside_wedge + 1) % n : 0;
  const Blade& start = fan.blades[first];
  for (const bool turn : {false, true}) {
    std::vector<bool>& turned = result.turned[result.ways];
    turned.assign(n, false);
    turned[first] = turn;
    const auto side = [&](const Blade& b, int s) { return fans.material(b.triangle, s); };
    const int behind = EdgeFans::side_behind(start), ahead = EdgeFans::side_ahead(start);
    const MaterialId before = side(start, turn ? ahead : behind);
    MaterialId material = side(start, turn ? behind : ahead);
    bool fits = true;
    for (std::size_t k = 1; k < n && fits; ++k) {
      const std::size_t i = (first + k) % n;
      const Blade& b = fan.blades[i];
      const MaterialId near = side(b, EdgeFans::side_behind(b)), far = side(b, EdgeFans::side_ahead(b));
      fits = material == near || material == far;
      turned[i] = material != near;
      material = turned[i] ? near : far;
    }
    if (fits && (open || material == before)) ++result.ways;
  }
  return result;
}

/// The numbers of triangles of a sheet that are oriented like its first one (0) and opposite to it (1).
struct Tally {
  /// votes: the number of edges for which these triangles are right
  std::array<std::size_t, 2> triangles{}, votes{};
};

/// Finds which triangles to turn.
std::vector<char> find_turned(const InterfaceMesh& mesh, const EdgeFans& fans, Sheets& sheets) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  EdgeFans::Fan fan;
  std::vector<std::pair<std::uint32_t, bool>> votes;  // a triangle, and whether its orientation is wrong
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    if (fans.valence(edge) < 2) continue;
    fans.fan(edge, fan);
    const FanOrientations found = orientations(fans, fan);
    if (found.ways == 0) continue;
    for (std::size_t i = 0; i < fan.blades.size(); ++i) {
      const std::uint32_t t = fan.blades[i].triangle;
      const bool turned = found.turned[0][i];
      if (found.ways == 1) votes.emplace_back(t, turned);
      if (found.ways == 2) sheets.join(fan.blades[0].triangle, t, found.turned[0][0] != turned);
    }
  }
  std::vector<Tally> tallies(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [sheet, turned] = sheets.find(t);
    ++tallies[sheet].triangles[turned ? 1 : 0];
  }
  for (const auto& [t, wrong] : votes) {
    const auto [sheet, turned] = sheets.find(t);
    ++tallies[sheet].votes[turned != wrong ? 1 : 0];
  }
  std::vector<char> turn(count, 0);
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [sheet, turned] = sheets.find(t);
    const Tally& tally = tallies[sheet];
    const bool voted = tally.votes[0] + tally.votes[1] > 0;
    const auto& decisive = voted ? tally.votes : tally.triangles;
    const std::size_t most = std::max(decisive[0], decisive[1]), least = std::min(decisive[0], decisive[1]);
    if (sheets.torn(sheet) || (voted ? least > 0 : most < kClearMajority * least)) continue;
    turn[t] = turned != (decisive[1] > decisive[0]) ? 1 : 0;
  }
  return turn;
}

void turn_over(InterfaceTriangle& t) { std::swap(t.points[1], t.points[2]); }

/// Turns sheets back that have an edge whose materials still do not match, until there are none.
void turn_back_mismatches(InterfaceMesh& mesh, const Box3* domain, Sheets& sheets, std::vector<char>& turn) {
  for (bool again = true; again;) {
    again = false;
    const EdgeFans fans(mesh, domain);
    EdgeFans::Fan fan;
    std::vector<char> bad(mesh.triangles.size(), 0);
    for (std::size_t edge = 0; edge < fans.size(); ++edge) {
      fans.fan(edge, fan);
      if (fan.consistent) continue;
      for (const Blade& b : fan.blades) bad[sheets.find(b.triangle).sheet] = 1;
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (turn[t] == 0 || bad[sheets.find(t).sheet] == 0) continue;
      turn_over(mesh.triangles[t]);
      turn[t] = 0;
      again = true;
    }
  }
}

bool matches_everywhere(const EdgeFans& fans) {
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    fans.fan(edge, fan);
    if (!fan.consistent) return false;
  }
  return true;
}

}  // namespace

Mended turn_wrong_triangles(InterfaceMesh& mesh, const Box3* domain) {
  Sheets sheets(mesh.triangles.size());
  std::vector<char> turn;
  {
    const EdgeFans fans(mesh, domain);
    if (matches_everywhere(fans)) return {};
    turn = find_turned(mesh, fans, sheets);
  }
  for (std::size_t t = 0; t < turn.size(); ++t) {
    if (turn[t] != 0) turn_over(mesh.triangles[t]);
  }
  turn_back_mismatches(mesh, domain, sheets, turn);
  Mended result;
  for (std::size_t t = 0; t < turn.size(); ++t) {
    if (turn[t] != 0) result.add(mesh.centroid(t));
  }
  return result;
}

namespace {

double size_of(const InterfaceMesh& mesh, const Box3* domain) {
  if (domain != nullptr) return domain->diagonal();
  Box3 box;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const std::uint32_t p : t.points) box.extend(mesh.points[p]);
  }
  return box.diagonal();
}

}  // namespace

InterfaceMending mend_interface_mesh(InterfaceMesh& mesh, const Box3* domain,
                                     const InterfaceMendingOptions& options) {
  check_interface_arrays(mesh);
  InterfaceMending result;
  result.gaps = close_gaps(mesh, domain, options.gaps * size_of(mesh, domain));
  result.coincident = merge_coincident_triangles(mesh, domain, options.tolerant);
  result.turned = turn_wrong_triangles(mesh, domain);
  return result;
}

}  // namespace adamas::interfaces
