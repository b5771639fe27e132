// Measures what the errors and ranges of a store's pages cost, by LOD, in microseconds a page: pages that a
// contour may cross are decoded again, and the diamonds that it crosses are found. Prints a line of JSON for
// each LOD.
//   bench_page_bounds STORE ISOVALUE [PAGES [LEVELS]]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/volume/samples.h"
#include "tests/benchmarks/support/measurement.h"

namespace adamas::bench {

using namespace isosurface;

namespace {

template <class Word>
struct Coded {
  PageId id;
  PageShape shape;
  Surroundings<Word> around;
  Page<Word> page;
  std::vector<std::byte> values;
};

struct Figures {
  std::size_t pages = 0, bytes = 0;
  double decode = 0, around = 0, crossed = 0;  ///< seconds of this thread
};

/// Returns some pages of an LOD whose samples lie on both sides of the isovalue.
template <class Sample>
std::vector<PageId> crossed(StoreFile& file, int lod, double isovalue, std::size_t most) {
  std::vector<PageId> found;
  const LatticePoint n = file.grid().blocks(lod);
  for (std::int32_t k = 0; k < n.k; ++k) {
    for (std::int32_t j = 0; j < n.j; ++j) {
      for (std::int32_t i = 0; i < n.i; ++i) {
        const PageId id{lod, {i, j, k}};
        if (!file.grid().contains(id)) continue;
        const PageEntry entry = file.entry(0, id).value();
        if (entry.low > entry.high) continue;
        if (from_ordered<Sample>(entry.low) < isovalue && from_ordered<Sample>(entry.high) >= isovalue)
          found.push_back(id);
      }
    }
  }
  // The pages are a run from the middle, so that neighbours follow each other.
  if (found.size() <= most) return found;
  const auto begin = found.begin() + static_cast<std::ptrdiff_t>((found.size() - most) / 2);
  return {begin, begin + static_cast<std::ptrdiff_t>(most)};
}

template <class Sample>
Figures measure(StoreFile& file, int lod, double isovalue, std::size_t most) {
  using Word = OrderedWord<Sample>;
  StoredPages<Word> pages(file, 0, std::size_t{512} << 20);
  const auto codec =
      BoundsCodec<Word>::parse(file.header().bounds_tables, file.header().grid.spacing, file.name());
  StoredDiamonds<Sample> diamonds(pages);
  diamonds.set_contour(isovalue);
  typename StoredDiamonds<Sample>::Codes codes;
  [[maybe_unused]] volatile std::size_t sum = 0;
  std::vector<Coded<Word>> all;
  for (const PageId& id : crossed<Sample>(file, lod, isovalue, most)) {
    Coded<Word>& coded = all.emplace_back();
    coded.id = id;
    coded.shape = page_shape(file.grid(), id);
    if (!pages.surroundings(id, coded.around)) throw std::runtime_error("a page is damaged");
    if (!pages.copy(id, coded.page)) throw std::runtime_error("a page is damaged");
    PagePayload parts;
    if (!split_payload(file.read(0, id).bytes, file.header().coding, parts))
      throw std::runtime_error("no payload");
    coded.values = parts.all_bounds(coded.page.along).value();
  }
  Figures figures{all.size(), 0, 1e300, 1e300, 1e300};
  for (const auto& coded : all) figures.bytes += coded.values.size();
  // Batches stay in the caches, as a page does that was just read.
  constexpr std::size_t kBatch = 8;
  std::vector<Coded<Word>> batch(kBatch);
  for (int run = 0; run < 5; ++run) {
    Figures found;
    for (std::size_t first = 0; first < all.size(); first += kBatch) {
      const std::size_t size = std::min(kBatch, all.size() - first);
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(first), size, batch.begin());
      double begin = thread_seconds();
      for (std::size_t n = 0; n < size; ++n) {
        Coded<Word>& coded = batch[n];
        if (!codec.decode(coded.values, coded.shape, coded.around, coded.page, coded.page))
          throw std::runtime_error("a page was not decoded");
      }
      found.decode += thread_seconds() - begin;
      begin = thread_seconds();
      for (std::size_t n = 0; n < size; ++n) pages.surroundings(batch[n].id, batch[n].around);
      found.around += thread_seconds() - begin;
      begin = thread_seconds();
      for (std::size_t n = 0; n < size; ++n) {
        diamonds.find_crossed(batch[n].id.lod, batch[n].id.block, codes);
        sum = sum + codes[0x111];
      }
      found.crossed += thread_seconds() - begin;
    }
    figures.decode = std::min(figures.decode, found.decode);
    figures.around = std::min(figures.around, found.around);
    figures.crossed = std::min(figures.crossed, found.crossed);
  }
  return figures;
}

void run(const char* path, double isovalue, std::size_t most, int lods) {
  StoreFile file(path);
  for (int lod = 0; lod < std::min(lods, file.grid().top()); ++lod) {
    const Figures f = with_sample_type(file.header().grid.type, [&](auto sample) {
      return measure<decltype(sample)>(file, lod, isovalue, most);
    });
    const double pages = static_cast<double>(std::max<std::size_t>(f.pages, 1)) * 1e-6;
    std::printf(
        "{\"level\": %d, \"pages\": %zu, \"bytes\": %.0f, \"decode\": %.1f, \"around\": %.1f, \"crossed\": "
        "%.1f}\n",
        lod, f.pages, static_cast<double>(f.bytes) / pages * 1e-6, f.decode / pages, f.around / pages,
        f.crossed / pages);
  }
}

}  // namespace
}  // namespace adamas::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_page_bounds STORE ISOVALUE [PAGES [LEVELS]]\n");
    return 2;
  }
  adamas::bench::run(argv[1], std::atof(argv[2]), argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1000,
                     argc > 4 ? std::atoi(argv[4]) : adamas::isosurface::PageGrid::kMaxDepth);
}
