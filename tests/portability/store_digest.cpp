// Decodes stores, with vectors of 16 bytes and with those of the processor. Prints, for each, a checksum of
// all samples, errors, ranges and directions, which has to be the same for every compiler and machine.
//   store_digest STORE...

#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/base/checksum.h"
#include "core/base/simd.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas {

using namespace isosurface;

namespace {

/// Calls f(page) for all pages, coarse ones first.
template <class F>
void for_each_page(const PageGrid& grid, F f) {
  const std::uint64_t end = std::uint64_t{2} << (3 * grid.top());
  for (std::uint64_t number = 1; number < end; ++number) {
    const PageId id = grid.page(number);
    if (grid.contains(id)) f(id);
  }
}

template <class Sample>
std::uint32_t digest(StoreFile& file) {
  using Word = OrderedWord<Sample>;
  std::vector<std::byte> bytes;
  const auto add = [&bytes](const auto& number) {
    const auto* from = reinterpret_cast<const std::byte*>(&number);
    bytes.insert(bytes.end(), from, from + sizeof number);
  };
  constexpr std::size_t kMemory = std::size_t{1} << 26;
  StoredPages<Word> pages(file, 0, kMemory);
  for_each_page(file.grid(), [&](const PageId& id) {
    const auto page = std::make_unique<Page<Word>>();
    if (!pages.copy(id, *page)) throw std::runtime_error("a page is damaged");
    for_each_own_place(page_shape(file.grid(), id), [&](std::size_t at) {
      add(page->samples[at]), add(page->low[at]), add(page->high[at]), add(page->errors[at]);
    });
  });
  if (file.header().gradients) {
    StoredGradients gradients(file, 0, kMemory);
    for_each_page(file.grid(), [&](const PageId& id) {
      const auto* page = gradients.samples(id);
      if (page == nullptr) throw std::runtime_error("a page is damaged");
      for_each_own_place(page_shape(file.grid(), id), [&](std::size_t at) { add(page->samples[at]); });
    });
  }
  return crc32c(bytes);
}

}  // namespace
}  // namespace adamas

int main(int argc, char** argv) {
  using namespace adamas;
  using namespace adamas::isosurface;
  try {
    for (int n = 1; n < argc; ++n) {
      for (const bool is_short : {true, false}) {
        only_short_vectors = is_short;
        StoreFile file(argv[n]);
        const std::uint32_t found = with_sample_type(
            file.header().grid.type, [&](auto sample) { return digest<decltype(sample)>(file); });
        std::printf("%s %s %08x\n", argv[n], is_short ? "short" : "widest", found);
      }
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "store_digest: %s\n", e.what());
    return 1;
  }
}
