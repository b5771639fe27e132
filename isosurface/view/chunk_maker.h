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

/// What chunks are made from; all of it must outlive who makes them.
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

  /// `free`: chunks that are not needed any more, whose memory the next ones will have. `gradients`: those
  /// that the store keeps, of another maker of the same diamonds; null: this one opens them, if there are
  /// any. All of these must outlive this.
  ChunkMaker(const ChunkSource<Sample>& source, SharedPool<PageChunk>& free,
             StoredGradients* gradients = nullptr);

  /// The chunk of a page of which something is split. `before`: the page's chunk until now, or null. Of its
  /// cells only some are made anew, `cells` as bits, and the points that it has are taken over. Throws
  /// PageLost.
  std::unique_ptr<PageChunk> make(int lod, LatticePoint block, const PageChunk* before, std::uint64_t cells);
  /// The n-th point on an edge of a part of a chunk.
  [[nodiscard]] EdgePoint edge_point(const PageChunk& chunk, const PageChunk::Part& part,
                                     std::size_t n) const;
  [[nodiscard]] Vec3 position(const EdgePoint& point) const {
    return point_between(diamonds_.domain().position(point.first), diamonds_.domain().position(point.second),
                         point.parameter);
  }
  PointNormals<Sample>& normals() { return normals_; }

 private:
  static constexpr std::uint16_t kNone = 0xffff;
  /// A point of a page, counted from its first one, in the lattice.
  [[nodiscard]] LatticePoint in_lattice(const PageChunk& chunk, LatticePoint q) const {
    return diamonds_.lattice_step(chunk.lod) * (PageGrid::kSide * chunk.block + q);
  }
  std::unique_ptr<PageChunk> empty_chunk(int lod, LatticePoint block);
  void add_cells(const PageChunk* before, std::uint64_t cells, PageChunk& chunk);
  void add_cell(unsigned cell, PageChunk& chunk);
  /// Finds the edges of a part, and calls triangle(n, numbers) for its triangles by
  /// the numbers of these. The first cells, of which the part before has the same triangles, are passed over.
  /// Returns the number of the first edge of the others; numbers_of_old_ has, from that on, the number that
  /// each edge has in the part before, or kNone.
  template <class AddTriangle>
  std::size_t number(const PageChunk::Part* before, unsigned first_cell, PageChunk::Part& part,
                     AddTriangle&& triangle);
  [[nodiscard]] double parameter(EdgePlace place) const;
  /// Sets what is shown; the cells before the first are as they were.
  void show(const PageChunk* before, unsigned first_cell, PageChunk& chunk);
  /// Sets the points on edges from a number on, in the form that is wanted.
  void show_points(const PageChunk* before, std::size_t same, PageChunk& chunk);
  void show_ends(const PageChunk* before, std::size_t same, PageChunk& chunk);
  /// What show() sets of one kind: those that were there before are taken over, others made by make(n).
  template <class Value, class Make>
  void take_over(const std::vector<Value>* before, std::size_t same, std::vector<Value>& values, Make&& make);

  ChunkSource<Sample> source_;
  StoredDiamonds<Sample>& diamonds_;
  const SurfaceRequest& surface_;
  PageMesh<Sample> mesh_;
  PointNormals<Sample> normals_;
  SharedPool<PageChunk>& free_;
  /// Of the points on edges, by place: in the chunk and in the one before it; kNone where there is none.
  struct Numbers {
    std::uint16_t now = kNone, before = kNone;
  };
  std::vector<Numbers> numbers_;
  std::vector<std::uint16_t> numbers_of_old_;
};

extern template class ChunkMaker<std::uint8_t>;
extern template class ChunkMaker<std::uint16_t>;
extern template class ChunkMaker<std::int16_t>;
extern template class ChunkMaker<float>;

/// Makes chunks of many pages by several threads. What a chunk is made of is in memory mostly, and does not
/// change meanwhile: threads load nothing, and chunks for which pages are to be loaded are made one after
/// another.
template <class Sample>
class ChunkMakers {
 public:
  explicit ChunkMakers(const ChunkSource<Sample>& source);

  /// A chunk that is to be made of a page.
  struct Job {
    ViewedPage* page;
    const PageChunk* before;  ///< of which some cells stay; null: all are made
    std::unique_ptr<PageChunk> chunk = nullptr;
  };
  /// Makes all chunks. Throws PageLost, and Cancelled where `progress` says so, which is asked for each
  /// chunk.
  void make(std::span<Job> jobs, const Progress& progress);
  /// Takes a chunk that is not needed any more, whose memory another one will have.
  void recycle(std::unique_ptr<PageChunk> chunk) { free_.give(std::move(chunk)); }
  /// Goes over to the pages of another step of the same store.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages);
  /// One for what is made outside of chunks.
  [[nodiscard]] ChunkMaker<Sample>& first() { return first_; }
  [[nodiscard]] const ChunkMaker<Sample>& first() const { return first_; }

 private:
  /// Makes some chunks of which the pages are in memory; leaves out those that need others.
  void make_in_memory(std::span<Job> jobs);

  ChunkSource<Sample> source_;
  static constexpr std::size_t kMostFree = 1024;
  SharedPool<PageChunk> free_{kMostFree};
  ChunkMaker<Sample> first_;
  SharedPool<ChunkMaker<Sample>> others_;  ///< for threads
};

extern template class ChunkMakers<std::uint8_t>;
extern template class ChunkMakers<std::uint16_t>;
extern template class ChunkMakers<std::int16_t>;
extern template class ChunkMakers<float>;

}  // namespace adamas::isosurface
