#pragma once

#include <cstddef>
#include <vector>

#include "core/data/rectilinear_grid.h"

namespace adamas {

/// Values of one centering moved to the other: each cell gets the mean of its points, each point the mean of
/// the cells round it. `values[site * components + c]` on the sites of `from`; the result is on those of the
/// same nodes with the centering `to`.
std::vector<float> average_to(Centering to, const RectilinearGrid& from, std::size_t components,
                              const std::vector<float>& values);

}  // namespace adamas
