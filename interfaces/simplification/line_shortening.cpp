#include "interfaces/simplification/line_shortening.h"

#include <algorithm>
#include <queue>

#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/patch_changes.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas::interfaces {

namespace {

using Halfedge = PatchMesh::HalfedgeHandle;
using Vertex = PatchMesh::VertexHandle;

std::array<std::uint32_t, 2> ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length = squared_norm(edge);
  const double t = length > 0 ? std::clamp(dot(p - a, edge) / length, 0.0, 1.0) : 0.0;
  return a + t * edge;
}

/// Returns the change that keeps a triangle as it is.
SurfaceChange unchanged(const PatchMesh& mesh, PatchMesh::FaceHandle face) {
  SurfaceChange::Face same{mesh.data(face).triangle, {}};
  std::size_t c = 0;
  for (const Vertex corner : mesh.fv_range(face)) same.corners[c++] = mesh.data(corner).point;
  SurfaceChange change;
  change.old_faces.push_back(same.face);
  change.faces.push_back(same);
  return change;
}

/// Returns the half-edge of a border from a vertex to another point; its triangle may be on either side.
Halfedge border_to(const PatchMesh& mesh, Vertex from, std::uint32_t to) {
  for (const Halfedge h : mesh.voh_range(from)) {
    if (mesh.data(mesh.to_vertex_handle(h)).point == to && mesh.is_boundary(mesh.edge_handle(h))) return h;
  }
  return Halfedge();
}

}  // namespace

/// The elements that a patch loses: the triangles at a collapsed edge, or a triangle.
struct LineShortener::Removal {
  std::uint32_t patch;
  Halfedge halfedge;
  PatchMesh::FaceHandle face;
};

/// An edge from a point that is removed to one that stays, and the point before them on the line.
struct LineShortener::Candidate {
  double length;
  std::uint32_t from, to, before;
  std::uint32_t kind;
  bool operator<(const Candidate& other) const {
    return std::tie(other.length, other.from, other.to) < std::tie(length, from, to);
  }
};

LineShortener::LineShortener(std::vector<InterfacePatch>& patches, SurfaceGuard& guard)
    : patches_(patches), guard_(guard) {
  find_kinds();
}

LineShortener::~LineShortener() = default;

void LineShortener::find_kinds() {
  std::map<Edge, std::vector<std::uint32_t>> around;  // the pairs of bodies at each edge
  for (const InterfacePatch& patch : patches_) {
    for (const auto edge : patch.mesh.edges()) {
      if (!patch.mesh.is_boundary(edge)) continue;
      const auto halfedge = patch.mesh.halfedge_handle(edge, 0);
      auto& names = around[ordered(patch.mesh.data(patch.mesh.from_vertex_handle(halfedge)).point,
                                   patch.mesh.data(patch.mesh.to_vertex_handle(halfedge)).point)];
      names.push_back(patch.front_body().value);
      names.push_back(patch.back_body().value);
    }
  }
  std::map<std::vector<std::uint32_t>, std::uint32_t> numbers;
  std::vector<std::vector<Edge>> edges;
  for (auto& [edge, names] : around) {
    names.push_back(guard_.sides(edge[0]) & guard_.sides(edge[1]));
    const auto [found, fresh] = numbers.try_emplace(names, static_cast<std::uint32_t>(numbers.size()));
    if (fresh) edges.emplace_back();
    edges[found->second].push_back(edge);
    kind_of_edge_[edge] = found->second;
    const Vec3 &a = guard_.point(edge[0]), &b = guard_.point(edge[1]);
    if (distance(a, b) > guard_.limit())
      dropped_[edge] = {0.75 * a + 0.25 * b, 0.5 * (a + b), 0.25 * a + 0.75 * b};
  }
  for (const auto& of_kind : edges) {
    std::vector<Vec3> points;
    std::vector<ClosestPointTree::Triangle> lines;
    for (const Edge& e : of_kind) {
      const auto n = static_cast<std::uint32_t>(points.size());
      points.push_back(guard_.original(e[0]));
      points.push_back(guard_.original(e[1]));
      lines.push_back({n, n + 1, n + 1});
    }
    kinds_.push_back({ClosestPointTree(points, lines), nullptr});
  }
  for (Kind& kind : kinds_) kind.near = std::make_unique<NearField>(kind.tree, guard_.limit());
}

