#include "interfaces/cutting/local_changes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/sort_unique.h"
#include "core/distance/triangle_distance.h"

namespace adamas::interfaces {

namespace {

/// Returns the quality of a cell with its vertex v at p.
double quality_if_moved(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v, const Vec3& p) {
  const auto& corners = mesh.cell(cell).vertices;
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = corners[i] == v ? p : mesh.point(corners[i]);
  return least_dihedral_sine(x[0], x[1], x[2], x[3]);
}

}  // namespace

double least_quality(const LabelledMesh& mesh, std::span<const std::uint32_t> cells) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : cells) least = std::min(least, mesh.quality(c));
  return least;
}

double quality_at(const LabelledMesh& mesh, std::uint32_t v, const Vec3& p, double bound) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : mesh.star(v)) {
    least = std::min(least, quality_if_moved(mesh, c, v, p));
    if (least <= bound) break;
  }
  return least;
}

double longest_edge(const LabelledMesh& mesh, std::uint32_t v) {
  double longest = 0;
  for (const std::uint32_t c : mesh.star(v)) {
    for (const std::uint32_t w : mesh.cell(c).vertices)
      longest = std::max(longest, squared_norm(mesh.point(w) - mesh.point(v)));
  }
  return std::sqrt(longest);
}

bool is_feature(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v) {
  const std::uint32_t other = mesh.neighbour(cell, v);
  return other == kNoNeighbour || mesh.cell(other).body != mesh.cell(cell).body;
}

namespace {

/// Returns whether the collapse of the edge from a to b, which merges faces, keeps the topology.
bool keeps_topology(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b,
                    const LabelledMesh::Sides& sides) {
  thread_local std::vector<std::uint32_t> round_edge, seen;
  mesh.cells_at_edge(a, b, round_edge);
  for (const std::uint32_t c : round_edge) {
    if (is_feature(mesh, c, a) && is_feature(mesh, c, b)) return false;
  }
  if (sides.count < 2) return true;
  seen.clear();
  for (const std::uint32_t c : mesh.star(a)) {
    for (const std::uint32_t w : mesh.cell(c).vertices) {
      if (w == a || w == b || std::find(seen.begin(), seen.end(), w) != seen.end()) continue;
      seen.push_back(w);
      const std::size_t from_a = mesh.sides(a, w).count;
      if (from_a < 2) continue;
      const std::size_t from_b = mesh.sides(b, w).count;
      if (from_b < 2) continue;
      if (from_a > 2 && from_b > 2) return false;
      // A triangle of the interface must lie between the two edges that become one.
      const bool between = std::any_of(round_edge.begin(), round_edge.end(), [&](std::uint32_t d) {
        const auto& v = mesh.cell(d).vertices;
        if (!LabelledMesh::has_vertex(v, w)) return false;
        for (const std::uint32_t x : v) {
          if (x != a && x != b && x != w) return is_feature(mesh, d, x);
        }
        return false;
      });
      if (!between) return false;
    }
  }
  return true;
}

/// Returns whether the middle of an interface's triangle p, x, y and those of its edges at p are within the
/// tolerance.
bool allows_triangle(const InterfaceTarget& target, const LabelledMesh::Sides& pair, const Vec3& p,
                     const Vec3& x, const Vec3& y, bool is_misplaced) {
  return target.allows(pair, (1.0 / 3) * (p + x + y), is_misplaced) &&
         target.allows(pair, 0.5 * (p + x), is_misplaced) && target.allows(pair, 0.5 * (p + y), is_misplaced);
}

/// Returns whether the interfaces' triangles at a, with a moved to b, are within the tolerance, and a is
/// close to them.
bool stays_near_target(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a,
                       std::uint32_t b) {
  const Vec3& p = mesh.point(b);
  const bool is_misplaced = !target.allows(mesh.sides(a), mesh.point(a));
  double to_a = std::numeric_limits<double>::infinity();
  thread_local std::vector<LabelledMesh::InterfaceFace> faces;
  mesh.interface_faces(a, faces);
  for (const auto& [pair, ends] : faces) {
    if (ends[0] == b || ends[1] == b) continue;
    const Vec3 &x = mesh.point(ends[0]), &y = mesh.point(ends[1]);
    to_a = std::min(to_a, closest_on_triangle(mesh.point(a), {p, x, y}).squared_distance);
    if (!allows_triangle(target, pair, p, x, y, is_misplaced)) return false;
    for (const std::uint32_t end : ends) {
      const auto line = mesh.sides(a, end);
      if (line.bodies() > 2 && !target.allows(line, 0.5 * (p + mesh.point(end)), is_misplaced)) return false;
    }
  }
  return is_misplaced || to_a <= target.tolerance() * target.tolerance();
}

}  // namespace

