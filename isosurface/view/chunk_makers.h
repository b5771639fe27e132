#pragma once

#include <memory>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/view/page_chunk.h"
#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

/// Makes chunks of many pages by several threads. What a chunk is made of is in memory mostly, and does not
/// change meanwhile: threads load nothing, and chunks for which pages are to be loaded are made one after
/// another.
template <class Sample>
class ChunkMakers {
 public:
  /// `gradients`: those that the store keeps, of others; null: this opens them, if there are any.
  explicit ChunkMakers(const ChunkSource<Sample>& source, StoredGradients* gradients = nullptr);

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
  /// Goes over to the pages of another step of the same store, and to gradients as the constructor had them.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients = nullptr);
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
