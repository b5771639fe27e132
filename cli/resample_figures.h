#pragma once

#include <optional>
#include <vector>

#include "cli/figures.h"
#include "core/base/progress.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

/// What a run of the resampler came to (the keys of `--json`).
struct ResampleFigures {
  std::size_t tetrahedra = 0, vertices = 0;
  std::size_t interface_tetrahedra = 0;  ///< that an approximated interface runs through
  std::size_t lost_interfaces = 0;       ///< cells whose interface the approximation does not show
  std::size_t flagged_vertices = 0;      ///< whose material or signs are doubtful: they rest on an open border
  std::size_t bodies = 0;
  std::vector<FieldFigures> fields;      ///< by the source's fields
  IdVector<MaterialId, double> volumes;  ///< of the mesh
};

ResampleFigures measure(const Resampler& resampler, const Progress& progress);

// Parts of `--json`; a figure that is not known is null.

/// Greatest and mean errors of one field.
Figures field_error_figures(const FieldFigures& errors);
/// The materials' names and their volumes in the input and in a mesh.
Figures volume_figures(const ResamplingSource& source, const IdVector<MaterialId, double>& volumes);
/// All keys that tell of the mesh.
Figures resample_json(const ResampleFigures& measured, const Resampler& resampler);

}  // namespace adamas
