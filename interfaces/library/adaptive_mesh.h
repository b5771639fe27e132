#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include "adamas/resample.h"
#include "core/data/interface_mesh.h"
#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas {

/// What stands behind an AdaptiveMesh.
struct AdaptiveMesh::Contents {
  interfaces::ResampledMesh mesh;
  ResampleReport report;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  mutable std::once_flag once;  ///< for what follows
  mutable UnstructuredMesh arrays;
  mutable TetrahedraView view;
};

}  // namespace adamas
