#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adamas/meshes.h"
#include "isosurface/storage/store_file.h"
#include "timevarying/series_frames.h"
#include "viewer/contents/document.h"
#include "viewer/contents/drawn_mesh.h"
#include "viewer/contents/frame_budget.h"
#include "viewer/contents/open_store.h"

namespace adamas::viewer {

/// The input of the computation: everything on which the surfaces of a store depend.
struct WantedSurfaces {
  isosurface::Viewpoint viewpoint;  ///< the viewpoint in the frame of the grid
  std::vector<double> isovalues;    ///< in units of samples, not of values
  std::uint32_t step = 0;
  double pixels = 1;
  std::uint64_t max_triangles = 0;
  double seconds = 0;  ///< the time for a frame; 0 for no limit
  std::shared_ptr<const isosurface::DepthPyramid> depths;
  /// Origin and normal of the plane, in space, in which the cells of the first surface's mesh are wanted.
  std::optional<std::array<Vec3, 2>> cells_in;

  bool operator==(const WantedSurfaces&) const = default;
};

/// The surfaces that were found.
struct FoundSurfaces {
  WantedSurfaces wanted;
  std::uint64_t roughness = 1;                    ///< the factor by which they are still coarser than wanted
  std::vector<std::vector<SharedMesh>> surfaces;  ///< the chunks of each isovalue's surface
  std::vector<double> isovalues;                  ///< the isovalue of each surface
  std::uint32_t step = 0;  ///< the step of the surfaces: an earlier one if the wanted one cannot be read
  SharedMesh cell_edges;   ///< the edges of cells in the plane; null if none are wanted
  UpdateReport report;
  PageReads counts;
};

/// A place in space at a step, on one of the surfaces that were found last or on none of them.
struct SurfacePlace {
  std::size_t surface = 0;
  Vec3 place;
  std::uint32_t step = 0;

  bool operator==(const SurfacePlace&) const = default;
};

/// Computes the surfaces that were wanted last in a thread. If it does not wait for pages, surfaces are
/// coarser at first, and are computed again as pages arrive, until nothing is missing.
class SurfaceWorker {
 public:
  /// `colours`: the store whose values colour surfaces, or null. The stores must outlive this object.
  SurfaceWorker(OpenStore& store, OpenStore* colours, const DocumentOptions& options);
  SurfaceWorker(const SurfaceWorker&) = delete;
  SurfaceWorker& operator=(const SurfaceWorker&) = delete;
  ~SurfaceWorker();

  /// Requests surfaces, and replaces those that were requested before.
  void want(const WantedSurfaces& wanted);
  /// The surfaces that were found last, for whichever request; null before the first ones.
  [[nodiscard]] std::shared_ptr<const FoundSurfaces> found() const;
  /// Whether the surfaces that were requested last are found and complete.
  [[nodiscard]] bool is_current() const;
  /// Sets which steps are likely to be wanted next, the next one first, so that their pages are read in
  /// advance.
  void expect(const std::vector<std::uint32_t>& steps);
  [[nodiscard]] StepsAhead steps_ahead() const;
  /// Waits until these surfaces are found, or there is a problem. If surfaces do not wait for pages, some
  /// pages may be missing.
  void wait_for(const WantedSurfaces& wanted);
  /// The value of the samples at a place, and the isosurface error of the mesh's cell there, an estimate in
  /// units of length. It never waits: if they are unknown, the reading is pending, and they are found between
  /// two surfaces.
  Reading reading_at(const SurfacePlace& place);

 private:
  /// The frames of an isovalue, and the meshes made from their chunks, by the ids of the chunks.
  struct Surface {
    struct Drawn {
      std::uint64_t revision = 0;
      SharedMesh mesh;
    };
    std::unique_ptr<timevarying::SeriesFrames> frames;
    std::unordered_map<std::uint64_t, Drawn> drawn;
  };

  void run();
  /// Waits for other surfaces to be wanted, for a question about a place, or for pages. Returns false at the
  /// end.
  bool wait_for_work(const std::optional<WantedSurfaces>& done);
  /// Finds the values at the place in question.
  void answer(const SurfacePlace& place);
  /// Whether other isovalues are wanted now than those that are being computed.
  [[nodiscard]] bool is_overtaken(const WantedSurfaces& wanted) const;
  /// Computes a frame. Returns false if it was stopped, since something else is wanted or its time is over.
  bool update(const WantedSurfaces& wanted, std::uint64_t roughness);
  /// Computes the n-th surface of a frame. Returns false if it was stopped.
  bool add_surface(FoundSurfaces& found, std::size_t n, std::uint64_t roughness);
  /// Lets the pages of the last surfaces be read for the expected steps too. Returns what is in memory.
  StepsAhead look_ahead();
  [[nodiscard]] StepsAhead looked_ahead();
  /// Changes the step of the store that colours surfaces; meshes are then made again.
  void set_step_of_colours(std::uint32_t step);
  [[nodiscard]] bool is_paging() const;
  [[nodiscard]] std::string paging_problem() const;
  /// The meshes of a surface; only those of changed chunks are made again.
  std::vector<SharedMesh> drawn_chunks(Surface& surface);
  /// The edges in which the plane cuts the cells of the first surface's mesh.
  [[nodiscard]] SharedMesh cell_edges(const Plane& plane);
  [[nodiscard]] SharedMesh drawn_chunk(const isosurface::SurfaceChunk& chunk) const;

  static constexpr std::uint64_t kRough = 8;

  OpenStore& store_;
  OpenStore* colours_;  ///< null if no store colours surfaces
  bool waits_for_pages_;
  std::vector<Surface> surfaces_;  ///< used only by the thread
  std::uint32_t step_of_colours_;
  isosurface::SurfaceForm form_;
  std::vector<std::uint32_t> expecting_;  ///< the steps that frames read ahead; used only by the thread
  FrameBudget budget_;
  std::chrono::steady_clock::time_point frame_end_;  ///< the time at which the frame is stopped
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ended_ = false, has_arrived_ = false;
  std::optional<WantedSurfaces> wanted_;
  std::vector<std::uint32_t> expected_;
  StepsAhead ahead_;
  std::shared_ptr<const FoundSurfaces> found_;
  std::optional<SurfacePlace> asked_;  ///< a place in question that is not answered yet
  std::optional<std::pair<SurfacePlace, Reading>> answered_;
  std::thread thread_;
};

/// A chunk that has ends of edges, for the renderer.
SharedMesh drawn_ends(const isosurface::SurfaceChunk& chunk);
/// A surface for the renderer, with its values on both sides.
SharedMesh drawn_mesh(const TriangleSurface& surface);

}  // namespace adamas::viewer
