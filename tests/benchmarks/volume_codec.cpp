// Measures lossless coding of whole volumes beside other coders: bytes, including those of the container, and
// samples decoded a second on one thread. Prints a line of JSON for each volume and coder.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "core/base/parallel.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/volume/samples.h"
#include "tests/benchmarks/peers/block_coder.h"
#include "tests/benchmarks/support/measurement.h"
#include "tests/benchmarks/support/volume_in_memory.h"
#include "tests/support/build_store.h"
#include "tests/support/restored.h"
#include "tests/support/volume_pages.h"

namespace adamas::bench {

using namespace isosurface;

namespace {

/// Returns the least processor seconds of this thread over some runs.
template <class F>
double least_seconds(int runs, F&& f) {
  double least = 1e300;
  for (int run = 0; run < runs; ++run) {
    const double begin = thread_seconds();
    f();
    least = std::min(least, thread_seconds() - begin);
  }
  return least;
}

struct Figures {
  std::size_t bytes = 0;       ///< size of the code and of the places of its parts
  double decode_seconds = 0;   ///< time of the coder alone
  double restore_seconds = 0;  ///< time for a whole volume from the file; 0 where there is none
  std::size_t copies = 0, file_bytes = 0;
};

void print(const VolumeInMemory& volume, const std::string& coder, const Figures& figures) {
  const auto speed = [&](double seconds) {
    return seconds > 0 ? static_cast<double>(volume.grid.samples()) / seconds : 0;
  };
  std::printf(
      "{\"volume\": \"%s\", \"type\": \"%s\", \"dimensions\": [%llu, %llu, %llu], \"coder\": \"%s\", "
      "\"input\": %zu, "
      "\"bytes\": %zu, \"copies\": %zu, \"file\": %zu, \"decode\": %.0f, \"restore\": %.0f}\n",
      volume.name.c_str(), sample_name(volume.grid.type),
      static_cast<unsigned long long>(volume.grid.dimensions[0]),
      static_cast<unsigned long long>(volume.grid.dimensions[1]),
      static_cast<unsigned long long>(volume.grid.dimensions[2]), coder.c_str(), volume.bytes.size(),
      figures.bytes, figures.copies, figures.file_bytes, speed(figures.decode_seconds),
      speed(figures.restore_seconds));
  std::fflush(stdout);
}

/// Counts the bytes that the samples take in a store: their code, its tables, and all of the directory, as if
/// errors and ranges needed none of it.
void count_bytes(StoreFile& file, const std::vector<PageId>& pages, Figures& figures) {
  std::size_t rest = file.size();
  for (const PageId& page : pages) {
    const PageEntry entry = file.entry(0, page).value();
    rest -= entry.size;
    if (entry.copy != 0) {
      rest -= entry.size;
      figures.copies += entry.size;
    }
  }
  const StoreHeader& header = file.header();
  figures.file_bytes = file.size();
  figures.bytes = header.bytes.samples + rest - header.bounds_tables.size() - header.gradient_tables.size();
}

template <class Word>
double decode_all(StoreFile& file, const test::VolumePages<Word>& volume) {
  const auto codec = parse_sample_codec<Word>(file.header().coding, file.header().sample_tables, file.name());
  std::vector<test::PageContent<Word>> contents(volume.pages().size());
  std::vector<std::vector<std::byte>> codes(contents.size());
  for (std::size_t n = 0; n < contents.size(); ++n) {
    volume.content(volume.pages()[n], contents[n]);
    PagePayload parts;
    if (!split_payload(file.read(0, volume.pages()[n]).bytes, file.header().coding, parts))
      throw std::runtime_error("no payload");
    codes[n].assign(parts.samples.begin(), parts.samples.end());
  }
  typename SampleCodec<Word>::Samples samples;
  BytesAlong along;
  return least_seconds(3, [&] {
    for (std::size_t n = 0; n < contents.size(); ++n)
      if (!codec->decode_with(codes[n], contents[n].shape, contents[n].around, samples, along))
        throw std::runtime_error("a page was not decoded");
  });
}

/// Restores the volume and returns the least seconds. Throws where a restored sample differs.
double restore_all(StoreFile& file, const VolumeInMemory& volume) {
  const RestoredPart part = restored_part(volume.grid, 0, std::nullopt, volume.name);
  return least_seconds(3, [&] {
    std::size_t at = 0;
    test::restore(file, part, std::size_t{256} << 20, [&](std::span<const std::byte> plane) {
      if (std::memcmp(plane.data(), volume.bytes.data() + at, plane.size()) != 0)
        throw std::runtime_error("a sample differs");
      at += plane.size();
    });
  });
}

template <class Word>
test::VolumePages<Word> pages_of(const VolumeInMemory& volume) {
  const std::vector<std::byte> bytes = volume.ordered_words();
  std::vector<Word> words(bytes.size() / sizeof(Word));
  std::memcpy(words.data(), bytes.data(), bytes.size());
  return {volume.grid.dimensions, std::move(words)};
}

void measure_ours(const VolumeInMemory& volume, SampleCoding coding, const std::string& name) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("adamas-bench-" + std::to_string(::getpid()) + ".adm");
  test::build_store(path, volume.name, volume.grid,
                    [&](std::uint64_t k, std::span<std::byte> to) {
                      std::memcpy(to.data(), volume.bytes.data() + k * to.size(), to.size());
                    },
                    {.coding = coding});
  Figures figures;
  {
    StoreFile file(path);
    with_sample_type(volume.grid.type, [&](auto sample) {
      const auto pages = pages_of<OrderedWord<decltype(sample)>>(volume);
      count_bytes(file, pages.pages(), figures);
      figures.decode_seconds = decode_all(file, pages);
    });
    figures.restore_seconds = restore_all(file, volume);
  }
  std::filesystem::remove(path);
  print(volume, name, figures);
}

/// A volume cut into a coder's blocks.
struct Blocks {
  std::vector<BlockShape> shapes;
  std::vector<std::vector<std::byte>> samples, codes;
};

template <class Word>
Blocks cut(const VolumeInMemory& volume, const BlockCoder& coder) {
  std::vector<std::byte> bytes = volume.ordered_words();
  const std::span words(reinterpret_cast<Word*>(bytes.data()), bytes.size() / sizeof(Word));
  // Numbers have the fewest bits that hold them, so that the comparison is fair to JPEG-LS.
  const auto [least, greatest] = std::minmax_element(words.begin(), words.end());
  const Word base = *least;
  const int bits = std::bit_width(static_cast<unsigned>(*greatest - base));
  const std::array<std::size_t, 3> n{volume.grid.dimensions[0], volume.grid.dimensions[1],
                                     volume.grid.dimensions[2]};
  const auto sides = coder.sides(n);
  Blocks blocks;
  for (std::size_t k = 0; k < n[2]; k += sides[2])
    for (std::size_t j = 0; j < n[1]; j += sides[1])
      for (std::size_t i = 0; i < n[0]; i += sides[0]) {
        const BlockShape shape{
            {std::min(sides[0], n[0] - i), std::min(sides[1], n[1] - j), std::min(sides[2], n[2] - k)},
            sizeof(Word),
            bits};
        std::vector<Word> block;
        for (std::size_t z = 0; z < shape.sides[2]; ++z)
          for (std::size_t y = 0; y < shape.sides[1]; ++y)
            for (std::size_t x = 0; x < shape.sides[0]; ++x)
              block.push_back(static_cast<Word>(words[i + x + n[0] * (j + y + n[1] * (k + z))] - base));
        blocks.shapes.push_back(shape);
        const auto raw = std::as_bytes(std::span(block));
        blocks.samples.emplace_back(raw.begin(), raw.end());
      }
  return blocks;
}

void measure_peer(const VolumeInMemory& volume, BlockCoder& coder) {
  Blocks blocks = with_sample_type(
      volume.grid.type, [&](auto sample) { return cut<OrderedWord<decltype(sample)>>(volume, coder); });
  Figures figures;
  blocks.codes.resize(blocks.shapes.size());
  std::vector<std::byte> found(4 * 65536);
  for (std::size_t n = 0; n < blocks.shapes.size(); ++n) {
    coder.encode(blocks.shapes[n], blocks.samples[n], blocks.codes[n]);
    // Two bytes state the size of a block's code, and with it where the next one begins.
    figures.bytes += blocks.codes[n].size() + 2;
    coder.decode(blocks.shapes[n], blocks.codes[n], std::span(found).first(blocks.shapes[n].size()));
    if (std::memcmp(found.data(), blocks.samples[n].data(), blocks.samples[n].size()) != 0)
      throw std::runtime_error(coder.name() + ": a sample differs");
  }
  figures.decode_seconds = least_seconds(3, [&] {
    for (std::size_t n = 0; n < blocks.shapes.size(); ++n)
      coder.decode(blocks.shapes[n], blocks.codes[n], std::span(found).first(blocks.shapes[n].size()));
  });
  print(volume, coder.name(), figures);
}

void measure(const VolumeInMemory& volume) {
  measure_ours(volume, SampleCoding::kInterpolation, "interpolation");
  measure_ours(volume, SampleCoding::kSplitEdge, "split edge");
  measure_peer(volume, *jpeg_ls());
  measure_peer(volume, *lorenzo_zstd());
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_volume_codec [--look] VOLUME..., with volumes as load_volume names them. With --look only the
/// existence of each volume is printed.
int main(int argc, char** argv) {
  adamas::set_thread_limit(1);
  const bool look = argc > 1 && std::string_view(argv[1]) == "--look";
  try {
    for (int n = look ? 2 : 1; n < argc; ++n) {
      const adamas::bench::VolumeInMemory volume = adamas::bench::load_volume(argv[n]);
      if (!look) adamas::bench::measure(volume);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
