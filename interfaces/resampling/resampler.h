#pragma once

#include <cstdint>
#include <memory>
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

  /// The source must outlive the resampler; missing field errors count as not wanted. Throws Error for an
  /// interface error that is not positive and a limit below the number of tetrahedra of the roots.
  Resampler(const ResamplingSource& source, ResamplingOptions options,
            Progress& progress = SilentProgress::instance())
      : state_(source, std::move(options), progress) {}

  /// Refines the hierarchy; this or the next is to be called once. Throws Cancelled where the progress says
  /// so.
  void refine();
  /// Refines a hierarchy of the same domain that another resampler has left, as that of the step before of a
  /// series: what these interfaces do not need is merged, what they need is split. The result is that of
  /// refine(), to the last bit and number. With a greatest number of tetrahedra refinement begins at the
  /// roots, since what fits into it depends on the way from there. Throws Error for another domain.
  void refine(MeshHierarchy from);
  /// Gives the hierarchy away; this object can only be destroyed then.
  [[nodiscard]] MeshHierarchy give_hierarchy() { return std::move(state_.hierarchy); }
  /// What became of the hierarchy that refinement began with; none where it began at the roots.
  [[nodiscard]] const std::optional<Adaptation>& adaptation() const { return adaptation_; }

  [[nodiscard]] const MeshHierarchy& hierarchy() const { return state_.hierarchy; }
  [[nodiscard]] const ResamplingSource& source() const { return state_.source; }
  [[nodiscard]] const ResamplingOptions& options() const { return state_.options; }
  /// Measured distances; none where `certify` is off or there are no interfaces.
  [[nodiscard]] const std::optional<InterfaceCertificate>& certificate() const { return certificate_; }
  /// What became of the input's bodies; null where `certify` is off or there are no interfaces.
  [[nodiscard]] const BodyReport* body_report() const { return body_report_ ? &*body_report_ : nullptr; }
  /// Why the interface error is not less; kReached where none was measured.
  [[nodiscard]] RefinementEnd interface_end() const { return interface_end_; }
  /// What splitting for the sake of volumes aimed at; null where no error of volumes is wanted, or none was
  /// looked at.
  [[nodiscard]] const VolumeGoal* volume_goal(BodyId body) const {
    return volume_goals_.empty() ? nullptr : &volume_goals_[body];
  }
  /// Why splitting ended for a body whose volume is off.
  [[nodiscard]] RefinementEnd volume_end(BodyId body) const {
    return volume_ends_.empty() ? RefinementEnd::kReached : volume_ends_[body];
  }
  /// Whether the greatest number of tetrahedra has stopped refinement.
  [[nodiscard]] bool budget_spent() const { return state_.budget_spent; }

  /// A tetrahedron of the tree, leaf or not, in space.
  [[nodiscard]] Tetrahedron frame(TetrahedronId t) const { return state_.frame(t); }
  /// Finds who owns what of a tetrahedron of the tree, leaf or not.
  void ownership(TetrahedronId t, CellOwnership& result) const { state_.ownership(t, result); }
  /// A body's fields at a vertex.
  [[nodiscard]] std::vector<double> row(VertexId v, BodyId body) const;
  /// The native elements in a tetrahedron of the tree, leaf or not.
  [[nodiscard]] std::span<const std::uint32_t> elements(TetrahedronId t) const;
  /// How far the mesh may have moved the place of an element: the greater of the interface errors wanted and
  /// certified per material.
  [[nodiscard]] double displacement() const { return state_.displacement; }
  /// The leaf that holds a point.
  [[nodiscard]] TetrahedronId leaf_at(const Vec3& p) const { return state_.leaf_at(p); }
  /// The body that owns a point.
  [[nodiscard]] BodyId owner_at(const Vec3& p) const;
  /// The leaves, and what their vertices know; valid until the hierarchy changes.
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

/// The leaves of a resampler that has refined, as a mesh on its own.
ResampledMesh resampled_mesh(const Resampler& resampler);

/// The interfaces that the leaves of a resampler show, between materials.
InterfaceMesh approximated_interfaces(const Resampler& resampler,
                                      Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