bool collapse_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                   double bound, LocalChange& change) {
  if ((mesh.walls(a) & ~mesh.walls(b)) != 0) return false;
  const auto star = mesh.star(a);
  change.removed.assign(star.begin(), star.end());
  change.added.clear();
  change.quality = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : star) {
    LabelledMesh::Cell cell = mesh.cell(c);
    if (LabelledMesh::has_vertex(cell.vertices, b)) continue;
    std::replace(cell.vertices.begin(), cell.vertices.end(), a, b);
    change.quality = std::min(change.quality, mesh.quality_of(cell.vertices));
    if (!(change.quality > bound)) return false;
    change.added.push_back(cell);
  }
  const auto sides = mesh.sides(a);
  if (!(sides == mesh.sides(a, b)) || !keeps_topology(mesh, a, b, sides)) return false;
  return sides.bodies() < 2 || stays_near_target(mesh, target, a, b);
}

namespace {

constexpr std::size_t kMostRing = 9;

/// The vertices round an edge, in their order, and the cells between each and the next.
struct Ring {
  std::vector<std::uint32_t> vertices, cells;
  bool closed = true;
};

/// Finds the ring of the edge from a to b, anticlockwise as seen from b; if the edge lies on the box, it runs
/// from one side of the box to the other. Returns whether there is one ring of at most kMostRing cells.
bool find_ring(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, Ring& ring) {
  thread_local std::vector<std::uint32_t> cells;
  mesh.cells_at_edge(a, b, cells);
  if (cells.size() < 2 || cells.size() > kMostRing) return false;
  // The other two vertices of each cell are ordered so that a, b, first and second are positively oriented.
  struct Step {
    std::uint32_t from, to, cell;
  };
  thread_local std::vector<Step> steps;
  steps.clear();
  for (const std::uint32_t c : cells) {
    const auto& v = mesh.cell(c).vertices;
    std::size_t i = 0, j = 0;
    while (v[i] != a) ++i;
    while (v[j] != b) ++j;
    std::array<std::size_t, 2> rest{};
    std::size_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k != i && k != j) rest[n++] = k;
    }
    // This is the parity of the order i, j, rest.
    const std::array<std::size_t, 4> order{i, j, rest[0], rest[1]};
    bool odd = false;
    for (std::size_t x = 0; x < 4; ++x) {
      for (std::size_t y = x + 1; y < 4; ++y) odd ^= order[x] > order[y];
    }
    if (odd) std::swap(rest[0], rest[1]);
    steps.push_back({v[rest[0]], v[rest[1]], c});
  }
  // The ring begins after a gap, if there is one, else at the lowest vertex, so that it does not depend on
  // the order of the star.
  const auto starts = [&](const Step& step) {
    return std::none_of(steps.begin(), steps.end(), [&](const Step& s) { return s.to == step.from; });
  };
  auto first = std::find_if(steps.begin(), steps.end(), starts);
  ring.closed = first == steps.end();
  if (ring.closed) {
    first = std::min_element(steps.begin(), steps.end(),
                             [](const Step& x, const Step& y) { return x.from < y.from; });
  }
  ring.vertices.assign(1, first->from);
  ring.cells.clear();
  Step step = *first;
  while (true) {
    ring.cells.push_back(step.cell);
    if (ring.closed && step.to == ring.vertices[0]) break;
    ring.vertices.push_back(step.to);
    const auto next =
        std::find_if(steps.begin(), steps.end(), [&](const Step& s) { return s.from == step.to; });
    if (next == steps.end()) break;
    step = *next;
  }
  return ring.cells.size() == cells.size();
}

