#pragma once

#include <cstddef>
#include <memory>

#include "adamas/meshes.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/view/frame_refinement.h"

namespace adamas {

/// What is to be drawn in a frame.
struct Frame {
  /// With normals, in the frame of the grid: the chunks of PagedFrames one after the other.
  TriangleSurface surface;
  FrameFigures figures;
  double update_seconds = 0;  ///< to find the mesh and its triangles, with normals, and to put them together
  double normal_seconds = 0;  ///< none: normals are part of the update
};

/// The surface of a store, frame after frame.
class StoreFrames {
 public:
  virtual ~StoreFrames() = default;

  /// Throws Error where the store is damaged.
  virtual Frame next(const FrameRequest& request) = 0;
  [[nodiscard]] virtual PageCounts counts() const = 0;
  /// From the first sample to the last, in the grid's frame.
  [[nodiscard]] virtual Box3 data_box() const = 0;

  /// `memory`: bytes that decoded pages may take. The file must outlive the frames.
  static std::unique_ptr<StoreFrames> open(StoreFile& file, std::size_t memory);
};

}  // namespace adamas
