#include "interfaces/simplification/patch_decimater.h"

#include <algorithm>

namespace adamas {

namespace {

/// Weight of an edge's squared length beside the quadric error, which is in parts of the squared limit: among
/// collapses that err little, short edges go first.
constexpr double kLengthWeight = 0.05;
/// Collapses between two looks at whether the user wants to stop.
constexpr std::size_t kCheckEvery = 256;

}  // namespace

SurfaceChange collapse_change(const PatchMesh& mesh, PatchMesh::HalfedgeHandle halfedge) {
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

}  // namespace adamas