/// The best triangulation of a polygon of the ring's vertices; each triangle forms a cell with a and one with
/// b.
class BestTriangulation {
 public:
  BestTriangulation(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b,
                    std::span<const std::uint32_t> polygon)
      : a_(a), b_(b), polygon_(polygon) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = std::numeric_limits<double>::infinity();
    for (std::size_t length = 2; length < n; ++length) {
      for (std::size_t i = 0; i + length < n; ++i) {
        const std::size_t k = i + length;
        best_[i][k] = -1;
        for (std::size_t j = i + 1; j < k; ++j) {
          const double rest = std::min(best_[i][j], best_[j][k]);
          if (rest <= best_[i][k]) continue;
          double q = mesh.quality_of({a, polygon[i], polygon[j], polygon[k]});
          if (q > best_[i][k]) q = std::min(q, mesh.quality_of({b, polygon[i], polygon[k], polygon[j]}));
          q = std::min(q, rest);
          if (q > best_[i][k]) best_[i][k] = q, middle_[i][k] = j;
        }
      }
    }
  }

  [[nodiscard]] double quality() const { return best_[0][polygon_.size() - 1]; }
  void add(BodyId body, std::vector<LabelledMesh::Cell>& cells) const {
    add(0, polygon_.size() - 1, body, cells);
  }

 private:
  void add(std::size_t i, std::size_t k, BodyId body, std::vector<LabelledMesh::Cell>& cells) const {
    if (k < i + 2) return;
    const std::size_t j = middle_[i][k];
    cells.push_back({{a_, polygon_[i], polygon_[j], polygon_[k]}, body});
    cells.push_back({{b_, polygon_[i], polygon_[k], polygon_[j]}, body});
    add(i, j, body, cells);
    add(j, k, body, cells);
  }

  std::uint32_t a_, b_;
  std::span<const std::uint32_t> polygon_;
  std::array<std::array<double, kMostRing + 1>, kMostRing + 1> best_;
  std::array<std::array<std::size_t, kMostRing + 1>, kMostRing + 1> middle_;
};

/// Returns whether two triangles of an interface may be divided by their other diagonal, from c to d.
bool may_flip(const LabelledMesh& mesh, const InterfaceTarget& target, const LabelledMesh::Sides& pair,
              std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const Vec3 middle = 0.5 * (mesh.point(c) + mesh.point(d));
  return target.allows(pair, middle) && target.allows(pair, (1.0 / 3) * (2 * middle + mesh.point(a))) &&
         target.allows(pair, (1.0 / 3) * (2 * middle + mesh.point(b)));
}

}  // namespace

bool remove_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                 LocalChange& change) {
  if (a > b) std::swap(a, b);
  const auto sides = mesh.sides(a, b);
  thread_local Ring ring;
  if (sides.count > 2 || !find_ring(mesh, a, b, ring)) return false;
  const double before = least_quality(mesh, ring.cells);
  change.removed.assign(ring.cells.begin(), ring.cells.end());
  change.added.clear();
  const std::size_t bodies = sides.bodies();
  if (bodies == 1) {
    // If the edge lies on the box, the polygon of its ring is closed along the box.
    if (ring.closed == (sides.count == 2) || ring.vertices.size() < 3) return false;
    const BestTriangulation best(mesh, a, b, ring.vertices);
    change.quality = best.quality();
    if (!(change.quality > before)) return false;
    best.add(mesh.cell(ring.cells[0]).body, change.added);
    return true;
  }
  if (!ring.closed) return false;
  // With two bodies, the ring has two parts, which the new edge closes.
  const std::size_t n = ring.cells.size();
  const auto body = [&](std::size_t i) { return mesh.cell(ring.cells[i % n]).body; };
  std::vector<std::size_t> borders;
  for (std::size_t i = 0; i < n; ++i) {
    if (body(i) != body(i + n - 1)) borders.push_back(i);
  }
  if (borders.size() != 2 || borders[1] - borders[0] < 2 || borders[0] + n - borders[1] < 2) return false;
  std::array<std::vector<std::uint32_t>, 2> polygons;
  for (std::size_t i = borders[0]; i <= borders[1]; ++i) polygons[0].push_back(ring.vertices[i]);
  for (std::size_t i = borders[1]; i <= borders[0] + n; ++i) polygons[1].push_back(ring.vertices[i % n]);
  const BestTriangulation first(mesh, a, b, polygons[0]), second(mesh, a, b, polygons[1]);
  change.quality = std::min(first.quality(), second.quality());
  if (!(change.quality > before)) return false;
  if (!may_flip(mesh, target, sides, a, b, polygons[0].front(), polygons[0].back())) return false;
  first.add(body(borders[0]), change.added);
  second.add(body(borders[1]), change.added);
  return true;
}

