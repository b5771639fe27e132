#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/scene/view_state.h"

namespace adamas {

// What mouse and keys make of a viewpoint. Lengths in the picture are in pixels, to the right and downwards.

/// Turns by a way of the mouse: by half a turn over the height of the picture.
Viewpoint rotated(const Viewpoint& viewpoint, CameraMode mode, double right, double down);
/// Moves eye and target, so that the target follows the mouse.
Viewpoint panned(const Viewpoint& viewpoint, double right, double down);
/// Goes a tenth of the way to the target for each step of the wheel, or away from it.
Viewpoint zoomed(const Viewpoint& viewpoint, double steps);
/// Moves along the axes of the view, by parts of the distance between eye and target.
Viewpoint flown(const Viewpoint& viewpoint, double forward, double right, double up);
/// Shows all of a box, from where the viewpoint looks.
Viewpoint showing_all(const Viewpoint& viewpoint, const Box3& box);
/// Looks in a direction with another one upwards, at the same target from the same distance.
Viewpoint looking(const Viewpoint& viewpoint, const Vec3& direction, const Vec3& up);
/// With the size of another viewpoint's picture.
Viewpoint sized_as(const Viewpoint& viewpoint, const Viewpoint& other);
/// By parallel projection or in perspective, with what is at the target as large as before.
Viewpoint with_projection(const Viewpoint& viewpoint, bool is_parallel);
/// Between two viewpoints, 0 <= t <= 1: the eye on an arc round the target, directions turned, distances in
/// proportion.
Viewpoint between(const Viewpoint& from, const Viewpoint& to, double t);
/// Where a frame of so many is, from 0 on, along some viewpoints: from the first one in the first frame to
/// the last one in the last frame.
Viewpoint along(const std::vector<Viewpoint>& path, std::size_t frame, std::size_t frames);

}  // namespace adamas
