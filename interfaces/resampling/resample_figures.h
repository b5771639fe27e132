#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "adamas/resample.h"
#include "core/base/error.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// A body of the input, and what became of it.
struct BodyFigures {
  MaterialId material;
  std::optional<double> volume_input;  ///< volume in the input, where it is known
  double volume = 0;                   ///< volume in the mesh
  BodyTopology topology_input, topology_mesh;
  bool lost = false;     ///< the mesh shows nothing of it
  bool changed = false;  ///< the mesh shows it torn, or with other holes or handles
  Vec3 place;            ///< a point of its boundary in the input

  /// The difference of the volume in the mesh from that in the input, which must be known.
  [[nodiscard]] double missing() const { return std::abs(*volume_input - volume); }
  /// That difference in relation to the volume in the input; 0 where this is not above 0.
  [[nodiscard]] double volume_error() const { return *volume_input > 0 ? missing() / *volume_input : 0; }
};

/// Volumes that differ by no more than this, in relation to the domain's, count as conserved.
inline constexpr double kConserved = 1e-9;

/// What a run of the resampler came to.
struct ResampleFigures {
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t interface_tetrahedra = 0;         ///< tetrahedra that an approximated interface runs through
  std::size_t lost_interfaces = 0;              ///< cells whose interface the approximation does not show
  std::size_t flagged_vertices = 0;             ///< vertices whose material or signs rest on an open border
  std::vector<BodyFigures> bodies;              ///< bodies of the input
  std::vector<FieldFigures> fields;             ///< errors of the source's fields
  std::vector<std::array<BodyId, 2>> contacts;  ///< pairs of bodies that touch in the mesh alone
  IdVector<MaterialId, double> volumes;         ///< volumes in the mesh
};

/// Works out the figures of a resampler that has refined. Throws Cancelled where the progress says so.
ResampleFigures measure(const Resampler& resampler, const Progress& progress);

/// The body with the greatest error of its volume; none where volumes are not known.
std::optional<BodyId> worst_volume(const ResampleFigures& measured);

/// Materials that the input has and the mesh does not show.
std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source);

/// The errors that were wanted and not reached: of the interfaces, of the boundary of the worst material, of
/// junction lines, and of the fields, whose errors in the whole mesh are given.
std::vector<UnreachedError> unreached_errors(const Resampler& resampler,
                                             const std::vector<FieldFigures>& fields);

/// The shortfall of one of the certificate's distances; none where it is within the interface error.
std::optional<Shortfall> interface_shortfall(const Resampler& resampler, const InterfaceDistance& distance);

/// The shortfall of a field's error, given its errors in the whole mesh; none where it was reached, or not
/// wanted.
std::optional<Shortfall> field_shortfall(const Resampler& resampler, std::size_t field,
                                         const FieldError& errors);

/// The shortfall of a body's volume, with a point of the body's boundary for a place; none where the error
/// wanted was reached, or none was wanted.
std::optional<Shortfall> volume_shortfall(const Resampler& resampler, const ResampleFigures& measured,
                                          BodyId body);

}  // namespace adamas::interfaces