bool remove_face(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v, LocalChange& change) {
  const std::uint32_t other = mesh.neighbour(cell, v);
  if (other == kNoNeighbour || mesh.cell(other).body != mesh.cell(cell).body) return false;
  std::uint32_t beyond = 0;
  for (const std::uint32_t w : mesh.cell(other).vertices) {
    if (!LabelledMesh::has_vertex(mesh.cell(cell).vertices, w)) beyond = w;
  }
  const double before = std::min(mesh.quality(cell), mesh.quality(other));
  change.removed = {cell, other};
  change.added.clear();
  change.quality = std::numeric_limits<double>::infinity();
  // In each new cell, the vertex beyond replaces one vertex of the common face.
  for (const std::uint32_t left_out : mesh.cell(cell).vertices) {
    if (left_out == v) continue;
    LabelledMesh::Cell made = mesh.cell(cell);
    std::replace(made.vertices.begin(), made.vertices.end(), left_out, beyond);
    change.quality = std::min(change.quality, mesh.quality_of(made.vertices));
    if (!(change.quality > before)) return false;
    change.added.push_back(made);
  }
  return true;
}

bool split_edge(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, LocalChange& change) {
  constexpr double kMargin = 0.1;  // the least distance from the ends of the edge, relative to its length
  if (a > b) std::swap(a, b);
  mesh.cells_at_edge(a, b, change.removed);
  const double before = least_quality(mesh, change.removed);
  const Vec3 &from = mesh.point(a), edge = mesh.point(b) - from;
  thread_local std::vector<double> places;
  places.assign(1, 0.5);
  for (const std::uint32_t c : change.removed) {
    for (const std::uint32_t v : mesh.cell(c).vertices) {
      const double t = dot(mesh.point(v) - from, edge) / squared_norm(edge);
      if (t > kMargin && t < 1 - kMargin) places.push_back(t);
    }
  }
  sort_unique(places);
  change.quality = before;
  change.has_vertex = false;
  for (const double t : places) {
    const Vec3 p = from + t * edge;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : change.removed) {
      for (const std::uint32_t end : {a, b}) least = std::min(least, quality_if_moved(mesh, c, end, p));
      if (least <= change.quality) break;
    }
    if (least > change.quality) change.quality = least, change.point = p, change.has_vertex = true;
  }
  if (!change.has_vertex) return false;
  change.walls = mesh.walls(a) & mesh.walls(b);
  change.added.clear();
  const auto middle = static_cast<std::uint32_t>(mesh.vertex_count());
  for (const std::uint32_t c : change.removed) {
    for (const std::uint32_t end : {a, b}) {
      LabelledMesh::Cell cell = mesh.cell(c);
      std::replace(cell.vertices.begin(), cell.vertices.end(), end, middle);
      change.added.push_back(cell);
    }
  }
  return true;
}

namespace {

/// The vertices, edges and faces of a cell, as bit sets of their corners.
constexpr std::array<unsigned, 14> kSimplices{1, 2, 4, 8, 3, 5, 6, 9, 10, 12, 7, 11, 13, 14};
constexpr std::size_t kMostLabels = 8;

/// The simplices that a cell shares with other cells of each label. A label is a body or a side of the box.
struct Contacts {
  std::array<std::uint32_t, kMostLabels> labels;
  std::array<std::array<bool, 16>, kMostLabels> touches{};  ///< indexed by the set of corners
  std::size_t count = 0;

