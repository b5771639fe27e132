#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// What a frame is to be like.
struct FrameRequest {
  Viewpoint viewpoint;
  /// Of a picture from there: diamonds that it hides are not split (D 4.10). Null: all are as if visible.
  std::shared_ptr<const DepthPyramid> depths;
  double isovalue = 0;
  /// Diamonds whose isosurface error may take more pixels are split.
  double pixels = 1;
  /// The surface has never more triangles than these, or those of the mesh in which nothing is split.
  std::optional<std::uint64_t> max_triangles;
  /// Whether nothing but pages that are decoded in memory is used, so that the frame waits for no disk: what
  /// needs others stays coarser (PagedFrames::missing_pages). QueuedFrames takes no notice.
  bool resident_only = false;
  /// Asked before each split and merge: the work ends when it says so. Whenever that is, the mesh is whole,
  /// the surface closed, and the number of triangles within its limit.
  std::function<bool()> stop;
};

/// What a frame came to.
struct FrameFigures {
  /// The greatest error of the diamonds that are in sight and not split, in pixels: an estimate, as
  /// isosurface errors are. 0 where none is left. What depths hide is not in sight.
  double largest_error = 0;
  std::uint64_t triangles = 0;
  std::uint64_t splits = 0, merges = 0;
  /// Diamonds, and whole pages of them, that were looked up in the depths, and those of them that are hidden.
  /// QueuedFrames does not count.
  std::uint64_t depth_tests = 0, hidden = 0;
  /// Of a frame of resident pages only: how many pages it does without for now, and how many wants of pages
  /// there are that cannot be had at all.
  std::uint64_t pages_missing = 0, pages_lost = 0;
  bool stopped = false;
};

}  // namespace adamas::isosurface
