#pragma once

#include <string>

#include "interfaces/comparison/piecewise_linear_complex.h"

namespace adamas::interfaces {

/// Finds the body of each tetrahedron of a mesh that has some of its faces marked by the complex's patches:
/// tetrahedra that no marked face separates form one region; a side of the box determines the body of the
/// region behind it, and an interface that of the region beyond. Sets `bodies`; returns the fault if marks
/// contradict each other or do not reach a region, else an empty text.
std::string name_regions(const PiecewiseLinearComplex& complex,
                         const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                         const std::vector<std::array<std::uint32_t, 3>>& marked,
                         const std::vector<std::uint32_t>& patches, std::vector<BodyId>& bodies);

}  // namespace adamas::interfaces
