#pragma once

#include <OpenMesh/Tools/Decimater/BaseDecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <cstddef>
#include <queue>
#include <vector>

#include "core/base/progress.h"
#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas {

/// What the collapse of a half-edge changes: its first point goes to its second.
SurfaceChange collapse_change(const PatchMesh& mesh, PatchMesh::HalfedgeHandle halfedge);

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
    SurfaceChange change = collapse_change(Base::mesh(), collapse.v0v1);
    change.least_angle = least_angle_;
    return guard_->allows(change) ? float(Base::LEGAL_COLLAPSE) : float(Base::ILLEGAL_COLLAPSE);
  }
  void preprocess_collapse(const CollapseInfo& collapse) override {
    guard_->apply(collapse_change(Base::mesh(), collapse.v0v1));
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

}  // namespace adamas
