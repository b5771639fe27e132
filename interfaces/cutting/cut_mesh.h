#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// How far a cut mesh may be from the mesh, in relation to the mesh's interface error, unless said otherwise.
inline constexpr double kCutTolerance = 0.5;

/// The tolerance for a mesh of that interface error.
double default_cut_tolerance(const ResampledMesh& mesh, double interface_error);

/// A resampled mesh cut along its interfaces (docs/method.md, Cut meshes): tetrahedra of one body each,
/// conforming, without slivers, so that solvers can take it. `tolerance`: how far the faces between bodies
/// may be from the mesh's interfaces, in units of length; positive. Snapping and improvement keep to it
/// at the points that they look at, and restoring volumes moves points by no more; CutMeshReport has bounds.
ConformingMesh cut_mesh(const ResampledMesh& mesh, double tolerance,
                        Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
