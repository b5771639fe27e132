#include "interfaces/simplification/patch_changes.h"

#include <OpenMesh/Tools/Decimater/BaseDecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <queue>
#include <vector>

#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas::interfaces {

namespace {

/// The weight of an edge's squared length, added to the quadric error relative to the squared limit: among
/// collapses with small errors, short edges come first.
constexpr double kLengthWeight = 0.05;
/// The number of collapses between two checks for cancellation.
constexpr std::size_t kCheckEvery = 256;

SurfaceChange change_of(const PatchMesh& mesh, PatchMesh::HalfedgeHandle halfedge) {
  SurfaceChange change;
  const auto from = mesh.from_vertex_handle(halfedge), to = mesh.to_vertex_handle(halfedge);
  change.dropped = mesh.data(from).point;
  for (const auto face : mesh.vf_range(from)) {
    change.old_faces.push_back(mesh.data(face).triangle);
    SurfaceChange::Face after{mesh.data(face).triangle, {}};
    bool vanishes = false;
    std::size_t c = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      vanishes = vanishes || vertex == to;
      after.corners[c++] = mesh.data(vertex == from ? to : vertex).point;
    }
    if (!vanishes) change.faces.push_back(after);
  }
  return change;
}

/// An OpenMesh decimation module that refuses collapses which a guard does not allow, and reports collapses
/// to it.
template <class MeshT>
class ModGuardT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModGuardT, MeshT, Guard)  // NOLINT: OpenMesh's names

  explicit ModGuardT(MeshT& mesh) : Base(mesh, true) {}
  /// Prepares the module before the first collapse. The guard must outlive the decimater.
  void set_guard(SurfaceGuard& guard, double least_angle) {
    guard_ = &guard;
    least_angle_ = least_angle;
  }

  float collapse_priority(const CollapseInfo& collapse) override {
    SurfaceChange change = change_of(Base::mesh(), collapse.v0v1);
    change.least_angle = least_angle_;
    return guard_->allows(change) ? float(Base::LEGAL_COLLAPSE) : float(Base::ILLEGAL_COLLAPSE);
  }
  void preprocess_collapse(const CollapseInfo& collapse) override {
    guard_->apply(change_of(Base::mesh(), collapse.v0v1));
  }

 private:
  SurfaceGuard* guard_ = nullptr;
  double least_angle_ = 0;
};

/// An OpenMesh decimater of one patch, by error quadrics and a guard. OpenMesh's own decimater asks its
/// modules about every possible collapse in advance, and not again when it is made; this one asks only then,
/// since a guard's answers take long and change with other patches.
class PatchDecimater : public OpenMesh::Decimater::BaseDecimaterT<PatchMesh> {
 public:
  /// Vertices that must stay are marked as locked.
  PatchDecimater(PatchMesh& mesh, SurfaceGuard& guard, double least_angle);
  /// Collapses edges until none may be collapsed; returns the number of collapses.
  std::size_t decimate(const Progress& progress);

 private:
  using Halfedge = PatchMesh::HalfedgeHandle;
  using Vertex = PatchMesh::VertexHandle;
  struct Candidate {
    float priority;
    int vertex;
    std::uint32_t version;  ///< the version of the vertex's neighbourhood
    Halfedge halfedge;
    /// Orders candidates so that a queue returns the least one first.
    bool operator<(const Candidate& other) const {
      return priority != other.priority ? priority > other.priority : vertex > other.vertex;
    }
  };

  void push_best(Vertex vertex);
  [[nodiscard]] float priority(const CollapseInfo& collapse);

  PatchMesh& mesh_;
  double limit_;
  OpenMesh::Decimater::ModQuadricT<PatchMesh>::Handle quadric_;
  ModGuardT<PatchMesh>::Handle guard_;
  std::priority_queue<Candidate> candidates_;
  std::vector<std::uint32_t> version_;  ///< by vertex
  std::vector<std::uint32_t> refused_;  ///< by half-edge: the version of its first vertex at the refusal,
                                        ///< plus 1; 0 for none
};

PatchDecimater::PatchDecimater(PatchMesh& mesh, SurfaceGuard& guard, double least_angle)
    : BaseDecimaterT<PatchMesh>(mesh), mesh_(mesh), limit_(guard.limit()) {
  add(quadric_);
  add(guard_);
  module(guard_).set_guard(guard, least_angle);
  initialize();
}

float PatchDecimater::priority(const CollapseInfo& collapse) {
  const double error = module(quadric_).collapse_priority(collapse);
  const double length = (collapse.p1 - collapse.p0).sqrnorm();
  return static_cast<float>(error / (limit_ * limit_) + kLengthWeight * length);
}

void PatchDecimater::push_best(Vertex vertex) {
  if (mesh_.status(vertex).locked() || mesh_.status(vertex).deleted()) return;
  const auto v = static_cast<std::size_t>(vertex.idx());
  Candidate best{0, vertex.idx(), version_[v], Halfedge()};
  for (const Halfedge halfedge : mesh_.voh_range(vertex)) {
    if (refused_[static_cast<std::size_t>(halfedge.idx())] == version_[v] + 1) continue;
    const CollapseInfo collapse(mesh_, halfedge);
    if (!is_collapse_legal(collapse)) continue;
    const float p = priority(collapse);
    if (!best.halfedge.is_valid() || p < best.priority) best.priority = p, best.halfedge = halfedge;
  }
  if (best.halfedge.is_valid()) candidates_.push(best);
}

