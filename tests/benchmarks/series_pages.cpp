// Compresses a series by zstd -19, page by page as a store has it. For each page of a block there are three
// ways: each step by itself; the steps of the block one after another, as in the file; and these steps sample
// by sample, as the dissertation (D 5.5) interleaves them. The best of the three counts. Samples, errors, and
// the least and greatest words of ranges are compressed separately. Of a long series only some pages are
// used. Prints a line of JSON for samples, and one for the others.

#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/compression/page_order.h"
#include "timevarying/step_pages.h"

namespace adamas::bench {

using namespace isosurface;
using namespace timevarying;

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

/// Compresses the samples of a page, which are given step by step.
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

/// Returns the points that a page adds to coarser ones, in z-order, without those beyond the data.
std::vector<std::size_t> own_places(const PageGrid& grid, const PageId& id) {
  std::vector<std::size_t> places;
  for_each_own_point(page_shape(grid, id), [&](LatticePoint q, std::uint64_t) {
    const LatticePoint p = (1 << id.lod) * (PageGrid::kSide * id.block + q);
    if (p.i <= grid.last().i && p.j <= grid.last().j && p.k <= grid.last().k)
      places.push_back(PageGrid::place(q, 0));
  });
  return places;
}

template <class Number>
Bytes bytes_of(const std::vector<Number>& numbers) {
  const auto bytes = std::as_bytes(std::span(numbers));
  return {bytes.begin(), bytes.end()};
}

/// Returns the samples of a page in their own type.
template <class Sample>
Bytes samples_of(const PagePoints<OrderedWord<Sample>>& words, const std::vector<std::size_t>& places) {
  std::vector<Sample> samples;
  for (const std::size_t place : places) samples.push_back(from_ordered<Sample>(words[place]));
  return bytes_of(samples);
}

template <class Points>
Bytes points_of(const Points& points, const std::vector<std::size_t>& places) {
  std::vector<typename Points::value_type> numbers;
  for (const std::size_t place : places) numbers.push_back(points[place]);
  return bytes_of(numbers);
}

/// Returns pages at regular intervals over all levels, so that there are about `most` pages in all steps.
std::vector<PageId> pages_of(const StoreFile& file, std::uint64_t most) {
  const PageGrid& grid = file.grid();
  const std::uint64_t every = 1 + grid.page_count() * file.steps() / most;
  std::vector<PageId> pages;
  std::uint64_t count = 0;
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number)
    if (grid.contains(grid.page(number)) && count++ % every == 0) pages.push_back(grid.page(number));
  return pages;
}

/// The totals for one kind of numbers.
struct Total {
  PageBytes all;
  std::size_t least = 0;

  void add(const PageBytes& page) {
    all.input += page.input;
    all.alone += page.alone;
    all.in_turn += page.in_turn;
    all.interleaved += page.interleaved;
    least += page.least();
  }
  void print(const char* what) const {
    std::printf(
        "{\"of\": \"%s\", \"input\": %zu, \"alone\": %zu, \"in_turn\": %zu, \"interleaved\": %zu, "
        "\"least\": %zu}\n",
        what, all.input, all.alone, all.in_turn, all.interleaved, least);
  }
};

/// Adds numbers of `size` bytes at the points of some pages, in the block that begins with step `first`.
/// bytes(pages of a step, id, places) returns those of a page's points.
template <class Sample, class BytesOf>
void add_block(StoreFile& file, std::uint32_t first, std::uint64_t most, std::size_t size, BytesOf bytes,
               Total& total) {
  const std::vector<PageId> pages = pages_of(file, most);
  std::vector<std::vector<Bytes>> steps_of(pages.size());
  StepPages<OrderedWord<Sample>> steps(file, kMemory);
  for (std::uint32_t step = first; step < first + file.header(first).steps(); ++step) {
    auto& of_step = steps.at(step);
    for (std::size_t n = 0; n < pages.size(); ++n)
      steps_of[n].push_back(bytes(of_step, pages[n], own_places(file.grid(), pages[n])));
  }
  std::vector<PageBytes> found(pages.size());
  parallel_for(pages.size(), 4, [&](std::size_t n) { found[n] = compress(steps_of[n], size); });
  for (const PageBytes& page : found) total.add(page);
}

template <class Sample>
void report(StoreFile& file) {
  using Word = OrderedWord<Sample>;
  using Places = std::vector<std::size_t>;
  constexpr std::uint64_t kSamplePages = 70'000, kBoundsPages = 10'000;
  Total samples, bounds;
  for (std::uint32_t step = 0; step < file.steps(); step += file.header(step).steps()) {
    const auto add = [&](std::uint64_t most, std::size_t size, auto bytes, Total& total) {
      add_block<Sample>(file, step, most, size, bytes, total);
    };
    using Pages = StoredPages<Word>;
    add(
        kSamplePages, sizeof(Sample),
        [](Pages& pages, const PageId& id, const Places& places) {
          return samples_of<Sample>(pages.needed_samples(id).samples, places);
        },
        samples);
    add(
        kBoundsPages, 1,
        [](Pages& pages, const PageId& id, const Places& places) {
          return points_of(pages.needed_bounds(id).errors, places);
        },
        bounds);
    for (const auto side : {&PageBounds<Word>::low, &PageBounds<Word>::high})
      add(
          kBoundsPages, sizeof(Word),
          [side](Pages& pages, const PageId& id, const Places& places) {
            return points_of(pages.needed_bounds(id).*side, places);
          },
          bounds);
  }
  samples.print("samples");
  bounds.print("errors and ranges");
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_series_pages STORE.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  adamas::isosurface::StoreFile file(argv[1]);
  adamas::isosurface::with_sample_type(file.header().grid.type,
                                       [&](auto sample) { adamas::bench::report<decltype(sample)>(file); });
}
