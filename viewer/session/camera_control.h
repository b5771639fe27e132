#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/document/view_state.h"

namespace adamas::viewer {

// What mouse and keys make of a viewpoint. Lengths in the picture are in pixels, to the right and downwards.

/// Turns by a way of the mouse: by half a turn over the height of the picture.
isosurface::Viewpoint rotated(const isosurface::Viewpoint& viewpoint, CameraMode mode, double right,
                              double down);
/// Moves eye and target, so that the target follows the mouse.
isosurface::Viewpoint panned(const isosurface::Viewpoint& viewpoint, double right, double down);
/// Goes a tenth of the way to the target for each step of the wheel, or away from it.
isosurface::Viewpoint zoomed(const isosurface::Viewpoint& viewpoint, double steps);
/// Moves along the axes of the view, by parts of the distance between eye and target.
isosurface::Viewpoint flown(const isosurface::Viewpoint& viewpoint, double forward, double right, double up);
/// Shows all of a box, from where the viewpoint looks.
isosurface::Viewpoint showing_all(const isosurface::Viewpoint& viewpoint, const Box3& box);
/// Looks in a direction with another one upwards, at the same target from the same distance.
isosurface::Viewpoint looking(const isosurface::Viewpoint& viewpoint, const Vec3& direction, const Vec3& up);
/// With the size of another viewpoint's picture.
isosurface::Viewpoint sized_as(const isosurface::Viewpoint& viewpoint, const isosurface::Viewpoint& other);
/// By parallel projection or in perspective, with what is at the target as large as before.
isosurface::Viewpoint with_projection(const isosurface::Viewpoint& viewpoint, bool is_parallel);
/// Between two viewpoints, 0 <= t <= 1: the eye on an arc round the target, directions turned, distances in
/// proportion.
isosurface::Viewpoint between(const isosurface::Viewpoint& from, const isosurface::Viewpoint& to, double t);
/// Where a frame of so many is, from 0 on, along some viewpoints: from the first one in the first frame to
/// the last one in the last frame.
isosurface::Viewpoint along(const std::vector<isosurface::Viewpoint>& path, std::size_t frame,
                            std::size_t frames);

}  // namespace adamas::viewer
