#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// Options of a frame.
struct FrameRequest {
  Viewpoint viewpoint;
  /// The depths of a picture: diamonds that they hide are not split (D 4.10). Null: nothing is hidden.
  std::shared_ptr<const DepthPyramid> depths;
  double isovalue = 0;
  /// Diamonds whose isosurface error may take more pixels are split.
  double pixels = 1;
  /// The surface never has more triangles than this, or than that of the mesh in which nothing is split.
  std::optional<std::uint64_t> max_triangles;
  /// Use only pages that are decoded in memory, so that the frame does not wait for the disk: the surface
  /// stays coarser where other pages are needed (PagedFrames::missing_pages).
  bool resident_only = false;
  /// A function that is called repeatedly: the work ends when it returns true. In any case the mesh is
  /// conforming, the surface closed, and the number of triangles within its limit.
  std::function<bool()> stop;
};

struct FrameFigures {
  /// The greatest error of the diamonds that are in sight and not split, in pixels; 0 where there is none. It
  /// is an estimate, as isosurface errors are. Hidden diamonds are not in sight.
  double largest_error = 0;
  std::uint64_t triangles = 0;
  std::uint64_t splits = 0, merges = 0;
  /// The number of diamonds, and of whole pages of them, that were looked up in the depths, and the number of
  /// these that are hidden.
  std::uint64_t depth_tests = 0, hidden = 0;
  /// For a frame of resident pages only: the number of pages that are missing for now, and how often a lost
  /// page was needed.
  std::uint64_t pages_missing = 0, pages_lost = 0;
  bool stopped = false;
};

}  // namespace adamas::isosurface
