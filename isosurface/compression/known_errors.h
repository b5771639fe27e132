#pragma once

#include <array>
#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// Error codes of a row of points, i from 0 to 15.
using ErrorRow = std::array<std::int32_t, PageGrid::kSide>;

/// What the samples next to points tell of their diamonds' errors, where the scale's greatest error is that of the
/// longest edge and the spacing is the same along all axes: for edges along the axis `own`, and for faces across
/// it, whose row is at `q`. `heights` is the row's first in a PaddedGrid. Points of other kinds get numbers that
/// mean nothing.
void known_edge_errors(const float* heights, int own, ErrorRow& row);
void known_face_errors(const float* heights, LatticePoint q, int own, ErrorRow& row);

}  // namespace adamas
