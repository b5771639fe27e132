#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// A body of the input, and what became of it.
struct BodyFigures {
  MaterialId material;
  std::optional<double> volume_input;  ///< where it is known
  double volume = 0;                   ///< in the mesh
  BodyTopology topology_input, topology_mesh;
  bool lost = false;     ///< the mesh shows nothing of it
  bool changed = false;  ///< torn, or with other holes or handles
  Vec3 place;            ///< a point of its boundary in the input

  /// By how much the volume in the mesh differs from that in the input, which must be known.
  [[nodiscard]] double missing() const { return std::abs(*volume_input - volume); }
  /// The same in relation to that in the input; 0 where this is not above 0.
  [[nodiscard]] double volume_error() const { return *volume_input > 0 ? missing() / *volume_input : 0; }
};

/// Volumes count as conserved that differ by no more than this, in relation to the domain's.
inline constexpr double kConserved = 1e-9;

/// What a run of the resampler came to.
struct ResampleFigures {
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t interface_tetrahedra = 0;         ///< that an approximated interface runs through
  std::size_t lost_interfaces = 0;              ///< cells whose interface the approximation does not show
  std::size_t flagged_vertices = 0;             ///< whose material or signs rest on an open border
  std::vector<BodyFigures> bodies;              ///< of the input
  std::vector<FieldFigures> fields;             ///< by the source's fields
  std::vector<std::array<BodyId, 2>> contacts;  ///< of bodies that touch in the mesh alone
  IdVector<MaterialId, double> volumes;         ///< of the mesh
};

ResampleFigures measure(const Resampler& resampler, const Progress& progress);

/// The body with the greatest error of its volume; none where volumes are not known.
std::optional<BodyId> worst_volume(const ResampleFigures& measured);

/// Materials that the input has and the mesh does not show.
std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source);

}  // namespace adamas::interfaces
