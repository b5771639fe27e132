#pragma once

#include <array>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "adamas/resample.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Volumes that differ by at most this, relative to the domain's volume, count as conserved.
inline constexpr double kConserved = 1e-9;

/// The results of a run of the resampler.
struct ResampleFigures {
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t interface_tetrahedra = 0;         ///< tetrahedra that an approximated interface runs through
  std::size_t lost_interfaces = 0;              ///< cells with an interface that the approximation does not
                                                ///< show
  std::size_t flagged_vertices = 0;             ///< vertices whose material or signs depend on an open border
  std::vector<ResampleReport::Body> bodies;     ///< the bodies of the input, without `missed_volume`
  std::vector<FieldFigures> fields;             ///< the errors of the source's fields
  std::vector<std::array<BodyId, 2>> contacts;  ///< the pairs of bodies that touch only in the mesh
  IdVector<MaterialId, double> volumes;         ///< volumes in the mesh
};

/// Computes the figures of a resampler that has refined. Throws Cancelled if the progress requests it.
ResampleFigures measure(const Resampler& resampler, const Progress& progress);

/// Returns the body with the greatest error of its volume; none if volumes are not known.
std::optional<BodyId> worst_volume(const ResampleFigures& measured);

/// Returns the materials that the input has and the mesh does not show.
std::vector<MaterialId> lost_materials(const ResampleFigures& measured, const ResamplingSource& source);

/// Returns the wanted errors that were not reached: of the interfaces, of the boundary of the worst material,
/// of junction lines, and of fields. `fields`: the errors of fields in the whole mesh.
std::vector<UnreachedError> unreached_errors(const Resampler& resampler,
                                             const std::vector<FieldFigures>& fields);

/// Returns the shortfall of one of the certificate's distances; none if it is within the interface error.
std::optional<Shortfall> interface_shortfall(const Resampler& resampler, const InterfaceDistance& distance);

/// Returns the shortfall of a field's error, given its errors in the whole mesh; none if the wanted error was
/// reached or none was wanted.
std::optional<Shortfall> field_shortfall(const Resampler& resampler, std::size_t field,
                                         const FieldError& errors);

/// Returns the shortfall of a body's volume, with a point of the body's boundary; none if the wanted error
/// was reached or none was wanted.
std::optional<Shortfall> volume_shortfall(const Resampler& resampler, const ResampleFigures& measured,
                                          BodyId body);

}  // namespace adamas::interfaces
