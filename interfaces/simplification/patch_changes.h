#pragma once

#include <cstddef>

#include "adamas/progress.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas::interfaces {

struct InterfacePatch;

/// Returns the change by the collapse of a half-edge, given by its number: its first point moves to its
/// second.
SurfaceChange collapse_change(const InterfacePatch& patch, int halfedge);

/// Decimates a patch by error quadrics until the guard allows no further collapse; returns the number of
/// collapsed edges. Vertices marked as locked stay. There must be no elements marked as deleted.
std::size_t decimate_patch(InterfacePatch& patch, SurfaceGuard& guard, double least_angle,
                           const Progress& progress);

/// Flips edges inside a patch if that increases the smallest angle of the two triangles and the guard allows
/// it; returns the number of flipped edges.
std::size_t flip_edges(InterfacePatch& patch, SurfaceGuard& guard, const Progress& progress);

/// Moves the points inside a patch towards the middle of their neighbours and back onto the original
/// interface if that does not reduce the smallest angle round them and the guard allows it; returns the
/// number of moves. Points that are marked as locked stay.
std::size_t smooth_points(InterfacePatch& patch, const ClosestPointTree& original, SurfaceGuard& guard,
                          const Progress& progress);

}  // namespace adamas::interfaces