void LineShortener::find_uses() {
  uses_.clear();
  for (std::uint32_t p = 0; p < patches_.size(); ++p) {
    const PatchMesh& mesh = patches_[p].mesh;
    for (const auto vertex : mesh.vertices()) {
      if (!mesh.status(vertex).deleted()) uses_.push_back({mesh.data(vertex).point, p, vertex.idx()});
    }
  }
  std::sort(uses_.begin(), uses_.end(), [](const Use& a, const Use& b) {
    return std::tie(a.point, a.patch, a.vertex) < std::tie(b.point, b.patch, b.vertex);
  });
}

std::vector<const LineShortener::Use*> LineShortener::uses_of(std::uint32_t point) const {
  auto use = std::lower_bound(uses_.begin(), uses_.end(), point,
                              [](const Use& u, std::uint32_t p) { return u.point < p; });
  std::vector<const Use*> result;
  for (; use != uses_.end() && use->point == point; ++use) result.push_back(&*use);
  return result;
}

/// Returns the points before and after a point on its line; none if it is not inside a line.
std::optional<LineShortener::Edge> LineShortener::neighbours(std::uint32_t point) const {
  std::optional<Edge> result;
  for (const Use* use : uses_of(point)) {
    const PatchMesh& mesh = patches_[use->patch].mesh;
    const Vertex vertex(use->vertex);
    if (!mesh.is_boundary(vertex)) return std::nullopt;
    const Halfedge out = mesh.halfedge_handle(vertex);
    const Edge ends = ordered(mesh.data(mesh.to_vertex_handle(out)).point,
                              mesh.data(mesh.from_vertex_handle(mesh.prev_halfedge_handle(out))).point);
    if (ends[0] == ends[1] || (result && *result != ends)) return std::nullopt;
    result = ends;
  }
  return result;
}

std::vector<LineShortener::Candidate> LineShortener::candidates_at(std::uint32_t point) const {
  const auto ends = neighbours(point);
  if (!ends) return {};
  const auto first = kind_of_edge_.find(ordered(point, (*ends)[0]));
  const auto second = kind_of_edge_.find(ordered(point, (*ends)[1]));
  if (first == kind_of_edge_.end() || second == kind_of_edge_.end() || first->second != second->second)
    return {};
  const unsigned of_line = guard_.sides(point);
  // Lines leave the sides of the domain only at their ends; borders inside the domain do not change.
  if ((guard_.sides((*ends)[0]) & guard_.sides((*ends)[1])) != of_line) return {};
  if (of_line == 0 && uses_of(point).size() < 2) return {};
  std::vector<Candidate> result;
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t to = (*ends)[static_cast<std::size_t>(i)];
    result.push_back({distance(guard_.point(point), guard_.point(to)), point, to,
                      (*ends)[static_cast<std::size_t>(1 - i)], first->second});
  }
  return result;
}

/// Returns whether the new edge is near the old line and the removed points are near the new edge.
bool LineShortener::line_allowed(const Candidate& c, double limit, std::vector<Vec3>& dropped) {
  for (const std::uint32_t end : {c.to, c.before}) {
    const auto found = dropped_.find(ordered(c.from, end));
    if (found != dropped_.end()) dropped.insert(dropped.end(), found->second.begin(), found->second.end());
  }
  dropped.push_back(guard_.original(c.from));
  const Vec3 &a = guard_.point(c.before), &b = guard_.point(c.to);
  const bool near = std::all_of(dropped.begin(), dropped.end(), [&](const Vec3& p) {
    return distance(p, nearest_on_segment(p, a, b)) <= limit;
  });
  return near && kinds_[c.kind].near->within({a, b, b}, limit);
}

