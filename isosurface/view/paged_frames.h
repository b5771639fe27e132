#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/view/chunk_makers.h"
#include "isosurface/view/frame_refinement.h"
#include "isosurface/view/page_chunk.h"
#include "isosurface/view/surface_chunk.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

/// Frames by masks of pages: each frame is the cut of the diamonds by their classes in the view, and a limit
/// of triangles splits them in the order of SurfaceCut. So a frame does not depend on those before it, but
/// only what is not as in the last one is made anew: surfaces are kept as chunks, one for each page. The mesh
/// is that of QueuedFrames, where the error wanted is the least of a class and there is room.
template <class Sample>
class PagedFrames {
 public:
  static constexpr std::size_t kMemory = std::size_t{64} << 20;

  /// `memory`: bytes that may be taken between frames by what is known of pages that the last one did not
  /// look at. `form`: of chunks, but for those that are not of one page, which have points. `gradients`: the
  /// directions that the store keeps at this step, for others to share; null: this opens them, if there are
  /// any. Pages and gradients must outlive this.
  explicit PagedFrames(StoredPages<OrderedWord<Sample>>& pages, std::size_t memory = kMemory,
                       SurfaceForm form = SurfaceForm::kPoints, StoredGradients* gradients = nullptr);

  /// Goes over to another step of the same store, of which the next frame is to be. The mesh of the last
  /// frame is what that begins with; values of the step are looked at where the walk through the mesh meets
  /// with them, and where these are the same nothing is made anew. The pages must outlive this, or the
  /// frame after the next call; so must `gradients`, which are given where the constructor was given some.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients = nullptr);

  /// Finds the surface of a frame. A stopped one leaves what there was, or the mesh in which nothing is split
  /// where that is of another contour or has too many triangles; its greatest error is not known then. Throws
  /// PageLost.
  FrameFigures refine(const FrameRequest& request);

  /// Which chunks the last frame has added, made anew and removed.
  [[nodiscard]] const ChunkChanges& changes() const { return changes_; }
  /// Calls visit(chunk) for all chunks of the last frame. They stay where they are until they are made anew.
  template <class Visit>
  void for_each_chunk(Visit&& visit) const {
    for (const ViewedPage* const page : chunks_) visit(page->chunk->shown);
    if (apart_) visit(apart_->shown);
  }
  /// A chunk of the last frame; null where there is none of this id.
  [[nodiscard]] const SurfaceChunk* chunk(std::uint64_t id);

  /// The pages that the last frame did without, since they are not in memory, and that a surface in sight
  /// needs: what is worth most first. Once they are there (PageCache::put), the next frame sharpens. Those of
  /// a frame that was stopped are of the frame before.
  [[nodiscard]] const std::vector<MissingPage>& missing_pages() const { return missing_; }
  /// The pages that the last frame has used, in that order: what a frame of another step will need, but for
  /// what changes meanwhile.
  [[nodiscard]] std::vector<MissingPage> needed_pages();
  [[nodiscard]] StoredPages<OrderedWord<Sample>>& pages() { return diamonds_.pages(); }
  /// The directions of gradients that the store keeps; null where it has none.
  [[nodiscard]] StoredGradients* gradients() { return makers_.first().normals().stored(); }

  /// The isosurface error of the cell of the last frame's mesh at a place, in the frame of the grid: an
  /// estimate of how far its surface is from that of all samples there. 0 where the contour does not cross
  /// the cell's diamond. None before the first frame, and where that cannot be read.
  [[nodiscard]] std::optional<double> error_at(const Vec3& place);
  /// What the cells of the last frame's mesh are in a plane, in the frame of the grid: polygons, within the
  /// data. None before the first frame.
  [[nodiscard]] std::vector<std::vector<Vec3>> cells_in(const Plane& plane);
  /// The surface of the last frame as one: clipped to the data's box, with one point for each edge.
  [[nodiscard]] Contour contour() const;
  [[nodiscard]] const ViewedDiamonds<Sample>& diamonds() const { return diamonds_; }
  /// Bytes that what is known of pages takes, beside the chunks.
  [[nodiscard]] std::size_t known_bytes() const { return pages_.bytes(); }

