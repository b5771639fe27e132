#pragma once

#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

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