std::size_t PatchDecimater::decimate(const Progress& progress) {
  version_.assign(mesh_.n_vertices(), 0);
  refused_.assign(mesh_.n_halfedges(), 0);
  candidates_ = {};
  for (const Vertex vertex : mesh_.vertices()) push_best(vertex);
  std::size_t collapses = 0, looked = 0;
  std::vector<Vertex> ring;
  while (!candidates_.empty()) {
    const Candidate best = candidates_.top();
    candidates_.pop();
    const Vertex vertex(best.vertex);
    if (mesh_.status(vertex).deleted() || best.version != version_[static_cast<std::size_t>(best.vertex)])
      continue;
    if (++looked % kCheckEvery == 0) progress.check();
    CollapseInfo collapse(mesh_, best.halfedge);
    if (!is_collapse_legal(collapse) || collapse_priority(collapse) < 0) {
      refused_[static_cast<std::size_t>(best.halfedge.idx())] = best.version + 1;
      push_best(vertex);
      continue;
    }
    ring.clear();
    for (const Vertex other : mesh_.vv_range(vertex)) ring.push_back(other);
    preprocess_collapse(collapse);
    mesh_.collapse(best.halfedge);
    postprocess_collapse(collapse);
    ++collapses;
    for (const Vertex other : ring) ++version_[static_cast<std::size_t>(other.idx())];
    for (const Vertex other : ring) push_best(other);
  }
  return collapses;
}

}  // namespace

SurfaceChange collapse_change(const InterfacePatch& patch, int halfedge) {
  return change_of(patch.mesh, PatchMesh::HalfedgeHandle(halfedge));
}

std::size_t decimate_patch(InterfacePatch& patch, SurfaceGuard& guard, double least_angle,
                           const Progress& progress) {
  return PatchDecimater(patch.mesh, guard, least_angle).decimate(progress);
}

namespace {

/// Flips that gain less than this, in degrees, are not made; otherwise flipping might never end.
constexpr double kLeastGain = 0.01;
constexpr int kMostFlipPasses = 10, kSmoothingPasses = 5;
/// The tried fractions of the way to the middle.
constexpr double kSteps[] = {1, 0.5, 0.25};

using Vertex = PatchMesh::VertexHandle;

/// Returns the change of the two triangles at an edge a-b, with opposite points c and d, when OpenMesh flips
/// it.
SurfaceChange flip_change(const PatchMesh& mesh, PatchMesh::EdgeHandle edge) {
  const auto first = mesh.halfedge_handle(edge, 0), second = mesh.halfedge_handle(edge, 1);
  const auto point = [&mesh](Vertex v) { return mesh.data(v).point; };
  const std::uint32_t a = point(mesh.from_vertex_handle(first)), b = point(mesh.to_vertex_handle(first)),
                      c = point(mesh.to_vertex_handle(mesh.next_halfedge_handle(first))),
                      d = point(mesh.to_vertex_handle(mesh.next_halfedge_handle(second)));
  const std::uint32_t f = mesh.data(mesh.face_handle(first)).triangle,
                      g = mesh.data(mesh.face_handle(second)).triangle;
  SurfaceChange change;
  change.old_faces = {f, g};
  change.faces = {{f, {a, d, c}}, {g, {d, b, c}}};
  return change;
}

}  // namespace

std::size_t flip_edges(InterfacePatch& patch, SurfaceGuard& guard, const Progress& progress) {
  PatchMesh& mesh = patch.mesh;
  std::size_t flips = 0;
  for (int pass = 0; pass < kMostFlipPasses; ++pass) {
    progress.check();
    const std::size_t before = flips;
    for (const auto edge : mesh.edges()) {
      if (mesh.status(edge).deleted() || mesh.is_boundary(edge) || !mesh.is_flip_ok(edge)) continue;
      SurfaceChange change = flip_change(mesh, edge);
      change.angle_above = guard.smallest_angle(change.old_faces) + kLeastGain;
      if (!guard.allows(change)) continue;
      guard.apply(change);
      mesh.flip(edge);
      ++flips;
    }
    if (flips == before) break;
  }
  return flips;
}

std::size_t smooth_points(InterfacePatch& patch, const ClosestPointTree& original, SurfaceGuard& guard,
                          const Progress& progress) {
  PatchMesh& mesh = patch.mesh;
  std::size_t moves = 0;
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    progress.check();
    for (const Vertex vertex : mesh.vertices()) {
      if (mesh.status(vertex).deleted() || mesh.status(vertex).locked()) continue;
      SurfaceChange change;
      for (const auto face : mesh.vf_range(vertex)) {
        SurfaceChange::Face same{mesh.data(face).triangle, {}};
        std::size_t c = 0;
        for (const Vertex corner : mesh.fv_range(face)) same.corners[c++] = mesh.data(corner).point;
        change.old_faces.push_back(same.face);
        change.faces.push_back(same);
      }
      Vec3 middle;
      double neighbours = 0;
      for (const Vertex other : mesh.vv_range(vertex))
        middle += from_openmesh(mesh.point(other)), ++neighbours;
      middle = 1 / neighbours * middle;
      const Vec3 from = from_openmesh(mesh.point(vertex));
      change.angle_above = guard.smallest_angle(change.old_faces);
      for (const double step : kSteps) {
        const auto closest = original.closest(from + step * (middle - from));
        if (!closest) break;
        change.move = {mesh.data(vertex).point, closest->point};
        if (!guard.allows(change)) continue;
        guard.apply(change);
        mesh.set_point(vertex, to_openmesh(closest->point));
        ++moves;
        break;
      }
    }
  }
  return moves;
}

}  // namespace adamas::interfaces
