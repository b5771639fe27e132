#pragma once

#include <string>

#include "interfaces/comparison/piecewise_linear_complex.h"
#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// Finds the body of each tetrahedron of a mesh that has some of its faces marked by the complex's patches:
/// what no marked face separates is one region; a side of the box tells the body of the region behind it, and
/// an interface that of the region beyond. Fills `bodies`; returns what is wrong where marks contradict each
/// other or do not reach a region, else nothing.
std::string name_regions(const PiecewiseLinearComplex& complex,
                         const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                         const std::vector<std::array<std::uint32_t, 3>>& marked,
                         const std::vector<std::uint32_t>& patches, std::vector<BodyId>& bodies);

}  // namespace adamas::interfaces
