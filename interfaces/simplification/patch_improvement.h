#pragma once

#include <cstddef>
#include <vector>

#include "core/base/progress.h"
#include "interfaces/network/closest_point_tree.h"

namespace adamas {

struct InterfacePatch;
class SurfaceGuard;

/// Flips edges inside of a patch where that makes the smallest angle of the two triangles greater and the
/// guard allows it; returns how often.
std::size_t flip_edges(InterfacePatch& patch, SurfaceGuard& guard, const Progress& progress);

/// Moves the points inside of a patch towards the middle of their neighbours and back onto the original
/// interface, where that makes the smallest angle round them no smaller and the guard allows it; returns how
/// often. Points that are marked as locked stay.
std::size_t smooth_points(InterfacePatch& patch, const ClosestPointTree& original, SurfaceGuard& guard,
                          const Progress& progress);

}  // namespace adamas