/// Adds the change of a patch. A triangle between the two edges of the line is removed, and the one beyond it
/// stays as it is. Returns false if the patch cannot lose the edge.
bool LineShortener::add_change(const Use& use, std::uint32_t to, SurfaceChange& change,
                               std::vector<Removal>& removals) const {
  PatchMesh& mesh = patches_[use.patch].mesh;
  const Vertex vertex(use.vertex);
  const Halfedge along = border_to(mesh, vertex, to);
  if (!along.is_valid()) return false;
  SurfaceChange part;
  if (mesh.valence(vertex) == 2) {
    const auto face = *mesh.cvf_begin(vertex);
    for (const Halfedge h : mesh.fh_range(face)) {
      if (mesh.from_vertex_handle(h) == vertex || mesh.to_vertex_handle(h) == vertex) continue;
      const auto beyond = mesh.opposite_face_handle(h);
      if (!beyond.is_valid()) return false;
      part = unchanged(mesh, beyond);
    }
    part.old_faces.push_back(mesh.data(face).triangle);
    removals.push_back({use.patch, Halfedge(), face});
  } else {
    if (!mesh.is_collapse_ok(along)) return false;
    part = collapse_change(patches_[use.patch], along.idx());
    removals.push_back({use.patch, along, PatchMesh::FaceHandle()});
  }
  change.old_faces.insert(change.old_faces.end(), part.old_faces.begin(), part.old_faces.end());
  change.faces.insert(change.faces.end(), part.faces.begin(), part.faces.end());
  return true;
}

bool LineShortener::collapse(const Candidate& c, double least_angle) {
  SurfaceChange change;
  std::vector<Removal> removals;
  for (const Use* use : uses_of(c.from)) {
    if (!add_change(*use, c.to, change, removals)) return false;
  }
  change.dropped = c.from;
  change.line = {c.before, c.to};
  change.least_angle = least_angle;
  std::vector<Vec3> dropped;
  if (!line_allowed(c, guard_.limit_at(change.old_faces), dropped) || !guard_.allows(change)) return false;
  guard_.apply(change);
  for (const Removal& removal : removals) {
    PatchMesh& mesh = patches_[removal.patch].mesh;
    if (removal.face.is_valid()) {
      mesh.delete_face(removal.face);
    } else {
      mesh.collapse(removal.halfedge);
    }
  }
  for (const std::uint32_t end : {c.to, c.before}) {
    dropped_.erase(ordered(c.from, end));
    kind_of_edge_.erase(ordered(c.from, end));
  }
  dropped_[ordered(c.before, c.to)] = std::move(dropped);
  kind_of_edge_[ordered(c.before, c.to)] = c.kind;
  return true;
}

std::size_t LineShortener::shorten(double least_angle, const Progress& progress) {
  find_uses();
  std::vector<char> gone;
  std::priority_queue<Candidate> queue;
  const auto push = [&](std::uint32_t point) {
    for (const Candidate& c : candidates_at(point)) queue.push(c);
  };
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    if (i == 0 || uses_[i].point != uses_[i - 1].point) push(uses_[i].point);
  }
  if (!uses_.empty()) gone.assign(uses_.back().point + 1, 0);
  std::size_t collapses = 0, looked = 0;
  while (!queue.empty()) {
    const Candidate c = queue.top();
    queue.pop();
    if (++looked % 256 == 0) progress.check();
    if (gone[c.from] != 0 || gone[c.to] != 0 || gone[c.before] != 0) continue;
    // The candidates of a changed line are added again.
    const auto ends = neighbours(c.from);
    if (!ends || *ends != ordered(c.to, c.before) || !collapse(c, least_angle)) continue;
    gone[c.from] = 1;
    ++collapses;
    push(c.to);
    push(c.before);
  }
  return collapses;
}

}  // namespace adamas::interfaces
