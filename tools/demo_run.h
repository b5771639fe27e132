#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/mesh/extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/source.h"

namespace adamas::demo {

/// What one run of the resampler gave.
struct RunFigures {
  double target = 0;                          ///< wanted interface error
  std::optional<InterfaceDistance> distance;  ///< measured; none without interfaces
  std::size_t tetrahedra = 0, vertices = 0, interface_tetrahedra = 0;
  std::vector<FieldError> fields;        ///< per field of the source
  IdVector<MaterialId, double> volumes;  ///< of the mesh
  double seconds = 0;
};

/// A finished run, its mesh and its interfaces.
struct Run {
  RunFigures figures;
  ResampledMesh mesh;
  ExtractedInterfaces interfaces;
};

/// Resamples within the interface error.
Run resample(const ResamplingSource& source, double interface_error);

}  // namespace adamas::demo
