#pragma once

#include <functional>
#include <vector>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// A function that receives the directions of the gradients of one plane.
using CodePlaneSink = std::function<void(const std::vector<OctahedralCode>&)>;

/// Gives the directions of a volume's smoothed gradients, plane by plane in ascending order; see
/// gradient_pages(); the options have a smoothing. A first pass finds the scale of the gradients. If not all
/// rows fit in the memory, strips of them are smoothed with as many rows on either side as there are rounds,
/// which are all that they depend on.
template <class Sample>
void smoothed_codes(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageOptions& options,
                    const CodePlaneSink& sink, Progress& progress);

}  // namespace adamas::isosurface
