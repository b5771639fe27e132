#pragma once

#include <istream>
#include <string>
#include <vector>

#include "adamas/camera_path.h"
#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// Returns the viewpoints of a camera path round a box, with pictures of this size. Throws Error where an
/// orbit has no frames or too many, and where a file cannot be read or has no viewpoints.
std::vector<Viewpoint> flight(const CameraPath& path, const Box3& box, int width_pixels, int height_pixels);

/// Returns a viewpoint at a place, with all other settings of `first`. `name` begins messages. Throws Error
/// where a number is not finite, the eye is at the target, or looks along the upward direction.
Viewpoint viewpoint_at(const CameraPlace& place, const std::string& name, const Viewpoint& first);

/// Returns a parallel projection of all of a box from one side: errors in pixels are the same everywhere.
Viewpoint from_everywhere(const Box3& box, int width_pixels, int height_pixels);

/// Reads the viewpoints of such a file; `name` begins messages. All other settings are those of `first`.
std::vector<Viewpoint> read_viewpoints(std::istream& file, const std::string& name, const Viewpoint& first);

}  // namespace adamas::isosurface
