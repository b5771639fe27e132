#include "interfaces/simplification/patch_decimater.h"

#include <OpenMesh/Tools/Decimater/BaseDecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <queue>
#include <vector>

#include "interfaces/simplification/openmesh_patches.h"

namespace adamas {

namespace {

/// Weight of an edge's squared length beside the quadric error, which is in parts of the squared limit: among
/// collapses that err little, short edges go first.
constexpr double kLengthWeight = 0.05;
/// Collapses between two looks at whether the user wants to stop.
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

/// An OpenMesh decimation module: refuses what a guard refuses, and keeps it up to date.
template <class MeshT>
class ModGuardT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModGuardT, MeshT, Guard)  // NOLINT: OpenMesh's names

  explicit ModGuardT(MeshT& mesh) : Base(mesh, true) {}
  /// Before the first collapse. The guard must outlive the decimater.
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

/// An OpenMesh decimater of one patch, by error quadrics and a guard. OpenMesh's own asks its modules about
/// every collapse that it may come to, and not again when it comes to it; this one asks when it comes to it,
/// since a guard's answers take long and change with other patches.
class PatchDecimater : public OpenMesh::Decimater::BaseDecimaterT<PatchMesh> {
 public:
  /// Vertices that are not to go are marked as locked.
  PatchDecimater(PatchMesh& mesh, SurfaceGuard& guard, double least_angle);
  /// Collapses as long as something may be; returns how often.
  std::size_t decimate(const Progress& progress);

 private:
  using Halfedge = PatchMesh::HalfedgeHandle;
  using Vertex = PatchMesh::VertexHandle;
  struct Candidate {
    float priority;
    int vertex;
    std::uint32_t version;  ///< of the vertex's surroundings
    Halfedge halfedge;
    /// The least one comes first out of a queue.
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
  std::vector<std::uint32_t> refused_;  ///< by half-edge: in which version of its first vertex, and 1 more
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

}  // namespace adamas
