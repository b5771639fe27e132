#pragma once

#include <cstddef>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas::interfaces {

struct InterfacePatch;

/// What the collapse of a half-edge, by its number, changes: its first point goes to its second.
SurfaceChange collapse_change(const InterfacePatch& patch, int halfedge);

/// Decimates a patch by error quadrics as long as a guard allows it; returns how often an edge was collapsed.
/// Vertices that are not to go are marked as locked. What is marked as deleted must have been collected.
std::size_t decimate_patch(InterfacePatch& patch, SurfaceGuard& guard, double least_angle,
                           const Progress& progress);

/// Flips edges inside of a patch where that makes the smallest angle of the two triangles greater and the
/// guard allows it; returns how often.
std::size_t flip_edges(InterfacePatch& patch, SurfaceGuard& guard, const Progress& progress);

/// Moves the points inside of a patch towards the middle of their neighbours and back onto the original
/// interface, where that makes the smallest angle round them no smaller and the guard allows it; returns how
/// often. Points that are marked as locked stay.
std::size_t smooth_points(InterfacePatch& patch, const ClosestPointTree& original, SurfaceGuard& guard,
                          const Progress& progress);

}  // namespace adamas::interfaces
