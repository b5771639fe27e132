#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "isosurface/view/viewpoint.h"

namespace adamas {

/// What a frame is to be like.
struct FrameRequest {
  Viewpoint viewpoint;
  double isovalue = 0;
  /// Diamonds whose isosurface error may take more pixels are split.
  double pixels = 1;
  /// The surface has never more triangles than these, or those of the mesh in which nothing is split.
  std::optional<std::uint64_t> max_triangles;
  /// Asked before each split and merge: the work ends when it says so. Whenever that is, the mesh is whole,
  /// the surface closed, and the number of triangles within its limit.
  std::function<bool()> stop;
};

/// What a frame came to.
struct FrameFigures {
  /// The greatest error of the diamonds that are in sight and not split, in pixels: an estimate, as
  /// isosurface errors are. 0 where none is left.
  double largest_error = 0;
  std::uint64_t triangles = 0;
  std::uint64_t splits = 0, merges = 0;
  bool stopped = false;
};

}  // namespace adamas
