#include "isosurface/view/chunk_makers.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"

namespace adamas::isosurface {

template <class Sample>
ChunkMakers<Sample>::ChunkMakers(const ChunkSource<Sample>& source, StoredGradients* gradients)
    : source_(source), first_(source_, free_, gradients) {}

template <class Sample>
void ChunkMakers<Sample>::set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients) {
  first_.normals().set_pages(pages, gradients);
  others_.for_each([&](ChunkMaker<Sample>& maker) { maker.normals().set_pages(pages, gradients); });
}

template <class Sample>
void ChunkMakers<Sample>::make(std::span<Job> jobs, const Progress& progress) {
  // The pages of a batch are in memory together, where there is room.
  constexpr std::size_t kBatch = 256, kLeast = 8;
  for (; !jobs.empty(); jobs = jobs.subspan(std::min(kBatch, jobs.size()))) {
    const std::span<Job> batch = jobs.first(std::min(kBatch, jobs.size()));
    if (thread_limit() > 1 && batch.size() >= kLeast) make_in_memory(batch);
    for (Job& job : batch) {
      progress.check();
      if (job.chunk == nullptr)
        job.chunk = first_.make(job.page->lod, job.page->block, job.before, job.page->changed);
    }
  }
}

template <class Sample>
void ChunkMakers<Sample>::make_in_memory(std::span<Job> jobs) {
  StoredPages<OrderedWord<Sample>>& pages = source_.diamonds.pages();
  const bool loads = pages.loads();
  for (const Job& job : jobs) {
    if (loads && job.page->lod <= pages.grid().top()) pages.samples({job.page->lod, job.page->block});
  }
  StoredGradients* const gradients = first_.normals().stored();
  const auto set_loading = [&](bool is_to_load) {
    pages.set_loading(is_to_load);
    if (gradients != nullptr) gradients->set_loading(is_to_load);
  };
  set_loading(false);
  constexpr std::size_t kGrain = 4;
  parallel_chunks(jobs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<ChunkMaker<Sample>> maker = others_.take();
    if (maker == nullptr) maker = std::make_unique<ChunkMaker<Sample>>(source_, free_, gradients);
    for (Job& job : jobs.subspan(begin, end - begin)) {
      try {
        job.chunk = maker->make(job.page->lod, job.page->block, job.before, job.page->changed);
      } catch (const PageLost&) {
        continue;
      }
      if (loads && !job.chunk->missing.empty()) recycle(std::move(job.chunk));
    }
    others_.give(std::move(maker));
  });
  set_loading(loads);
}

template class ChunkMakers<std::uint8_t>;
template class ChunkMakers<std::uint16_t>;
template class ChunkMakers<std::int16_t>;
template class ChunkMakers<float>;

}  // namespace adamas::isosurface
