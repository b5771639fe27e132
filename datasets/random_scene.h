#pragma once

#include <cstdint>

#include "datasets/scene.h"

namespace adamas::datasets {

/// A random scene of 2 to 6 materials, all of them present: half-spaces, balls, and thin layers, plane or
/// round, that end inside the box. Overlaps are decided by the greatest value, as in all scenes. Many shapes
/// pass close to points of the lattice with 16 cells a side, and many planes lie almost along its edges or
/// faces, so that triple lines do too.
SceneDescription random_scene(const Box3& box, std::uint64_t seed);

}  // namespace adamas::datasets
