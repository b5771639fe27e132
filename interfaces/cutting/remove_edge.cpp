#include <algorithm>
#include <limits>

#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kMostRing = 9;

/// The vertices round an edge in their order, and the cells between each and the next.
struct Ring {
  std::vector<std::uint32_t> vertices, cells;
  bool closed = true;
};

/// Goes round the edge from a to b, anticlockwise as seen from b; from one side of the box to the other where
/// the edge lies on it.
bool find_ring(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, Ring& ring) {
  thread_local std::vector<std::uint32_t> cells;
  mesh.cells_at_edge(a, b, cells);
  if (cells.size() < 2 || cells.size() > kMostRing) return false;
  // The other two vertices of each cell, in such an order that a, b, first, second are positively oriented.
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
    // Parity of the order i, j, rest.
    const std::array<std::size_t, 4> order{i, j, rest[0], rest[1]};
    bool odd = false;
    for (std::size_t x = 0; x < 4; ++x) {
      for (std::size_t y = x + 1; y < 4; ++y) odd ^= order[x] > order[y];
    }
    if (odd) std::swap(rest[0], rest[1]);
    steps.push_back({v[rest[0]], v[rest[1]], c});
  }
  // Begin after a gap, if there is one, else at the lowest vertex, so that the order of a star means nothing.
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

/// The best triangulation of a polygon of the ring's vertices, in their order, each triangle with a and with
/// b a cell.
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

/// Whether two triangles of an interface may be divided by their other diagonal, from c to d.
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
    // Where the edge lies on the box, the polygon of its ring is closed along the box.
    if (ring.closed == (sides.count == 2) || ring.vertices.size() < 3) return false;
    const BestTriangulation best(mesh, a, b, ring.vertices);
    change.quality = best.quality();
    if (!(change.quality > before)) return false;
    best.add(mesh.cell(ring.cells[0]).body, change.added);
    return true;
  }
  if (!ring.closed) return false;
  // Two bodies: the ring in two parts, each with the new edge, from where the first begins to where it ends.
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
    if (!LabelledMesh::has(mesh.cell(cell).vertices, w)) beyond = w;
  }
  const double before = std::min(mesh.quality(cell), mesh.quality(other));
  change.removed = {cell, other};
  change.added.clear();
  change.quality = std::numeric_limits<double>::infinity();
  // Each face of the cell at v, with the vertex beyond in the place of the vertex of the face that v sees.
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

}  // namespace adamas::interfaces
