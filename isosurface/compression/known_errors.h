#pragma once

#include <array>
#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/compression/height_grid.h"
#include "isosurface/storage/page_grid.h"

namespace adamas {

/// Error codes of the points of a kind in a row: the first, and those that follow it in steps of two.
using ErrorRow = std::array<std::int32_t, PageGrid::kSide / 2>;

/// What the samples next to points tell of their diamonds' errors, where the scale's greatest error is that
/// of the longest edge and the spacing is the same along all axes: of the row from q on, for edges along the
/// axis `own`, and for faces across it.
void known_edge_errors(const HeightGrid& heights, LatticePoint q, int own, ErrorRow& row);
void known_face_errors(const HeightGrid& heights, LatticePoint q, int own, ErrorRow& row);
void known_centre_errors(const HeightGrid& heights, LatticePoint q, ErrorRow& row);

}  // namespace adamas
