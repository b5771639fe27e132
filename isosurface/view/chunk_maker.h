#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "core/base/shared_pool.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_mesh.h"
#include "isosurface/extraction/surface_normals.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/view/page_chunk.h"
#include "isosurface/view/surface_chunk.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

/// The data that chunks are made from. All of them must outlive the makers.
template <class Sample>
struct ChunkSource {
  StoredDiamonds<Sample>& diamonds;
  const SurfaceRequest& surface;
  typename PageMesh<Sample>::SplitOf split_of;
  SurfaceForm form = SurfaceForm::kPoints;
};

/// Makes the chunks of pages, cell by cell.
template <class Sample>
class ChunkMaker {
 public:
  using EdgePlace = PageChunk::EdgePlace;

  /// Makes a maker. `free`: chunks that are not needed any more, whose memory new chunks reuse. `gradients`:
  /// the stored directions, opened by another maker of the same diamonds; null: this one opens them, if there
  /// are any. All arguments must outlive this.
  ChunkMaker(const ChunkSource<Sample>& source, SharedPool<PageChunk>& free,
             StoredGradients* gradients = nullptr);

  /// Makes the chunk of a page on which something is split. `before`: the page's chunk until now, or null.
  /// Only the cells of `cells`, as bits, are made anew; the others, and known points, are copied from
  /// `before`. Throws PageLost.
  std::unique_ptr<PageChunk> make(int lod, LatticePoint block, const PageChunk* before, std::uint64_t cells);
  /// Returns the n-th point on an edge of a part of a chunk.
  [[nodiscard]] EdgePoint edge_point(const PageChunk& chunk, const PageChunk::Part& part,
                                     std::size_t n) const;
  [[nodiscard]] Vec3 position(const EdgePoint& point) const {
    return point_between(diamonds_.domain().position(point.first), diamonds_.domain().position(point.second),
                         point.parameter);
  }
  PointNormals<Sample>& normals() { return normals_; }

 private:
  static constexpr std::uint16_t kNone = 0xffff;
  /// Returns a point of a page, counted from its first one, as a lattice point.
  [[nodiscard]] LatticePoint in_lattice(const PageChunk& chunk, LatticePoint q) const {
    return diamonds_.lattice_step(chunk.lod) * (PageGrid::kSide * chunk.block + q);
  }
  std::unique_ptr<PageChunk> empty_chunk(int lod, LatticePoint block);
  void add_cells(const PageChunk* before, std::uint64_t cells, PageChunk& chunk);
  void add_cell(unsigned cell, PageChunk& chunk);
  /// Finds the edges of a part, and calls triangle(n, numbers) for its triangles with the numbers of their
  /// edges. The cells before `first_cell` have the same triangles as in the part before, and are skipped.
  /// Returns the number of the first edge of the other cells; from that on, numbers_of_old_ has the number of
  /// each edge in the part before, or kNone.
  template <class AddTriangle>
  std::size_t number(const PageChunk::Part* before, unsigned first_cell, PageChunk::Part& part,
                     AddTriangle&& triangle);
  [[nodiscard]] double parameter(EdgePlace place) const;
  /// Sets the shown part of a chunk; the cells before `first_cell` are unchanged.
  void show(const PageChunk* before, unsigned first_cell, PageChunk& chunk);
  /// Sets the points on edges from a number on, in the wanted form.
  void show_points(const PageChunk* before, std::size_t same, PageChunk& chunk);
  void show_ends(const PageChunk* before, std::size_t same, PageChunk& chunk);
  /// Sets the values of one kind for show(): known ones are copied from `before`, others are made by make(n).
  template <class Value, class Make>
  void take_over(const std::vector<Value>* before, std::size_t same, std::vector<Value>& values, Make&& make);

  ChunkSource<Sample> source_;
  StoredDiamonds<Sample>& diamonds_;
  const SurfaceRequest& surface_;
  PageMesh<Sample> mesh_;
  PointNormals<Sample> normals_;
  SharedPool<PageChunk>& free_;
  /// The numbers of the point on an edge, in the chunk and in the one before it; kNone where there is none.
  struct Numbers {
    std::uint16_t now = kNone, before = kNone;
  };
  std::vector<Numbers> numbers_;  ///< indexed by the place of the edge
  std::vector<std::uint16_t> numbers_of_old_;
};

/// Makes the chunks of many pages by several threads. Most of the pages they need are in memory, and stay
/// there meanwhile: threads load nothing, and chunks for which pages must be loaded are made one after
/// another.
template <class Sample>
class ChunkMakers {
 public:
  /// Makes the makers. `gradients`: the stored directions, opened by another object; null: the makers open
  /// them, if there are any.
  explicit ChunkMakers(const ChunkSource<Sample>& source, StoredGradients* gradients = nullptr);

  /// A chunk to be made for a page.
  struct Job {
    ViewedPage* page;
    const PageChunk* before;  ///< the chunk of which some cells are kept; null: all cells are made
    std::unique_ptr<PageChunk> chunk = nullptr;
  };
  /// Makes all chunks. Throws PageLost, and Cancelled where `progress` says so, which is checked before each
  /// chunk.
  void make(std::span<Job> jobs, const Progress& progress);
  /// Takes a chunk that is not needed any more, so that its memory is reused.
  void recycle(std::unique_ptr<PageChunk> chunk) { free_.give(std::move(chunk)); }
  /// Changes to the pages of another step of the same store, and to its gradients, which are given if they
  /// were given to the constructor.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients = nullptr);
  /// Returns the maker of this thread, also for points outside of chunks.
  [[nodiscard]] ChunkMaker<Sample>& first() { return first_; }
  [[nodiscard]] const ChunkMaker<Sample>& first() const { return first_; }

 private:
  /// Makes those chunks whose pages are in memory, and leaves the others out.
  void make_in_memory(std::span<Job> jobs);

  ChunkSource<Sample> source_;
  static constexpr std::size_t kMostFree = 1024;
  SharedPool<PageChunk> free_{kMostFree};
  ChunkMaker<Sample> first_;
  SharedPool<ChunkMaker<Sample>> others_;  ///< makers for other threads
};

}  // namespace adamas::isosurface
