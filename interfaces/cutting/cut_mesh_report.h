#pragma once

#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

/// The quality and the distances of a cut mesh, and what it lacks of the mesh that was cut.
struct CutMeshReport {
  DihedralRange dihedral;
  InterfaceCertificate distance;  ///< from the interfaces of the mesh that was cut, both ways
  /// A body that has come into another number of pieces, or has other holes and handles; none of either where
  /// it is lost.
  struct ChangedBody {
    BodyId body;
    BodyTopology of_mesh, of_cut;
    double volume = 0;  ///< in the mesh that was cut
  };
  std::vector<ChangedBody> changed;
  double volume_difference = 0;  ///< the greatest of a body, in the cube of the unit of length
};

/// `target`: a distance that matters.
CutMeshReport examine_cut_mesh(const ConformingMesh& cut, const ResampledMesh& mesh, double target,
                               Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
