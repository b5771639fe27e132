// Makes the seeds of the fuzz targets of codecs of samples, of bounds and of gradients, of the store's own
// bytes, and of whole stores. FOLDER is that of all seeds. The program has to be run again where such bytes
// change.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "adamas/volume_store.h"
#include "core/base/checksum.h"
#include "core/data/stored_type.h"
#include "isosurface/compression/bounds/bounds_stages.h"
#include "isosurface/compression/gradients/gradient_codec.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/storage/store_format.h"
#include "tests/fuzz/bounds_targets.h"
#include "tests/fuzz/store_file_targets.h"
#include "tests/fuzz/time_targets.h"
#include "tests/support/golden_series.h"

namespace adamas::fuzz {

using namespace isosurface;
using namespace timevarying;

namespace {

using Bytes = std::vector<std::byte>;

struct Seed {
  std::string name;
  SampleCoding coding;
  LatticePoint count;
  bool complete;
  int noise;                                    ///< as a part of the greatest number
  std::uint32_t values = 1;                     ///< for kRanks: samples are multiples of this
  std::optional<std::uint8_t> prevailing = {};  ///< for single bytes: no sample is less than this
};

void append(Bytes& to, const Bytes& from) { to.insert(to.end(), from.begin(), from.end()); }
void put(Bytes& to, std::size_t number) { to.push_back(static_cast<std::byte>(number & 0xff)); }

void put_points(Bytes& to, LatticePoint count) {
  for (int axis = 0; axis < 3; ++axis) put(to, static_cast<std::size_t>(count[axis] - 1));
}
void put_tables(Bytes& to, const Bytes& tables, const Bytes& page) {
  put(to, tables.size());
  put(to, tables.size() >> 8);
  append(to, tables);
  append(to, page);
}

/// Fills an array with waves and noise.
template <class Number, std::size_t N>
void fill(std::array<Number, N>& numbers, int noise) {
  std::mt19937 random(5);
  for (std::size_t n = 0; n < N; ++n) {
    const double x = static_cast<double>(n % 16), y = static_cast<double>(n / 16 % 16),
                 z = static_cast<double>(n / 256);
    const double wave = 0.4 * std::sin(0.2 * x + 0.3 * y) * std::cos(0.25 * z);
    const double part = noise == 0 ? 0 : static_cast<double>(random() % 1000) / 1000 / noise;
    numbers[n] = static_cast<Number>((0.5 + wave + 0.1 * part) * static_cast<double>(Number(~Number{0})));
  }
}

void write(const std::filesystem::path& folder, const std::string& name, const Bytes& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

template <class Word>
std::vector<std::uint32_t> different(const PagePoints<Word>& samples) {
  const std::set<std::uint32_t> values(samples.begin(), samples.end());
  return {values.begin(), values.end()};
}

template <class Word>
void make_samples(const std::filesystem::path& folder, const Seed& seed) {
  const PageShape shape{seed.count, seed.complete, 0};
  typename SampleCodec<Word>::Around around;
  for (std::size_t n = 0; n < around.size(); ++n) around[n] = static_cast<Word>(n * n * 7);
  typename SampleCodec<Word>::Samples samples;
  fill(samples, seed.noise);
  std::shared_ptr<const SampleRanks> ranks;
  if (seed.coding == SampleCoding::kRanks) {
    for (Word& sample : samples) sample = static_cast<Word>(sample / seed.values * seed.values);
    ranks = std::make_shared<const SampleRanks>(different(samples));
  }
  std::optional<Word> prevailing;
  if (seed.prevailing) {
    prevailing = static_cast<Word>(*seed.prevailing);
    for (Word& sample : samples) sample = std::max(sample, *prevailing);
  }
  const auto survey = sample_survey<Word>(seed.coding, ranks, prevailing);
  survey->add(shape, around, samples);
  const auto codec = survey->codec();
  Bytes page, bytes;
  codec->encode(shape, around, samples, page);
  put(bytes, sizeof(Word) + (seed.coding == SampleCoding::kInterpolation ? 128u : 0u) + (ranks ? 64u : 0u));
  put_points(bytes, seed.count);
  put(bytes, seed.complete ? 1 : 0);
  put_tables(bytes, codec->tables(), page);
  write(folder / "sample_codec", seed.name, bytes);
}

/// How a page of a series follows from earlier ones.
enum class InTime : std::uint8_t { kSpace, kAsBefore, kOnce, kTwice };

/// Makes a page of a series. A page that is coded in space has nothing in common with earlier ones. Others
/// are the page before, that page with some noise, or the continuation of its rise with some noise.
template <class Word>
void make_time(const std::filesystem::path& folder, const Seed& seed, InTime way) {
  constexpr std::uint8_t kSeed = 9;
  const PageShape shape{seed.count, seed.complete, 0};
  const auto steps = std::make_unique<SeededSteps<Word>>(kSeed);
  PagePoints<Word> samples = steps->before[0].samples;
  if (way == InTime::kSpace) fill(samples, seed.noise);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const std::size_t noise = n % 11 == 0 && way >= InTime::kOnce ? 5 : 0;
    samples[n] = static_cast<Word>(samples[n] + noise + (way == InTime::kTwice ? n % 3 : 0));
    if (seed.coding == SampleCoding::kRanks) samples[n] = static_cast<Word>(samples[n] % 16 * seed.values);
  }
  std::shared_ptr<const SampleRanks> ranks;
  if (seed.coding == SampleCoding::kRanks) ranks = std::make_shared<const SampleRanks>(different(samples));
  TimeSurvey<Word> survey(sample_survey<Word>(seed.coding, ranks, {}), seed.coding, true);
  survey.add(shape, steps->around, samples, steps->before);
  // The page that is kept has no differences, so another page is added for the tables of differences.
  if (way == InTime::kAsBefore) {
    samples[7] = static_cast<Word>(samples[7] + 1);
    survey.add(shape, steps->around, samples, steps->before);
    samples = steps->before[0].samples;
  }
  const TimeCodec<Word> codec(survey);
  Bytes page, bytes;
  codec.encode(shape, steps->around, samples, steps->before, page, {});
  const bool is_before = page.size() == 1 && page[0] == kAsBefore;
  const int wanted = way == InTime::kSpace ? 0 : way == InTime::kTwice ? 2 : 1;
  require(is_before == (way == InTime::kAsBefore) && time_order(page) == wanted, "a page of another order");
  put(bytes, sizeof(Word) + (seed.coding == SampleCoding::kInterpolation ? 128u : 0u) + (ranks ? 64u : 0u));
  put_points(bytes, seed.count);
  put(bytes, seed.complete ? 1 : 0);
  for (const std::size_t size : {codec.tables().size(), codec.time_tables().size()}) {
    put(bytes, size);
    put(bytes, size >> 8);
  }
  put(bytes, kSeed);
  for (const Bytes& part : {codec.tables(), codec.time_tables(), page}) append(bytes, part);
  write(folder / "time_codec", seed.name, bytes);
}

void make_gradients(const std::filesystem::path& folder, const Seed& seed) {
  const PageShape shape{seed.count, seed.complete, 0};
  GradientCodesAround around;
  for (std::size_t n = 0; n < around.size(); ++n) around[n] = static_cast<std::uint16_t>(n * n * 7);
  GradientCodes codes;
  fill(codes, seed.noise);
  GradientSurvey survey(seed.coding);
  survey.add(shape, around, codes);
  const GradientCodec codec = survey.codec();
  Bytes page, bytes;
  codec.encode(shape, around, codes, page);
  put(bytes, (seed.coding == SampleCoding::kInterpolation ? 128 : 0) + (seed.complete ? 1 : 0));
  put_points(bytes, seed.count);
  put_tables(bytes, codec.tables(), page);
  write(folder / "gradient_codec", seed.name, bytes);
}

/// Sets a page's bounds to the expected ones, except for some of those that are coded.
template <class Word>
struct Expectations {
  BoundsFields<Word>& fields;
  std::size_t met = 0;

