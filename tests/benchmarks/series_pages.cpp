// What zstd -19 makes of the samples of a series, page by page as a store has them: each step of a page by
// itself; the steps of a block one after another, as in the file; and these sample by sample, as the
// dissertation (D 5.5) interleaves them. Of each page of a block the least counts. Of a long series only some
// pages are looked at. Prints a line of JSON.

#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/storage/step_pages.h"

namespace adamas::bench {
namespace {

constexpr std::size_t kMemory = std::size_t{512} << 20;
constexpr int kLevel = 19;

using Bytes = std::vector<std::byte>;

std::size_t compressed(const Bytes& bytes) {
  Bytes out(ZSTD_compressBound(bytes.size()));
  return ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
}

struct PageBytes {
  std::size_t input = 0, alone = 0, in_turn = 0, interleaved = 0;

  [[nodiscard]] std::size_t least() const { return std::min({alone, in_turn, interleaved}); }
};

/// `steps`: the samples of a page, step by step.
PageBytes compress(const std::vector<Bytes>& steps, std::size_t sample_bytes) {
  PageBytes found;
  Bytes in_turn;
  for (const Bytes& step : steps) {
    found.alone += compressed(step);
    in_turn.insert(in_turn.end(), step.begin(), step.end());
  }
  Bytes interleaved;
  for (std::size_t n = 0; n < steps[0].size(); n += sample_bytes)
    for (const Bytes& step : steps)
      interleaved.insert(interleaved.end(), step.begin() + static_cast<std::ptrdiff_t>(n),
                         step.begin() + static_cast<std::ptrdiff_t>(n + sample_bytes));
  found.input = in_turn.size();
  found.in_turn = compressed(in_turn);
  found.interleaved = compressed(interleaved);
  return found;
}

/// The samples that a page adds to coarser ones, in z-order, without those beyond the data.
template <class Sample>
Bytes samples_of(const PageGrid& grid, const PageId& id, const PagePoints<OrderedWord<Sample>>& words) {
  Bytes bytes;
  for_each_own_point(page_shape(grid, id), [&](LatticePoint q, std::uint64_t) {
    const LatticePoint p = (1 << id.lod) * (PageGrid::kSide * id.block + q);
    if (p.i > grid.last().i || p.j > grid.last().j || p.k > grid.last().k) return;
    const Sample sample = from_ordered<Sample>(words[PageGrid::place(q, 0)]);
    const std::size_t size = bytes.size();
    bytes.resize(size + sizeof(Sample));
    std::memcpy(bytes.data() + size, &sample, sizeof(Sample));
  });
  return bytes;
}

/// How many pages are looked at of all steps, as far as these divide into so few.
constexpr std::uint64_t kPages = 70'000;

/// Every so many-th page, of all levels in turn.
std::vector<PageId> pages_of(const StoreFile& file) {
  const PageGrid& grid = file.grid();
  const std::uint64_t every = 1 + grid.page_count() * file.steps() / kPages;
  std::vector<PageId> pages;
  std::uint64_t count = 0;
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number)
    if (grid.contains(grid.page(number)) && count++ % every == 0) pages.push_back(grid.page(number));
  return pages;
}

/// Of the block that begins with a step.
template <class Sample>
void add_block(StoreFile& file, std::uint32_t first, PageBytes& all, std::size_t& least) {
  const std::vector<PageId> pages = pages_of(file);
  std::vector<std::vector<Bytes>> samples(pages.size());
  StepPages<OrderedWord<Sample>> steps(file, kMemory);
  for (std::uint32_t step = first; step < first + file.header(first).steps(); ++step) {
    auto& of_step = steps.at(step);
    for (std::size_t n = 0; n < pages.size(); ++n)
      samples[n].push_back(
          samples_of<Sample>(file.grid(), pages[n], of_step.needed_samples(pages[n]).samples));
  }
  std::vector<PageBytes> found(pages.size());
  parallel_for(pages.size(), 4, [&](std::size_t n) { found[n] = compress(samples[n], sizeof(Sample)); });
  for (const PageBytes& page : found) {
    all.input += page.input;
    all.alone += page.alone;
    all.in_turn += page.in_turn;
    all.interleaved += page.interleaved;
    least += page.least();
  }
}

template <class Sample>
void report(StoreFile& file) {
  PageBytes all;
  std::size_t least = 0;
  for (std::uint32_t step = 0; step < file.steps(); step += file.header(step).steps())
    add_block<Sample>(file, step, all, least);
  std::printf("{\"input\": %zu, \"alone\": %zu, \"in_turn\": %zu, \"interleaved\": %zu, \"least\": %zu}\n",
              all.input, all.alone, all.in_turn, all.interleaved, least);
}

}  // namespace
}  // namespace adamas::bench

/// STORE
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  adamas::StoreFile file(argv[1]);
  adamas::with_sample_type(file.header().grid.type,
                           [&](auto sample) { adamas::bench::report<decltype(sample)>(file); });
}
