#pragma once

#include <istream>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// The viewpoints of a flight, with pictures of this size. `path` is "orbit:N", which goes once round a box
/// in N frames, with z upwards; or the name of a text file with a viewpoint on each line: the coordinates of
/// the eye, of the target and of the upward direction, nine numbers between commas or spaces. Text after # is
/// a comment. Throws Error.
std::vector<Viewpoint> flight(const std::string& path, const Box3& box, int width_pixels, int height_pixels);

/// A parallel projection of all of a box from one side: errors in pixels are the same everywhere.
Viewpoint from_everywhere(const Box3& box, int width_pixels, int height_pixels);

/// Reads the viewpoints of such a file; `name` begins messages. All other settings are those of `first`.
std::vector<Viewpoint> read_viewpoints(std::istream& file, const std::string& name, const Viewpoint& first);

}  // namespace adamas::isosurface
