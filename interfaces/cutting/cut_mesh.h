#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// The default tolerance of a cut mesh relative to the mesh's interface error.
inline constexpr double kCutTolerance = 0.5;

/// Returns the default tolerance for a mesh with this interface error, in units of length.
double default_cut_tolerance(const ResampledMesh& mesh, double interface_error);

/// Cuts a resampled mesh along its interfaces (docs/method.md, Cut meshes): the result is conforming and
/// without slivers, and each tetrahedron lies in one body, as solvers need it. `tolerance`: the greatest
/// distance of the faces between bodies from the mesh's interfaces, in units of length; positive. Snapping
/// and improvement check it at sample points, and the restoration of volumes moves points by at most as much;
/// CutMeshExamination has bounds.
ConformingMesh cut_mesh(const ResampledMesh& mesh, double tolerance,
                        Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
