#pragma once

#include <cstdint>

#include "datasets/scene.h"

namespace adamas::datasets {

/// A random scene of 2 to 6 materials, all of them present: half-spaces, balls, and thin layers, plane or
/// round, that end inside the box. Overlaps are decided as everywhere, by the greatest value. Many shapes
/// pass close by points of the lattice with 16 cells a side, and many planes lie almost along its edges or
/// faces, so that triple lines do too.
SceneDescription random_scene(const Box3& box, std::uint64_t seed);

}  // namespace adamas::datasets
