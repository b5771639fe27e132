#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/view/frame_refinement.h"
#include "isosurface/view/surface_chunk.h"

namespace adamas {

/// The surface of a store, frame after frame.
class StoreFrames {
 public:
  virtual ~StoreFrames() = default;

  /// Throws Error where the store is damaged. With `resident_only` the pages that the frame lacks are loaded
  /// in a thread; what has come by then, the next frame has.
  virtual FrameFigures next(const FrameRequest& request) = 0;
  /// Whether pages are on their way that the last frame lacks. Each comes once at most for a view: where the
  /// memory has no room for what a view needs, some stay missing.
  [[nodiscard]] virtual bool is_paging() const = 0;
  /// Why pages cannot be had that were to be loaded, of the first one; empty: nothing.
  [[nodiscard]] virtual std::string paging_problem() const = 0;
  /// Calls for all parts of the last frame's surface, which are in the frame of the grid.
  virtual void for_each_chunk(const std::function<void(const SurfaceChunk&)>& visit) const = 0;
  /// The isosurface error of the cell of the last frame's mesh at a place, in the frame of the grid; an
  /// estimate. None where it is not known.
  [[nodiscard]] virtual std::optional<double> error_at(const Vec3& place) = 0;
  /// The cells of the last frame's mesh in a plane, as polygons; in the frame of the grid.
  [[nodiscard]] virtual std::vector<std::vector<Vec3>> cells_in(const Plane& plane) = 0;
  [[nodiscard]] virtual PageCounts counts() const = 0;
  /// From the first sample to the last, in the grid's frame.
  [[nodiscard]] virtual Box3 data_box() const = 0;

  /// `step`: one of the file's. `memory`: bytes that decoded pages may take. The file must outlive the
  /// frames. `arrived` is called in the thread that loads pages when some have come.
  static std::unique_ptr<StoreFrames> open(
      StoreFile& file, std::uint32_t step, std::size_t memory, std::function<void()> arrived = [] {});
};

}  // namespace adamas
