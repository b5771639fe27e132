#pragma once

#include <vector>

#include "adamas/progress.h"
#include "interfaces/comparison/box_stitching.h"
#include "interfaces/comparison/comparison.h"

namespace adamas::interfaces {

/// The resampled mesh with which others are compared.
struct OwnMesh {
  ComparedMesh row, cut_row;
  std::vector<Vec3> interface_points;
  std::vector<BodyTriangle> interfaces;
  double half_width = 0;           ///< half the width of the box in which displaced elements are sought
  std::vector<char> at_interface;  ///< by native element: whether its cell has an interface
};

/// Resamples the source and measures the mesh. The source is first resampled without its fields; this time
/// and memory are compared with those of generators, which make no fields.
OwnMesh make_own_mesh(const ResamplingSource& source, const ResamplingOptions& options, Progress& progress);

}  // namespace adamas::interfaces
