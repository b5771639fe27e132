#pragma once

#include <array>
#include <vector>

#include "core/picture/slice_picture.h"

namespace adamas::picture {

/// The properties of all panels of a slice that are needed before the layout.
struct SliceContents {
  Box2 window;       ///< the requested window, else the box of all points; empty if there are none
  ValueRange range;  ///< the requested range, else that of all values
  bool has_field = false;
  bool has_missing = false;           ///< whether some value is not finite
  bool below = false, above = false;  ///< whether some value lies outside the range
};

/// Surveys the panels of a picture. Throws Error for what draw_slice cannot draw.
SliceContents survey_slice(const SlicePicture& picture);

/// A window with a positive area: one that is empty, very flat or very narrow is widened about its middle.
Box2 shown_window(const Box2& window);

/// The parts inside the window of the segments points[2k] to points[2k + 1], each once, however often and in
/// whichever direction it occurs: neighbouring cells both have their common edge, which would look darker if
/// it were drawn twice.
std::vector<std::array<Vec2, 2>> shown_segments(const std::vector<Vec2>& points, const Box2& window);

}  // namespace adamas::picture