 private:
  /// Ids of the chunks that are not of one page: of the mesh in which nothing is split, and of all triangles
  /// that the border of the data cuts, which are cut together, so that neighbours stay joined.
  static constexpr std::uint64_t kRoot = ~std::uint64_t{0}, kBorder = kRoot - 1;
  static constexpr int kLodBits = 56;  ///< of other ids: the LOD stands above so many bits
  static std::uint64_t id_of(int lod, LatticePoint block);

  /// A chunk that is not of one page, and its surface.
  struct Apart {
    Contour contour;
    SurfaceChunk shown;
    std::vector<MissingNormals> missing;
  };
  using NewChunk = typename ChunkMakers<Sample>::Job;

  /// The frame itself; throws Cancelled where it is stopped.
  FrameFigures find_frame(const FrameRequest& request, const Progress& progress);
  /// Gets the coarsest page, without which there is no surface, and lets no other page be loaded where only
  /// those in memory are wanted.
  void choose_pages(bool resident_only);
  void end_frame();
  /// Whether something has come since that provisional normals lack.
  [[nodiscard]] bool has_come(const std::vector<MissingNormals>& missing);
  void find_missing(FrameFigures& figures);
  void add_missing(const std::vector<MissingNormals>& missing);
  /// Begins another contour: with the mesh in which nothing is split, and nothing known of pages; or with all
  /// that there is, where the same samples are above it.
  void start(double isovalue);
  void count_root();
  /// Leaves the surface of the mesh in which nothing is split.
  void merge_all();
  SurfaceCut cut_of(const FrameRequest& request, const Progress& progress);
  /// Finds in which cells of the last frame's chunks triangles are not as they were, and counts splits and
  /// merges.
  void find_changed_cells(FrameFigures& figures);
  /// The same of a page, where `now` is split; `of_cells`: the cells too.
  void note_changes(ViewedPage& page, const PageMask& now, bool of_cells, FrameFigures& figures);
  void note_cell(LatticePoint p);
  std::vector<NewChunk> make_chunks(const Progress& progress);
  /// Puts what was found in the place of the last frame.
  void take(std::vector<NewChunk> made);
  void set_apart(std::uint64_t id, Contour contour);
  void drop_apart();
  /// Whether the last frame's mesh has the diamond of a point split.
  [[nodiscard]] bool is_split(LatticePoint p);
  /// All triangles that the border cuts.
  [[nodiscard]] Contour border() const;
  /// Notes that a chunk is changed, and whether it was there before.
  void touch(std::uint64_t id, bool was_there) { touched_.emplace_back(id, was_there); }
  void find_changes();
  [[nodiscard]] ContourOptions contour_options() const {
    return surface_.contour_options(diamonds_.last_sample(), diamonds_.spacing());
  }

  SurfaceForm form_;
  ViewedDiamonds<Sample> diamonds_;
  SurfaceRequest surface_;
  ViewedPages<Sample> pages_;
  ChunkMakers<Sample> makers_;
  std::optional<double> isovalue_;   ///< none before the first frame
  bool is_of_another_step_ = false;  ///< the last frame's surface is of another step than the next one
  /// The same with an isovalue between the same samples.
  bool is_of_another_isovalue_ = false;
  std::uint64_t root_triangles_ = 0;
  int last_class_ = 0;    ///< the least class of the last cut of this contour; 0 before there is one
  FrameFigures figures_;  ///< of the last frame that was not stopped
  std::uint64_t revision_ = 0;
  std::vector<ViewedPage*> chunks_;  ///< the pages that have one, from the coarsest LOD on, in z-order
  std::optional<Apart> apart_;
  std::vector<MissingPage> missing_;
  std::vector<std::pair<std::uint64_t, bool>> touched_;
  ChunkChanges changes_;
};

extern template class PagedFrames<std::uint8_t>;
extern template class PagedFrames<std::uint16_t>;
extern template class PagedFrames<std::int16_t>;
extern template class PagedFrames<float>;

}  // namespace adamas::isosurface
