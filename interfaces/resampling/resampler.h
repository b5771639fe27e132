#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/adaptation.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/resampling/volume_refinement.h"

namespace adamas::interfaces {

/// Builds a hierarchy that approximates the source within the wanted errors (docs/method.md, Building): the
/// interfaces first (Refinement, Certification), then the fields. The result does not depend on the number of
/// threads.
class Resampler {
 public:
  using MeshHierarchy = interfaces::MeshHierarchy;

  /// The source must outlive the resampler; missing field errors count as not wanted. Throws Error if the
  /// interface error is not positive or the limit is below the number of root tetrahedra.
  Resampler(const ResamplingSource& source, ResamplingOptions options,
            Progress& progress = SilentProgress::instance())
      : state_(source, std::move(options), progress) {}

  /// Refines the hierarchy; one of the two functions is to be called once. Throws Cancelled if the progress
  /// requests it.
  void refine();
  /// Refines a hierarchy of the same domain from another resampler, such as that of the previous step of a
  /// series: cells that the interfaces do not need are merged, others are split. The result is exactly that
  /// of refine(), including all numbers. If the number of tetrahedra is limited, refinement begins at the
  /// roots, since the result then depends on the order of splits. Throws Error for another domain.
  void refine(MeshHierarchy from);
  /// Moves the hierarchy out of this object, which can then only be destroyed.
  [[nodiscard]] MeshHierarchy give_hierarchy() { return std::move(state_.hierarchy); }
  /// Returns how the hierarchy was adapted with which refinement began; none if it began at the roots.
  [[nodiscard]] const std::optional<Adaptation>& adaptation() const { return adaptation_; }

  [[nodiscard]] const MeshHierarchy& hierarchy() const { return state_.hierarchy; }
  [[nodiscard]] const ResamplingSource& source() const { return state_.source; }
  [[nodiscard]] const ResamplingOptions& options() const { return state_.options; }
  /// Returns the measured distances; none if `certify` is off or there are no interfaces.
  [[nodiscard]] const std::optional<InterfaceCertificate>& certificate() const { return certificate_; }
  /// Returns the topology of the input's bodies in the mesh; null if `certify` is off or there are no
  /// interfaces.
  [[nodiscard]] const BodyReport* body_report() const { return body_report_ ? &*body_report_ : nullptr; }
  /// Returns why the interface error is not less; kReached if none was measured.
  [[nodiscard]] RefinementEnd interface_end() const { return interface_end_; }
  /// Returns the goal of splitting for a body's volume; null if no error of volumes is wanted or none was
  /// measured.
  [[nodiscard]] const VolumeGoal* volume_goal(BodyId body) const {
    return volume_goals_.empty() ? nullptr : &volume_goals_[body];
  }
  /// Returns why splitting ended for a body whose volume is off.
  [[nodiscard]] RefinementEnd volume_end(BodyId body) const {
    return volume_ends_.empty() ? RefinementEnd::kReached : volume_ends_[body];
  }
  /// Returns whether the greatest number of tetrahedra has stopped refinement.
  [[nodiscard]] bool budget_spent() const { return state_.budget_spent; }

  /// Returns the geometry of a tetrahedron of the tree, which need not be a leaf.
  [[nodiscard]] Tetrahedron frame(TetrahedronId t) const { return state_.frame(t); }
  /// Finds the ownership of a tetrahedron of the tree, which need not be a leaf.
  void ownership(TetrahedronId t, CellOwnership& result, const OwnershipNeeds& needs = {}) const {
    state_.ownership(t, result, needs);
  }
  /// Returns a body's fields at a vertex.
  [[nodiscard]] std::vector<double> row(VertexId v, BodyId body) const;
  /// Returns the native elements in a tetrahedron of the tree, which need not be a leaf.
  [[nodiscard]] std::span<const std::uint32_t> elements(TetrahedronId t) const;
  /// Returns the distance by which the mesh may have moved the place of an element: the greater one of the
  /// wanted interface error and the certified one per material.
  [[nodiscard]] double displacement() const { return state_.displacement; }
  /// Returns the leaf that holds a point.
  [[nodiscard]] TetrahedronId leaf_at(const Vec3& p) const { return state_.leaf_at(p); }
  /// Returns the body that owns a point.
  [[nodiscard]] BodyId owner_at(const Vec3& p) const;
  /// Returns the leaves with the distances at their vertices; valid until the hierarchy changes.
  [[nodiscard]] CellSet cells() const { return state_.cells(state_.leaves()); }

 private:
  void refine_further(Refinement& refinement);

  ResamplingState state_;
  std::optional<Adaptation> adaptation_;
  std::optional<InterfaceCertificate> certificate_;
  std::optional<BodyReport> body_report_;
  RefinementEnd interface_end_ = RefinementEnd::kReached;
  IdVector<BodyId, VolumeGoal> volume_goals_;
  IdVector<BodyId, RefinementEnd> volume_ends_;
};

/// Returns the leaves of a resampler that has refined, as a mesh that stands alone.
ResampledMesh resampled_mesh(const Resampler& resampler);

/// Returns the interfaces between materials that the leaves of a resampler show.
ExtractedInterfaces approximated_interfaces(const Resampler& resampler,
                                            Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
