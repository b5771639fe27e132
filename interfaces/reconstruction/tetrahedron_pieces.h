#pragma once

#include <array>
#include <vector>

#include "core/geometry/partition.h"

namespace adamas {

/// A tetrahedron in another one, by the weights of its corners there, and its volume in relation to it.
struct TetrahedronPiece {
  std::array<Weights, 4> corners;
  double volume;
};

/// The other one itself.
inline constexpr TetrahedronPiece kWholeTetrahedron{
    {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, 1};

/// Leaves of the pieces what lies where the linear function with these values at the corners is positive.
/// `scratch` is room to work in.
void keep_positive(const std::array<double, 4>& values, std::vector<TetrahedronPiece>& pieces,
                   std::vector<TetrahedronPiece>& scratch);

}  // namespace adamas