  [[nodiscard]] static bool needs_errors() { return true; }
  [[nodiscard]] static bool needs_ranges() { return true; }
  void errors(const BoundsStage& stage) {
    const auto parity = static_cast<std::size_t>(stage.parity);
    for_each(stage, [&](std::size_t cell, bool other) {
      fields.errors[parity][cell] = static_cast<std::uint8_t>((fields.predicted[parity][cell] + other) & 63);
    });
  }
  void range(std::size_t side, const BoundsStage& stage) {
    for_each(stage, [&](std::size_t cell, bool other) {
      const Word known = fields.known[side][cell];
      fields.ranges[side][static_cast<std::size_t>(stage.parity)][cell] =
          static_cast<Word>(known - (other && known > 0 ? met % 9 : 0));
    });
  }

 private:
  template <class Visit>
  void for_each(const BoundsStage& stage, Visit visit) {
    const RowBytes* coded = stage.coded.data();
    stage.box.for_each_row([&](std::size_t first, std::size_t, int count) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        visit(first + i, (*coded >> 8 * i & 1) != 0 && ++met % 5 == 0);
      ++coded;
    });
  }
};

/// Makes a page of bounds. The samples of the page and its surroundings follow from `seed`. Without left_out
/// points bounds are as expected only by chance. With `equal` all bounds are the same instead.
template <class Word>
void make_bounds(const std::filesystem::path& folder, const std::string& name, const PageShape& shape,
                 std::uint8_t seed, bool left_out, bool equal = false) {
  const OwnErrorGeometry geometry({1, 1, 1});
  const auto around = std::make_unique<Surroundings<Word>>();
  const auto page = std::make_unique<Page<Word>>();
  seeded_page(seed, *page, *around);
  const auto fields = std::make_unique<BoundsFields<Word>>();
  fields->load(shape, *around, *page);
  Expectations<Word> expected{*fields};
  if (shape.complete) {
    walk_complete_bounds<Word>(*fields, shape, expected);
  } else {
    walk_bounds<Word>(*fields, geometry, shape, {left_out, left_out}, expected);
  }
  fields->store_bounds(shape, *page);
  if (equal) {
    page->low.fill(3);
    page->high.fill(200);
    page->errors.fill(63);
  }
  BoundsSurvey<Word> survey({1, 1, 1});
  survey.add(shape, *around, *page);
  const BoundsCodec<Word> codec(survey);
  Bytes coded, bytes;
  codec.encode(shape, *around, *page, coded);
  put(bytes, 8 * sizeof(Word));
  put_points(bytes, shape.count);
  put(bytes, static_cast<std::size_t>(shape.lod) | (shape.complete ? 128 : 0));
  put(bytes, seed);
  put_tables(bytes, codec.tables(), coded);
  write(folder / "bounds_codec", name, bytes);
}

/// Makes all of a store but its pages, which have a few bytes each. With a `first_step` it is the last block
/// of several.
void make_store(const std::filesystem::path& folder, const std::string& name, const VolumeGrid& grid,
                std::uint32_t steps, bool has_plain = false, std::uint32_t first_step = 0,
                std::uint32_t group_pages = 1) {
  StoreRoot root;
  root.header.first_step = first_step;
  root.header.group_pages = group_pages;
  if (first_step > 0) root.before = {5, 20};
  root.header.grid = grid;
  root.header.numbers.type = stored_type(grid.type);
  root.header.times.resize(steps);
  for (std::size_t n = 0; n < root.header.times.size(); ++n) root.header.times[n] = static_cast<double>(n);
  root.header.sample_tables = root.header.bounds_tables = {std::byte{1}, std::byte{2}};
  const PageGrid pages(grid.dimensions);
  Bytes directory, bytes;
  StorePrologue prologue{{StorePrologue::kBytes, 0}};
  const std::uint64_t end = std::uint64_t{2} << (3 * pages.top());
  for (std::uint64_t first = 0; first < end; first += DirectoryChunk::kPages) {
    const std::size_t count = steps * chunk_pages(pages, first).size();
    if (count == 0) continue;
    PageEntry entry;
    entry.low = 3, entry.high = 200, entry.error = 40, entry.size = 20, entry.checksum = 77;
    for (std::size_t n = 1; n < entry.part_count(); ++n)
      entry.part_errors[n] = static_cast<std::uint8_t>(41 - n % 15);
    std::vector<PageEntry> entries(count, entry);
    for (std::size_t n = 0; has_plain && n < count; ++n) {
      if (n % 7 < 4) entries[n] = PageEntry{{3, n % 7 < 2 ? 200u : 201u, 0, {}}};
    }
    const Bytes part = serialise_entries(entries, sample_bytes(grid.type));
    root.chunks.push_back({first, prologue.root.offset, part.size(), crc32c(part), 32, 33});
    prologue.root.offset += part.size();
    append(directory, part);
  }
  Bytes last = root.serialise(), start = prologue.serialise();
  last.erase(last.end() - 4, last.end());
  bytes.assign(start.begin() + 8, start.end() - 4);
  put_tables(bytes, last, directory);
  write(folder / "store_format", name, bytes);
}

/// Makes a whole store of a small series, which is created and then extended.
template <class Sample>
void make_store_file(const std::filesystem::path& folder, const test::GoldenSeries& series,
                     const test::Dimensions& dimensions) {
  const test::Scratch scratch;
  const test::GoldenSteps<Sample> steps(series, dimensions);
  steps.build(series, scratch / "a.adm");
  const std::string made = test::bytes_of(scratch / "a.adm");
  const auto bytes = std::as_bytes(std::span(made));
  write(folder / "store_file", series.name, {bytes.begin(), bytes.end()});
}

/// Whether some page of a store has samples, but bounds that cannot be had.
bool has_page_without_bounds(const std::vector<std::byte>& bytes) {
  const MemoryFile memory(bytes);
  StoreFile file(memory.path());
  for (std::uint32_t step = 0; step < file.steps(); ++step) {
    SeriesPages<std::uint8_t> pages(file, step, 0);
    for (const PageId& id : pages_of(file)) {
      if (pages.samples(id) != nullptr && pages.bounds(id) == nullptr) return true;
    }
  }
  return false;
}

/// Makes a whole store of which some page has samples and no bounds: the first byte from the end is damaged
/// that leads to one.
void make_damaged_bounds(const std::filesystem::path& folder, const test::GoldenSeries& series) {
  const test::Scratch scratch;
  const test::GoldenSteps<std::uint8_t> steps(series, {20, 9, 18});
  steps.build(series, scratch / "a.adm");
  const std::string made = test::bytes_of(scratch / "a.adm");
  const auto sound = std::as_bytes(std::span(made));
  for (std::size_t at = made.size(); at-- > StorePrologue::kBytes;) {
    Bytes bytes(sound.begin(), sound.end());
    bytes[at] ^= std::byte{0x55};
    try {
      const ChecksumRepair repair(bytes);
      if (!has_page_without_bounds(bytes)) continue;
    } catch (const Error&) {
      continue;
    }
    return write(folder / "store_file", "no_bounds", bytes);
  }
}

/// Makes a whole store of float64 numbers, in two steps.
void make_number_store(const std::filesystem::path& folder) {
  const test::Scratch scratch;
  SeriesSource series;
  series.grid.dimensions = {17, 5, 6};
  series.grid.type = SampleType::kFloat32;
  series.times = {0, 1};
  const auto number = [](std::uint64_t n, std::uint64_t k) {
    return std::sin(0.1 * static_cast<double>(n + k));
  };
  series.planes = [&number](std::uint32_t) {
    return [&number](std::uint64_t k, std::span<std::byte> samples) {
      for (std::size_t n = 0; n < samples.size() / sizeof(float); ++n) {
        const auto sample = static_cast<float>(number(n, k));
        std::memcpy(samples.data() + n * sizeof sample, &sample, sizeof sample);
      }
    };
  };
  series.numbers = StoredType::kFloat64;
  series.number_planes = [&number](std::uint64_t k, std::span<std::byte> numbers) {
    for (std::size_t n = 0; n < numbers.size() / sizeof(double); ++n) {
      const double exact = number(n, k);
      std::memcpy(numbers.data() + n * sizeof exact, &exact, sizeof exact);
    }
  };
  VolumeStore::build(scratch / "a.adm", series);
  const std::string made = test::bytes_of(scratch / "a.adm");
  const auto bytes = std::as_bytes(std::span(made));
  write(folder / "store_file", "numbers", {bytes.begin(), bytes.end()});
}

VolumeGrid grid_of(SampleType type, std::array<std::uint64_t, 3> dimensions) {
  VolumeGrid grid;
  grid.type = type;
  grid.dimensions = dimensions;
  grid.spacing = {1, 0.5, 2};
  return grid;
}

void make(const std::filesystem::path& folder) {
  constexpr auto kEdge = SampleCoding::kSplitEdge, kOurs = SampleCoding::kInterpolation,
                 kRanks = SampleCoding::kRanks;
  make_samples<std::uint8_t>(folder, {"bytes", kOurs, {5, 4, 3}, false, 0});
  make_samples<std::uint8_t>(folder, {"complete", kOurs, {4, 4, 3}, true, 0});
  make_samples<std::uint8_t>(folder, {"raw", kOurs, {3, 3, 3}, false, 1});
  make_samples<std::uint8_t>(folder, {"prevailing", kOurs, {7, 5, 4}, false, 3, 1, std::uint8_t{128}});
  make_samples<std::uint16_t>(folder, {"shorts", kOurs, {6, 4, 3}, false, 9});
  make_samples<std::uint32_t>(folder, {"words", kOurs, {4, 3, 3}, false, 3});
  make_samples<std::uint8_t>(folder, {"split_bytes", kEdge, {5, 4, 3}, false, 0});
  make_samples<std::uint8_t>(folder, {"split_complete", kEdge, {4, 4, 3}, true, 0});
  make_samples<std::uint32_t>(folder, {"split_words", kEdge, {4, 3, 3}, false, 3});
  make_samples<std::uint16_t>(folder, {"short_ranks", kRanks, {6, 4, 3}, false, 9, 2000});
  make_samples<std::uint32_t>(folder, {"word_ranks", kRanks, {4, 3, 5}, false, 3, 1u << 22});
  make_samples<std::uint32_t>(folder, {"complete_ranks", kRanks, {4, 4, 3}, true, 3, 1u << 26});
  make_bounds<std::uint8_t>(folder, "bytes", {{9, 5, 7}, false, 1}, 5, false);
  make_bounds<std::uint8_t>(folder, "sure", {{16, 5, 4}, false, 0}, 12, true);
  make_bounds<std::uint8_t>(folder, "empty", {{16, 16, 16}, false, 0}, 0, true);
  make_bounds<std::uint8_t>(folder, "equal", {{7, 9, 5}, false, 0}, 40, false, true);
  make_bounds<std::uint16_t>(folder, "shorts", {{6, 3, 5}, false, 0}, 20, true);
  make_bounds<std::uint32_t>(folder, "words", {{4, 3, 3}, true, 2}, 60, false);
  make_bounds<std::uint32_t>(folder, "floats", {{5, 4, 3}, false, 0}, 60, false);
  make_gradients(folder, {"page", kOurs, {6, 5, 3}, false, 2});
  make_gradients(folder, {"complete", kOurs, {4, 4, 4}, true, 2});
  make_gradients(folder, {"raw", kOurs, {3, 3, 3}, false, 1});
  make_gradients(folder, {"split_page", kEdge, {6, 5, 3}, false, 2});
  make_gradients(folder, {"split_complete", kEdge, {4, 4, 4}, true, 2});
  make_time<std::uint8_t>(folder, {"space", kOurs, {5, 4, 3}, false, 2}, InTime::kSpace);
  make_time<std::uint8_t>(folder, {"as_before", kOurs, {5, 4, 3}, false, 0}, InTime::kAsBefore);
  make_time<std::uint8_t>(folder, {"once", kOurs, {9, 5, 4}, false, 0}, InTime::kOnce);
  make_time<std::uint8_t>(folder, {"twice", kOurs, {9, 5, 4}, false, 0}, InTime::kTwice);
  make_time<std::uint16_t>(folder, {"complete", kOurs, {4, 5, 4}, true, 0}, InTime::kTwice);
  make_time<std::uint16_t>(folder, {"split_edge", kEdge, {5, 4, 4}, false, 0}, InTime::kOnce);
  make_time<std::uint32_t>(folder, {"words", kOurs, {5, 4, 4}, false, 0}, InTime::kTwice);
  make_store(folder, "one_sample", grid_of(SampleType::kUint8, {1, 1, 1}), 1);
  make_store(folder, "floats", grid_of(SampleType::kFloat32, {20, 17, 9}), 2);
  VolumeGrid turned = grid_of(SampleType::kUint16, {130, 20, 20});
  turned.directions = {{{0, -1, 0}, {0.6, 0, 0.8}, {-0.8, 0, 0.6}}};
  turned.space = "LPS";
  make_store(folder, "copies", turned, 1);
  make_store(folder, "rod", grid_of(SampleType::kInt16, {300, 1, 2}), 1);
  make_store(folder, "plain", grid_of(SampleType::kUint8, {90, 40, 20}), 1, true);
  make_store(folder, "groups", grid_of(SampleType::kUint8, {70, 40, 20}), 3, true, 0, 8);
  make_store(folder, "last_block", grid_of(SampleType::kUint8, {36, 20, 20}), 2, false, 4, 2);
  std::vector<test::GoldenSeries> series = test::golden_series();
  for (test::GoldenSeries& one : series) one.ends = {1, 3};
  make_store_file<std::uint8_t>(folder, series[0], {18, 9, 9});
  make_store_file<std::uint8_t>(folder, series[1], {20, 9, 18});
  make_store_file<std::uint8_t>(folder, series[2], {17, 9, 4});
  make_store_file<std::uint16_t>(folder, series[3], {18, 5, 4});
  make_store_file<float>(folder, series[4], {18, 3, 4});
  make_damaged_bounds(folder, series[1]);
  make_number_store(folder);
}

}  // namespace
}  // namespace adamas::fuzz

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  adamas::fuzz::make(argv[1]);
}
