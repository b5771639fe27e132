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
#include "viewer/document/document.h"
#include "viewer/document/drawn_mesh.h"
#include "viewer/document/frame_budget.h"
#include "viewer/document/open_store.h"

namespace adamas::viewer {

/// What the surfaces of a store depend on.
struct WantedSurfaces {
  isosurface::Viewpoint viewpoint;  ///< in the frame of the grid
  std::vector<double> isovalues;    ///< of samples
  std::uint32_t step = 0;
  double pixels = 1;
  std::uint64_t max_triangles = 0;
  double seconds = 0;  ///< for a frame; 0: any
  std::shared_ptr<const isosurface::DepthPyramid> depths;
  /// The plane, in space, in which the cells of the first surface's mesh are wanted: origin and normal.
  std::optional<std::array<Vec3, 2>> cells_in;

  bool operator==(const WantedSurfaces&) const = default;
};

/// What was found for that.
struct FoundSurfaces {
  WantedSurfaces wanted;
  std::uint64_t roughness = 1;                    ///< by how much it is coarser than that on purpose
  std::vector<std::vector<SharedMesh>> surfaces;  ///< of each isovalue: the chunks
  std::vector<double> isovalues;                  ///< of these
  std::uint32_t step = 0;                         ///< of these: an earlier one where that cannot be had
  SharedMesh cell_edges;                          ///< in the plane; null where none are wanted
  UpdateReport report;
  isosurface::PageCounts counts;
};

/// A place in space at a step, on one of the surfaces that were found last or on none of them.
struct SurfacePlace {
  std::size_t surface = 0;
  Vec3 place;
  std::uint32_t step = 0;

  bool operator==(const SurfacePlace&) const = default;
};

/// Works out surfaces in a thread of its own, those that were wanted last. Where it does not wait for pages
/// surfaces are coarser at first, and go on to be worked out as pages come, until nothing is missing.
class SurfaceWorker {
 public:
  /// `colours`: the store whose values colour surfaces, or null. The stores must outlive this.
  SurfaceWorker(OpenStore& store, OpenStore* colours, const DocumentOptions& options);
  SurfaceWorker(const SurfaceWorker&) = delete;
  SurfaceWorker& operator=(const SurfaceWorker&) = delete;
  ~SurfaceWorker();

  void want(const WantedSurfaces& wanted);
  /// What was found last, for whatever was wanted then; null before that.
  [[nodiscard]] std::shared_ptr<const FoundSurfaces> found() const;
  /// Whether that is what was wanted last.
  [[nodiscard]] bool is_current() const;
  /// Which steps are expected to be wanted next, the next one first: their pages are read meanwhile.
  void expect(const std::vector<std::uint32_t>& steps);
  [[nodiscard]] StepsAhead steps_ahead() const;
  /// Waits until that is what was found, or there is a problem. Where surfaces do not wait for pages, some
  /// may be missing.
  void wait_for(const WantedSurfaces& wanted);
  /// The value of the samples at a place, and the isosurface error of the mesh's cell there, an estimate in
  /// units of length. Never waits: where they are not known, the reading is pending, and they are found
  /// between two surfaces.
  Reading reading_at(const SurfacePlace& place);

 private:
  /// The frames of an isovalue, and what is drawn of them: by the ids of chunks, as of a revision.
  struct Surface {
    struct Drawn {
      std::uint64_t revision = 0;
      SharedMesh mesh;
    };
    std::unique_ptr<timevarying::SeriesFrames> frames;
    std::unordered_map<std::uint64_t, Drawn> drawn;
  };

  void run();
  /// Waits for another wish, for a place that is asked about, or for pages. Returns false at the end.
  bool wait_for_work(const std::optional<WantedSurfaces>& done);
  void answer(const SurfacePlace& place);
  /// Whether the surfaces that are worked out are not those that are wanted by now.
  [[nodiscard]] bool is_overtaken(const WantedSurfaces& wanted) const;
  /// Works out a frame. Returns false where it was stopped: something else is wanted, or its time is over.
  bool update(const WantedSurfaces& wanted, std::uint64_t roughness);
  /// The same.
  bool add_surface(FoundSurfaces& found, std::size_t n, std::uint64_t roughness);
  /// Reads ahead what the last surfaces are made of.
  StepsAhead look_ahead();
  [[nodiscard]] StepsAhead looked_ahead();
  /// Colours follow the step, too.
  void set_step_of_colours(std::uint32_t step);
  [[nodiscard]] bool is_paging() const;
  [[nodiscard]] std::string paging_problem() const;
  /// Only chunks that are not as they were are made anew.
  std::vector<SharedMesh> drawn_chunks(Surface& surface);
  /// Of the first surface's mesh.
  [[nodiscard]] SharedMesh cell_edges(const Plane& plane);
  [[nodiscard]] SharedMesh drawn_chunk(const isosurface::SurfaceChunk& chunk) const;

  static constexpr std::uint64_t kRough = 8;

  OpenStore& store_;
  OpenStore* colours_;  ///< null where there are none
  bool waits_for_pages_;
  std::vector<Surface> surfaces_;  ///< of the thread
  std::uint32_t step_of_colours_;
  isosurface::SurfaceForm form_;
  std::vector<std::uint32_t> expecting_;  ///< of the thread: what frames read ahead
  FrameBudget budget_;
  std::chrono::steady_clock::time_point frame_end_;  ///< when the frame's time is over
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ended_ = false, has_arrived_ = false;
  std::optional<WantedSurfaces> wanted_;
  std::vector<std::uint32_t> expected_;
  StepsAhead ahead_;
  std::shared_ptr<const FoundSurfaces> found_;
  std::optional<SurfacePlace> asked_;  ///< not answered yet
  std::optional<std::pair<SurfacePlace, Reading>> answered_;
  std::thread thread_;
};

/// The same of chunks of the ends of edges.
SharedMesh drawn_ends(const isosurface::SurfaceChunk& chunk);
/// A surface as a renderer takes it; its values on both sides.
SharedMesh drawn_mesh(const TriangleSurface& surface);

}  // namespace adamas::viewer
