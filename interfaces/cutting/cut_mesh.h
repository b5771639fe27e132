#pragma once

#include <vector>

#include "adamas/progress.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/interface_comparison.h"

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

/// The quality of a cut mesh and its differences from the mesh that was cut.
struct CutMeshExamination {
  DihedralRange dihedral;
  InterfaceCertificate distance;  ///< the distances between the interfaces of the two meshes, both ways
  /// A body whose number of pieces, holes or handles has changed; `of_cut` is empty if the body is lost.
  struct ChangedBody {
    BodyId body;
    BodyTopology of_mesh, of_cut;
    double volume = 0;  ///< the volume in the mesh that was cut
  };
  std::vector<ChangedBody> changed;
  double volume_difference = 0;  ///< the greatest difference for a body, in the cube of the unit of length
};

/// Measures a cut mesh against the mesh that was cut. `target`: distances are measured exactly enough to
/// compare them with it.
CutMeshExamination examine_cut_mesh(const ConformingMesh& cut, const ResampledMesh& mesh, double target,
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
