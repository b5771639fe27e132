#pragma once

#include <vector>

#include "interfaces/comparison/box_stitching.h"
#include "interfaces/comparison/comparison.h"
#include "interfaces/comparison/element_errors.h"

namespace adamas::interfaces {

/// The resampled mesh that others are compared with.
struct OwnMesh {
  ComparedMesh row, cut_row;
  std::vector<Vec3> interface_points;
  std::vector<BodyTriangle> interfaces;
  double half_width = 0;           ///< of the box in which displaced elements are looked for
  std::vector<char> at_interface;  ///< whether the cell of a native element has an interface
};

/// Resamples and measures. The source is resampled without its fields first: that time and memory are
/// compared with those of generators, which make no fields.
OwnMesh make_own_mesh(const ResamplingSource& source, const ResamplingOptions& options, Progress& progress);

}  // namespace adamas::interfaces
