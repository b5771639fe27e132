#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/frame_request.h"
#include "isosurface/view/surface_chunk.h"
#include "timevarying/shared_pages.h"

namespace adamas::timevarying {

/// The number of pages that the last frame has used (`needed`), and how many of them are in memory for a step
/// (`pages`); damaged pages count as if they were in memory.
struct LoadedStep {
  std::uint32_t step = 0;
  std::uint64_t pages = 0, needed = 0;
};

/// The surfaces of a store of one or several steps, frame by frame. Each is independent of the frames before
/// it, although its computation begins with the mesh of the last one, of whatever step.
class SeriesFrames {
 public:
  virtual ~SeriesFrames() = default;

  /// Computes the frame of a step. Throws Error if the store is damaged. With `resident_only`, pages that the
  /// frame lacks are loaded in threads, and the next frame has those that have arrived by then.
  virtual isosurface::FrameFigures next(std::uint32_t step, const isosurface::FrameRequest& request) = 0;
  /// Sets which steps are expected after that of the last frame, the next one first. Threads read the pages
  /// that the frame has used for these steps too. Initially no step is expected.
  virtual void expect(std::vector<std::uint32_t> steps) = 0;
  /// Whether the pages that the last frame has used are in memory for another step too.
  [[nodiscard]] virtual bool is_ready(std::uint32_t step) = 0;
  /// The number of these pages that are in memory, for each step that has any pages there, in ascending
  /// order. Only a limited number of steps has (StepPages). It is unknown before the first call of expect().
  [[nodiscard]] virtual std::vector<LoadedStep> loaded_steps() = 0;
  /// Whether pages that the last frame lacks are on their way. Each is loaded at most once for a view: if the
  /// memory has no room for all that a view needs, some stay missing.
  [[nodiscard]] virtual bool is_paging() const = 0;
  /// Whether pages of expected steps are being loaded.
  [[nodiscard]] virtual bool is_reading_ahead() = 0;
  /// Waits until pages have arrived or none are being loaded.
  virtual void wait() = 0;
  /// Why the first page that failed cannot be loaded; empty if none failed.
  [[nodiscard]] virtual std::string paging_problem() const = 0;
  /// Calls visit(chunk) for all parts of the last frame's surface, which are in the frame of the grid.
  virtual void for_each_chunk(const std::function<void(const isosurface::SurfaceChunk&)>& visit) const = 0;
  /// An estimate of the isosurface error of the cell of the last frame's mesh that contains a place in the
  /// frame of the grid; empty if it is unknown.
  [[nodiscard]] virtual std::optional<double> error_at(const Vec3& place) = 0;
  /// The cells of the last frame's mesh in a plane, as polygons; in the frame of the grid.
  [[nodiscard]] virtual std::vector<std::vector<Vec3>> cells_in(const Plane& plane) = 0;
  /// The box from the first sample to the last, in the grid's frame.
  [[nodiscard]] virtual Box3 data_box() const = 0;

  /// Makes frames with pages that are shared with others and must outlive them. Members that read pages wait
  /// for the lock; all frames of the same pages must be used by one thread. `form` is explained at
  /// PagedFrames.
  static std::unique_ptr<SeriesFrames> open(SharedPages& pages,
                                            isosurface::SurfaceForm form = isosurface::SurfaceForm::kPoints);
};

}  // namespace adamas::timevarying
