#include "isosurface/compression/sample_codec.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/buckyball.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/volume/samples.h"
#include "tests/support/volume_pages.h"

namespace adamas {

using namespace datasets;
using namespace isosurface;

namespace {

/// Returns the processor seconds of this thread, which other programs do not affect.
double seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Returns the least seconds of several runs.
template <class F>
double least_seconds(int runs, F&& f) {
  double least = 1e300;
  for (int run = 0; run < runs; ++run) {
    const double begin = seconds();
    f();
    least = std::min(least, seconds() - begin);
  }
  return least;
}

template <class Word>
std::size_t report(const std::string& name, std::string_view coding_name, SampleCoding coding,
                   const test::VolumePages<Word>& volume) {
  using Content = typename test::VolumePages<Word>::Content;
  std::vector<Content> contents(volume.pages().size());
  for (std::size_t n = 0; n < contents.size(); ++n) volume.content(volume.pages()[n], contents[n]);

  std::shared_ptr<const SampleRanks> ranks;
  if (coding == SampleCoding::kRanks) {
    SampleCensus<Word> census;
    for (const Content& page : contents) census.add(page.shape, page.samples);
    ranks = census.ranks();
    if (ranks == nullptr) return 0;
  }
  const auto survey = sample_survey<Word>(coding, ranks);
  const double surveying = least_seconds(1, [&] {
    for (const Content& page : contents) survey->add(page.shape, page.around, page.samples);
  });
  std::unique_ptr<SampleCodec<Word>> codec;
  const double building = least_seconds(1, [&] { codec = survey->codec(); });
  std::vector<std::byte> bytes;
  std::vector<std::size_t> ends;
  const double encoding = least_seconds(2, [&] {
    bytes.clear();
    ends.clear();
    for (const Content& page : contents) {
      codec->encode(page.shape, page.around, page.samples, bytes);
      ends.push_back(bytes.size());
    }
  });
  typename SampleCodec<Word>::Samples found;
  const auto decode = [&](std::size_t n) {
    const std::size_t begin = n == 0 ? 0 : ends[n - 1];
    const auto page = std::span(bytes).subspan(begin, ends[n] - begin);
    if (!codec->decode(page, contents[n].shape, contents[n].around, found)) {
      throw std::runtime_error("a page was not decoded");
    }
  };
  const double decoding = least_seconds(5, [&] {
    for (std::size_t n = 0; n < contents.size(); ++n) decode(n);
  });
  for (std::size_t n = 0; n < contents.size(); ++n) {
    decode(n);
    const LatticePoint count = contents[n].shape.count;
    for (std::int32_t k = 0; k < count.k; ++k)
      for (std::int32_t j = 0; j < count.j; ++j)
        for (std::int32_t i = 0; i < count.i; ++i) {
          const std::size_t place = PageGrid::place({i, j, k}, 0);
          if (found[place] != contents[n].samples[place]) throw std::runtime_error("a sample differs");
        }
  }
  const std::size_t tables = codec->tables().size();
  const double millions = static_cast<double>(volume.bytes() / sizeof(Word)) / 1e6;
  std::printf(
      "%-24s %-14s ratio %7.3f, pages %zu, tables %zu bytes; M samples/s: survey %.0f, encode %.0f, decode "
      "%.0f; tables %.3f s\n",
      name.c_str(), std::string(coding_name).c_str(),
      static_cast<double>(volume.bytes()) / static_cast<double>(bytes.size() + tables), bytes.size(), tables,
      millions / surveying, millions / encoding, millions / decoding, building);
  return bytes.size() + tables;
}

template <class Word>
void report(const std::string& name, const test::VolumePages<Word>& volume) {
  report(name, "split edge", SampleCoding::kSplitEdge, volume);
  report(name, "interpolation", SampleCoding::kInterpolation, volume);
  report(name, "its ranks", SampleCoding::kRanks, volume);
}

/// Measures samples that are given as they lie in memory.
template <class Sample>
void report(const std::string& name, const std::array<std::uint64_t, 3>& dimensions,
            const std::vector<std::byte>& bytes) {
  std::vector<OrderedWord<Sample>> words(bytes.size() / sizeof(Sample));
  for (std::size_t n = 0; n < words.size(); ++n) {
    Sample sample;
    std::memcpy(&sample, bytes.data() + n * sizeof(Sample), sizeof(Sample));
    words[n] = static_cast<OrderedWord<Sample>>(ordered(sample));
  }
  report(name, test::VolumePages<OrderedWord<Sample>>(dimensions, std::move(words)));
}

void report(const std::string& name, const VolumeGrid& grid, const std::vector<std::byte>& bytes) {
  if (grid.type == SampleType::kUint8) report<std::uint8_t>(name, grid.dimensions, bytes);
  if (grid.type == SampleType::kUint16) report<std::uint16_t>(name, grid.dimensions, bytes);
  if (grid.type == SampleType::kInt16) report<std::int16_t>(name, grid.dimensions, bytes);
  if (grid.type == SampleType::kFloat32) report<float>(name, grid.dimensions, bytes);
}

void report_buckyball(std::uint64_t side, SampleType type) {
  const Buckyball buckyball({side, side, side}, type);
  const VolumeGrid& grid = buckyball.grid();
  std::vector<std::byte> bytes(grid.bytes());
  for (std::uint64_t k = 0; k < side; ++k) {
    buckyball.plane(k, std::span(bytes).subspan(k * grid.plane_bytes(), grid.plane_bytes()));
  }
  report("buckyball " + std::to_string(side) + "^3 " + sample_name(type), grid, bytes);
}

/// Measures a file of samples alone, NAME_ni_nj_nk_TYPE, where TYPE is u8, u16, i16 or f32.
void report_file(const std::filesystem::path& path) {
  std::vector<std::string> parts(1);
  for (const char c : path.filename().string()) {
    if (c == '_') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (parts.size() < 5) throw std::runtime_error(path.string() + ": expected NAME_ni_nj_nk_TYPE");
  const auto last = parts.end();
  VolumeGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis)
    grid.dimensions[axis] = std::stoul(*(last - 4 + static_cast<int>(axis)));
  const std::string type = *(last - 1);
  grid.type = type == "u8"    ? SampleType::kUint8
              : type == "u16" ? SampleType::kUint16
              : type == "i16" ? SampleType::kInt16
                              : SampleType::kFloat32;
  std::vector<std::byte> bytes(grid.bytes());
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  report(parts.front(), grid, bytes);
}

}  // namespace
}  // namespace adamas

/// Usage: bench_sample_codec [--quick | FILE...]. Without arguments the buckyball of 256^3 samples is
/// measured, with --quick that of 64^3.
int main(int argc, char** argv) {
  using adamas::SampleType;
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty() || first == "--quick") {
    const std::uint64_t side = first.empty() ? 256 : 64;
    for (const SampleType type : {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32}) {
      adamas::report_buckyball(side, type);
    }
    return 0;
  }
  for (int n = 1; n < argc; ++n) adamas::report_file(argv[n]);
  return 0;
}
