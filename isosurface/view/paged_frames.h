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
#include "isosurface/view/chunk_maker.h"
#include "isosurface/view/frame_request.h"
#include "isosurface/view/surface_chunk.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

/// Makes the frames of a flight. The mesh of a frame is a cut of the diamonds by their classes in the view;
/// with a limit of triangles, diamonds are split in the order of SurfaceCut. So a frame does not depend on
/// those before it, but only the parts that differ from the last one are made anew: surfaces are kept as
/// chunks, one for each page.
template <class Sample>
class PagedFrames {
 public:
  static constexpr std::size_t kMemory = std::size_t{64} << 20;

  /// Makes the object. `memory`: the number of bytes that the crossed diamonds of pages which the last frame
  /// did not use may take between frames. `form`: the form of chunks; chunks that do not belong to one page
  /// always have points. `gradients`: the directions that the store keeps at this step, opened and shared by
  /// another object; null: this one opens them, if there are any. Pages and gradients must outlive this.
  explicit PagedFrames(StoredPages<OrderedWord<Sample>>& pages, std::size_t memory = kMemory,
                       SurfaceForm form = SurfaceForm::kPoints, StoredGradients* gradients = nullptr);

  /// Changes to another step of the same store for the next frame. That frame begins with the mesh of the
  /// last one; pages that are the same at both steps are not made anew. The pages must outlive this, or the
  /// frame after the next call of set_pages(); so must `gradients`, the directions at that step, which are
  /// given if they were given to the constructor.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients = nullptr);

  /// Finds the surface of a frame. A stopped frame leaves the last surface, or that of the mesh in which
  /// nothing is split if the last one has another isovalue or too many triangles; its greatest error is not
  /// known then. Throws PageLost.
  FrameFigures refine(const FrameRequest& request);

  /// Returns the chunks that the last frame has added, made anew and removed.
  [[nodiscard]] const ChunkChanges& changes() const { return changes_; }
  /// Calls visit(chunk) for all chunks of the last frame. They stay valid until they are made anew.
  template <class Visit>
  void for_each_chunk(Visit&& visit) const {
    for (const ViewedPage* const page : chunks_) visit(page->chunk->shown);
    if (separate_chunk_) visit(separate_chunk_->shown);
  }
  /// Returns a chunk of the last frame; null where there is none of this id.
  [[nodiscard]] const SurfaceChunk* chunk(std::uint64_t id);

  /// Returns the pages that the visible surface needs and the last frame lacked, since they are not in
  /// memory; the most important first. Once they are there (PageCache::put), the next frame is finer. After a
  /// stopped frame they are those of the frame before.
  [[nodiscard]] const std::vector<MissingPage>& missing_pages() const { return missing_; }
  /// Returns the pages that the last frame has used, the most important first: those that a frame of another
  /// step will need, apart from what changes.
  [[nodiscard]] std::vector<MissingPage> needed_pages();
  [[nodiscard]] StoredPages<OrderedWord<Sample>>& pages() { return diamonds_.pages(); }
  /// Returns the directions of gradients that the store keeps; null where it has none.
  [[nodiscard]] StoredGradients* gradients() { return makers_.first().normals().stored(); }

  /// Returns the isosurface error of the cell of the last frame's mesh at a place, in the frame of the grid:
  /// an estimate of the distance of its surface from that of all samples there. 0 where the contour does not
  /// cross the cell's diamond. None before the first frame, and where that cannot be read.
  [[nodiscard]] std::optional<double> error_at(const Vec3& place);
  /// Returns the sections of the last frame's cells in a plane, as polygons in the frame of the grid, clipped
  /// to the data. None before the first frame.
  [[nodiscard]] std::vector<std::vector<Vec3>> cells_in(const Plane& plane);
  /// Returns the whole surface of the last frame: clipped to the data's box, with one point for each edge.
  [[nodiscard]] Contour contour() const;
  [[nodiscard]] const ViewedDiamonds<Sample>& diamonds() const { return diamonds_; }
  /// Returns the number of bytes of the crossed diamonds of pages, without the chunks.
  [[nodiscard]] std::size_t known_bytes() const { return pages_.bytes(); }

 private:
  /// The ids of chunks that do not belong to one page: that of the mesh in which nothing is split, and that
  /// of all triangles that the border of the data cuts, which are clipped together, so that neighbours stay
  /// joined.
  static constexpr std::uint64_t kRoot = ~std::uint64_t{0}, kBorder = kRoot - 1;
  static constexpr int kLodBits = 56;  ///< other ids have the LOD above so many bits
  static std::uint64_t id_of(int lod, LatticePoint block);

  /// A chunk that does not belong to one page, and its surface.
  struct SeparateChunk {
    Contour contour;
    SurfaceChunk shown;
    std::vector<MissingNormals> missing;
  };
  using NewChunk = typename ChunkMakers<Sample>::Job;

  /// Computes the frame; throws Cancelled where it is stopped.
  FrameFigures find_frame(const FrameRequest& request, const Progress& progress);
  /// Gets the coarsest page, without which there is no surface, and disables loading of other pages where
  /// only those in memory are wanted.
  void choose_pages(bool resident_only);
  void end_frame();
  /// Returns whether pages that provisional normals lack have come since.
  [[nodiscard]] bool have_arrived(const std::vector<MissingNormals>& missing);
  void find_missing(FrameFigures& figures);
  void add_missing(const std::vector<MissingNormals>& missing);
  /// Begins another contour. If the same samples are above it, all known data stay; otherwise it begins with
  /// the mesh in which nothing is split.
  void start(double isovalue);
  void count_root();
  /// Makes the mesh in which nothing is split the present one.
  void merge_all();
  SurfaceCut cut_of(const FrameRequest& request, const Progress& progress);
  /// Finds the cells of the last frame's chunks whose triangles have changed, and counts splits and merges.
  void find_changed_cells(FrameFigures& figures);
  /// Counts the splits and merges of a page with the split diamonds `now`, and, if `of_cells` is set, notes
  /// the changed cells.
  void note_changes(ViewedPage& page, const PageMask& now, bool of_cells, FrameFigures& figures);
  void note_cell(LatticePoint p);
  std::vector<NewChunk> make_chunks(const Progress& progress);
  /// Replaces the last frame by the new one.
  void take(std::vector<NewChunk> made);
  void set_apart(std::uint64_t id, Contour contour);
  void drop_apart();
  /// Returns whether the last frame's mesh has the diamond of a point split.
  [[nodiscard]] bool is_split(LatticePoint p);
  /// Returns the surface of all triangles that the border of the data cuts.
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
  std::optional<double> isovalue_;  ///< none before the first frame
  /// Whether the last frame's surface is of another step than the next one.
  bool is_of_another_step_ = false;
  /// Whether the last frame's surface has another isovalue than the next one, between the same samples.
  bool is_of_another_isovalue_ = false;
  std::uint64_t root_triangles_ = 0;
  int last_class_ = 0;    ///< the least class of the last cut of this contour; 0 before there is one
  FrameFigures figures_;  ///< figures of the last frame that was not stopped
  std::uint64_t revision_ = 0;
  std::vector<ViewedPage*> chunks_;  ///< the pages that have a chunk, from the coarsest LOD on, in z-order
  std::optional<SeparateChunk> separate_chunk_;
  std::vector<MissingPage> missing_;
  std::vector<std::pair<std::uint64_t, bool>> touched_;
  ChunkChanges changes_;
};

}  // namespace adamas::isosurface
