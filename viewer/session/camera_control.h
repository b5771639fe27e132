#pragma once

#include <cstddef>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/contents/view_state.h"

namespace adamas::viewer {

// These functions change a viewpoint by mouse and keys. Lengths in the picture are in pixels, to the right
// and downwards.

/// Rotates the view as the mouse moves: the height of the picture is half a turn.
isosurface::Viewpoint rotated(const isosurface::Viewpoint& viewpoint, CameraMode mode, double right,
                              double down);
/// Moves eye and target so that the target follows the mouse.
isosurface::Viewpoint panned(const isosurface::Viewpoint& viewpoint, double right, double down);
/// Moves the eye to the target, or away from it, by a tenth of the distance for each step of the wheel.
isosurface::Viewpoint zoomed(const isosurface::Viewpoint& viewpoint, double steps);
/// Moves eye and target along the axes of the view, in units of the distance between them.
isosurface::Viewpoint flown(const isosurface::Viewpoint& viewpoint, double forward, double right, double up);
/// Shows all of a box in the direction of the viewpoint.
isosurface::Viewpoint showing_all(const isosurface::Viewpoint& viewpoint, const Box3& box);
/// Looks in a direction, with another one upwards, at the same target from the same distance.
isosurface::Viewpoint looking(const isosurface::Viewpoint& viewpoint, const Vec3& direction, const Vec3& up);
/// The viewpoint with the picture size of another one.
isosurface::Viewpoint sized_as(const isosurface::Viewpoint& viewpoint, const isosurface::Viewpoint& other);
/// The viewpoint in parallel projection or in perspective; things at the target keep their size.
isosurface::Viewpoint with_projection(const isosurface::Viewpoint& viewpoint, bool is_parallel);
/// A viewpoint between two others, 0 <= t <= 1: the eye moves on an arc round the target, directions turn,
/// and distances change in proportion.
isosurface::Viewpoint between(const isosurface::Viewpoint& from, const isosurface::Viewpoint& to, double t);
/// The viewpoint of a frame, counted from 0, on a path that goes from its first viewpoint in the first frame
/// to its last one in the last frame.
isosurface::Viewpoint along(const std::vector<isosurface::Viewpoint>& path, std::size_t frame,
                            std::size_t frames);

}  // namespace adamas::viewer