  std::size_t number(std::uint32_t label) {
    for (std::size_t i = 0; i < count; ++i) {
      if (labels[i] == label) return i;
    }
    if (count == kMostLabels) return kMostLabels;
    labels[count] = label;
    return count++;
  }
  void touch(std::size_t label, unsigned corners) {
    for (const unsigned s : kSimplices) {
      if ((s & ~corners) == 0) touches[label][s] = true;
    }
  }
};

bool find_contacts(const LabelledMesh& mesh, std::uint32_t cell, Contacts& contacts) {
  const auto& v = mesh.cell(cell).vertices;
  for (std::size_t i = 0; i < 4; ++i) {
    for (const std::uint32_t c : mesh.star(v[i])) {
      if (c == cell) continue;
      unsigned corners = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (LabelledMesh::has_vertex(mesh.cell(c).vertices, v[k])) corners |= 1u << k;
      }
      const std::size_t label = contacts.number(mesh.cell(c).body.value);
      if (label == kMostLabels) return false;
      contacts.touch(label, corners);
    }
  }
  // The outside of each side of the box counts as a body.
  constexpr std::uint32_t kFirstSide = 0xfffffff0u;
  for (std::uint32_t side = 0; side < 6; ++side) {
    unsigned corners = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if ((mesh.walls(v[k]) >> side & 1u) != 0) corners |= 1u << k;
    }
    if (corners == 0) continue;
    const std::size_t label = contacts.number(kFirstSide + side);
    if (label == kMostLabels) return false;
    contacts.touch(label, corners);
  }
  return true;
}

/// Returns whether the simplices of a cell that touch any of the labels form one piece without a hole.
bool is_contractible(const Contacts& contacts, unsigned labels) {
  std::array<bool, 16> in{};
  for (std::size_t i = 0; i < contacts.count; ++i) {
    if ((labels >> i & 1u) == 0) continue;
    for (const unsigned s : kSimplices) in[s] = in[s] || contacts.touches[i][s];
  }
  int euler = 0;
  unsigned vertices = 0;
  for (const unsigned s : kSimplices) {
    if (!in[s]) continue;
    euler += std::popcount(s) == 2 ? -1 : 1;
    vertices |= s;
  }
  if (euler != 1) return false;
  unsigned reached = vertices & (0u - vertices);
  for (unsigned before = 0; before != reached;) {
    before = reached;
    for (const unsigned s : kSimplices) {
      if (in[s] && (s & reached) != 0) reached |= s;
    }
  }
  return reached == vertices;
}

/// Returns whether the new border of the cell's new body is within the tolerance.
bool border_is_near_target(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                           BodyId body) {
  const auto& v = mesh.cell(cell).vertices;
  for (const std::uint32_t opposite : v) {
    const std::uint32_t other = mesh.neighbour(cell, opposite);
    if (other == kNoNeighbour || mesh.cell(other).body == body) continue;
    LabelledMesh::Sides pair;
    pair.add(body.value);
    pair.add(mesh.cell(other).body.value);
    Vec3 sum;
    for (const std::uint32_t w : v) {
      if (w == opposite) continue;
      sum += mesh.point(w);
      if (!target.allows(pair, mesh.point(w))) return false;
    }
    if (!target.allows(pair, (1.0 / 3) * sum)) return false;
  }
  return true;
}

}  // namespace

bool may_change_body(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                     BodyId body) {
  Contacts contacts;
  if (!find_contacts(mesh, cell, contacts)) return false;
  const std::size_t from = contacts.number(mesh.cell(cell).body.value), to = contacts.number(body.value);
  if (from == kMostLabels || to == kMostLabels) return false;
  // The unions of labels that contain exactly one of the two bodies are checked.
  const unsigned all = (1u << contacts.count) - 1;
  for (unsigned labels = 0; labels <= all; ++labels) {
    if ((labels >> from & 1u) == (labels >> to & 1u)) continue;
    if (!is_contractible(contacts, labels)) return false;
  }
  return border_is_near_target(mesh, target, cell, body);
}

namespace {

constexpr int kMostSteps = 6;

class Smoothing {
 public:
  Smoothing(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v)
      : mesh_(mesh), target_(target), v_(v), sides_(mesh.sides(v)), bodies_(sides_.bodies()) {
    size_ = longest_edge(mesh, v);
    is_misplaced_ = !target.allows(sides_, mesh.point(v));
  }

  bool run() {
    bool moved = false;
    for (int step = 0; step < kMostSteps; ++step) {
      if (!climb()) break;
      moved = true;
    }
    return moved;
  }

