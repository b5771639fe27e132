#pragma once

#include <cstddef>

#include "core/base/progress.h"
#include "interfaces/simplification/surface_guard.h"

namespace adamas {

struct InterfacePatch;

/// What the collapse of a half-edge, by its number, changes: its first point goes to its second.
SurfaceChange collapse_change(const InterfacePatch& patch, int halfedge);

/// Decimates a patch by error quadrics as long as a guard allows it; returns how often an edge was collapsed.
/// Vertices that are not to go are marked as locked. What is marked as deleted must have been collected.
std::size_t decimate_patch(InterfacePatch& patch, SurfaceGuard& guard, double least_angle,
                           const Progress& progress);

}  // namespace adamas