 private:
  Vec3 gradient(std::uint32_t c) const {
    const double h = 1e-4 * size_;
    const Vec3& p = mesh_.point(v_);
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 up = p, down = p;
      up[axis] += h;
      down[axis] -= h;
      result[axis] = (quality_if_moved(mesh_, c, v_, up) - quality_if_moved(mesh_, c, v_, down)) / (2 * h);
    }
    return result;
  }

  /// Returns approximately the closest place to p on the interface or the line on which the vertex lies.
  std::optional<Vec3> placed(const Vec3& p) const {
    Vec3 q = p;
    for (int round = 0; round < (bodies_ > 1 ? 2 : 1); ++round) {
      if (bodies_ > 1 && !is_misplaced_ && stays_on_feature_) {
        const auto near = target_.closest(sides_, q, 2 * size_);
        if (!near) return std::nullopt;
        q = *near;
      }
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh_.walls(v_) >> (2 * axis) & 3u) != 0) q[axis] = mesh_.point(v_)[axis];
      }
    }
    return q;
  }

  /// Returns whether the interfaces round the vertex, if it were at p, are within the tolerance.
  bool allowed(const Vec3& p) const {
    if (bodies_ < 2) return true;
    if (!target_.allows(sides_, p, is_misplaced_)) return false;
    thread_local std::vector<LabelledMesh::InterfaceFace> faces;
    mesh_.interface_faces(v_, faces);
    return std::ranges::all_of(faces, [&](const LabelledMesh::InterfaceFace& face) {
      const auto& [pair, ends] = face;
      return allows_triangle(target_, pair, p, mesh_.point(ends[0]), mesh_.point(ends[1]), is_misplaced_);
    });
  }

  bool try_move(const Vec3& p, double before) {
    const auto place = placed(p);
    if (!place) return false;
    if (!(quality_at(mesh_, v_, *place, before) > before * (1 + 1e-3) + 1e-6) || !allowed(*place))
      return false;
    mesh_.move(v_, *place);
    return true;
  }

  bool climb() {
    const auto star = mesh_.star(v_);
    const double before = least_quality(mesh_, star);
    // The directions are the worst cell's gradient and its mean with that of the second worst.
    std::vector<std::uint32_t> worst(star.begin(), star.end());
    std::sort(worst.begin(), worst.end(), [&](std::uint32_t x, std::uint32_t y) {
      return mesh_.quality(x) != mesh_.quality(y) ? mesh_.quality(x) < mesh_.quality(y) : x < y;
    });
    std::vector<Vec3> directions{normalized(gradient(worst[0]))};
    if (worst.size() > 1) {
      const Vec3 second = normalized(gradient(worst[1]));
      directions.push_back(normalized(directions[0] + second));
    }
    const Vec3 p = mesh_.point(v_);
    // The vertex moves along its interface first, and off it only if that does not help.
    for (stays_on_feature_ = true;; stays_on_feature_ = false) {
      for (const double step : {0.3, 0.1, 0.03}) {
        for (const Vec3& direction : directions) {
          if (try_move(p + step * size_ * direction, before)) return true;
        }
        if (step == 0.3 && try_move(middle(), before)) return true;
      }
      if (bodies_ < 2 || is_misplaced_ || !stays_on_feature_) return false;
    }
  }

  /// Returns the mean of the vertices round this one.
  Vec3 middle() const {
    Vec3 sum;
    double count = 0;
    for (const std::uint32_t c : mesh_.star(v_)) {
      for (const std::uint32_t w : mesh_.cell(c).vertices) {
        if (w != v_) sum += mesh_.point(w), ++count;
      }
    }
    return (1 / count) * sum;
  }

  LabelledMesh& mesh_;
  const InterfaceTarget& target_;
  std::uint32_t v_;
  LabelledMesh::Sides sides_;
  std::size_t bodies_;
  double size_ = 0;
  bool stays_on_feature_ = true;  ///< whether moves end exactly on the interface or line
  bool is_misplaced_ = false;     ///< whether the vertex is not where its bodies should meet
};

}  // namespace

bool smooth_vertex(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v) {
  return Smoothing(mesh, target, v).run();
}

}  // namespace adamas::interfaces
