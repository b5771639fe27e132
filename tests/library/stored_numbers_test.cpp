#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>

#include "adamas/output_set.h"
#include "adamas/store_files.h"
#include "adamas/volume_store.h"
#include "core/base/error.h"
#include "core/data/stored_type.h"
#include "core/io/volume_reader.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::Scratch;
using Bytes = std::vector<std::byte>;

constexpr std::array<std::uint64_t, 3> kDimensions{19, 13, 21};

constexpr StoredType kWideTypes[] = {StoredType::kInt8,  StoredType::kInt32,  StoredType::kUint32,
                                     StoredType::kInt64, StoredType::kUint64, StoredType::kFloat64};

/// Numbers of a type: a third of any bits, among them NaN, a third of small whole ones, and a third of smooth
/// ones with many digits; and some at the ends of the range.
template <class Number>
std::vector<Number> odd_numbers(std::size_t count, unsigned seed) {
  constexpr double kGreatest = sizeof(Number) == 1 ? 100 : 1e9;
  std::mt19937_64 random(seed);
  std::vector<Number> numbers;
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint64_t bits = random();
    Number number{};
    if (n % 3 == 0) std::memcpy(&number, &bits, sizeof number);
    if (n % 3 == 1) number = static_cast<Number>(bits % 100);
    if (n % 3 == 2)
      number = static_cast<Number>(kGreatest * std::abs(std::sin(0.01 * static_cast<double>(n))));
    if (n % 97 == 0) number = std::numeric_limits<Number>::max();
    if (n % 97 == 1) number = std::numeric_limits<Number>::lowest();
    numbers.push_back(number);
  }
  return numbers;
}

Bytes odd_bytes(StoredType type, std::size_t count, unsigned seed) {
  Bytes bytes;
  visit_stored_type(type, [&](auto zero) {
    const auto numbers = odd_numbers<decltype(zero)>(count, seed);
    const auto all = std::as_bytes(std::span(numbers));
    bytes.assign(all.begin(), all.end());
  });
  return bytes;
}

/// The samples of numbers of a wide type: int16 of int8, float32 of others, those beyond its range at its
/// ends.
Bytes samples_of(StoredType type, std::span<const std::byte> numbers) {
  Bytes samples;
  const auto append = [&samples](auto sample) {
    const auto bytes = std::as_bytes(std::span(&sample, 1));
    samples.insert(samples.end(), bytes.begin(), bytes.end());
  };
  visit_stored_type(type, [&]<class Number>(Number number) {
    for (std::size_t at = 0; at < numbers.size(); at += sizeof(Number)) {
      std::memcpy(&number, numbers.data() + at, sizeof(Number));
      if constexpr (std::is_same_v<Number, std::int8_t>) {
        append(std::int16_t{number});
      } else if constexpr (std::is_same_v<Number, double>) {
        constexpr double kMost = std::numeric_limits<float>::max();
        append(static_cast<float>(std::isfinite(number) ? std::clamp(number, -kMost, kMost) : number));
      } else {
        append(static_cast<float>(number));
      }
    }
  });
  return samples;
}

/// Steps of numbers of a type.
struct NumberSeries {
  NumberSeries(StoredType of_type, std::uint32_t count) : type(of_type) {
    grid.dimensions = kDimensions;
    grid.type = sample_type_for(type);
    for (std::uint32_t n = 0; n < count; ++n) steps.push_back(odd_bytes(type, grid.samples(), n));
  }

  [[nodiscard]] SeriesSource source(std::uint32_t begin, std::uint32_t end) {
    SeriesSource series;
    series.grid = grid;
    for (std::uint32_t n = begin; n < end; ++n) series.times.push_back(n);
    const std::size_t plane = grid.plane_samples() * stored_bytes(type);
    series.planes = [this, begin, plane](std::uint32_t n) {
      step = begin + n;
      return [this, plane](std::uint64_t k, std::span<std::byte> samples) {
        const Bytes found = samples_of(type, std::span(steps[step]).subspan(k * plane, plane));
        std::memcpy(samples.data(), found.data(), found.size());
      };
    };
    series.numbers = type;
    series.number_planes = [this, plane](std::uint64_t k, std::span<std::byte> numbers) {
      std::memcpy(numbers.data(), steps[step].data() + k * plane, plane);
    };
    series.array = "odd";
    return series;
  }

  StoredType type;
  VolumeGrid grid;
  std::vector<Bytes> steps;
  std::uint32_t step = 0;
};

std::vector<Bytes> restored_numbers(VolumeStore& store, const VolumePart& part = {}) {
  std::vector<Bytes> steps(store.steps());
  store.restore_numbers({0, store.steps() - 1}, part,
                        [&](std::uint32_t step, std::span<const std::byte> plane) {
                          steps[step].insert(steps[step].end(), plane.begin(), plane.end());
                        });
  return steps;
}

TEST(StoredNumbers, OfEveryWideTypeComeBackBitForBit) {
  const Scratch scratch;
  for (const StoredType type : kWideTypes) {
    SCOPED_TRACE(to_string(type));
    NumberSeries series(type, 5);
    const auto path = scratch / "numbers.adm";
    BuildOptions options;
    options.block_steps = 2;
    VolumeStore::build(path, series.source(0, 3), options);
    VolumeStore::append(path, series.source(3, 5), options);
    VolumeStore store = VolumeStore::open(path);
    EXPECT_EQ(store.number_type(), type);
    EXPECT_EQ(store.array(), "odd");
    EXPECT_EQ(restored_numbers(store), series.steps);
    EXPECT_EQ(store.restore({}, 4).samples, samples_of(type, series.steps[4]));
    EXPECT_EQ(store.verify().bad_pages, 0u);
  }
}

TEST(StoredNumbers, OfAPartAreThoseOfTheWhole) {
  const Scratch scratch;
  const auto path = scratch / "numbers.adm";
  NumberSeries series(StoredType::kFloat64, 2);
  VolumeStore::build(path, series.source(0, 2));
  VolumeStore store = VolumeStore::open(path);
  const VolumePart part{.region = Box3{{3, 2, 5}, {14, 11, 19}}, .lod = 1};
  const auto found = restored_numbers(store, part);
  for (std::size_t step = 0; step < 2; ++step) {
    Bytes wanted;
    for (std::uint64_t k = 6; k <= 18; k += 2) {
      for (std::uint64_t j = 2; j <= 10; j += 2) {
        for (std::uint64_t i = 4; i <= 14; i += 2) {
          const auto at = series.steps[step].begin() +
                          static_cast<std::ptrdiff_t>(8 * (i + kDimensions[0] * (j + kDimensions[1] * k)));
          wanted.insert(wanted.end(), at, at + 8);
        }
      }
    }
    EXPECT_EQ(found[step], wanted);
  }
}

TEST(StoredNumbers, ThatAreFloatsAlreadyTakeNoRoom) {
  const Scratch scratch;
  NumberSeries series(StoredType::kFloat64, 1);
  for (std::size_t n = 0; n < series.grid.samples(); ++n) {
    const double number = static_cast<float>(std::sin(0.1 * static_cast<double>(n)));
    std::memcpy(series.steps[0].data() + n * sizeof number, &number, sizeof number);
  }
  VolumeStore::build(scratch / "numbers.adm", series.source(0, 1));
  VolumeStore store = VolumeStore::open(scratch / "numbers.adm");
  EXPECT_EQ(store.facts().bytes.remainders, 0u);
  EXPECT_EQ(restored_numbers(store), series.steps);
}

TEST(StoredNumbers, ThatAreDamagedAreNeverReturned) {
  const Scratch scratch;
  const auto path = scratch / "numbers.adm";
  NumberSeries series(StoredType::kInt64, 2);
  VolumeStore::build(path, series.source(0, 2));
  const std::uint64_t size = std::filesystem::file_size(path);
  std::size_t refused = 0;
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    const auto at = static_cast<std::streamoff>(random() % size);
    const char flip = static_cast<char>(1 << random() % 8);
    const auto change = [&] {
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      file.seekg(at);
      const char byte = static_cast<char>(file.get() ^ flip);
      file.seekp(at);
      file.put(byte);
    };
    change();
    try {
      VolumeStore store = VolumeStore::open(path);
      EXPECT_FALSE(store.verify().problems.empty()) << "flipped a bit of byte " << at;
      EXPECT_EQ(restored_numbers(store), series.steps) << "flipped a bit of byte " << at;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("numbers.adm"), std::string::npos) << error.what();
      ++refused;
    }
    change();
  }
  EXPECT_GT(refused, 100u);
}

/// The remainders of the first step are the first bytes behind the prologue.
TEST(StoredNumbers, ThatAreDamagedAreThoseOfTheirStepAlone) {
  const Scratch scratch;
  const auto path = scratch / "numbers.adm";
  NumberSeries series(StoredType::kFloat64, 2);
  VolumeStore::build(path, series.source(0, 2));
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(40);
  file.write("damaged", 7);
  file.close();
  VolumeStore store = VolumeStore::open(path);
  EXPECT_EQ(store.damaged_steps({0, 1}), std::vector<std::uint32_t>{0});
  EXPECT_EQ(store.restore({}, 0).samples, samples_of(series.type, series.steps[0]));
  Bytes second;
  store.restore_numbers({1, 1}, {}, [&second](std::uint32_t, std::span<const std::byte> plane) {
    second.insert(second.end(), plane.begin(), plane.end());
  });
  EXPECT_EQ(second, series.steps[1]);
}

TEST(StoredNumbers, OfAnotherTypeOrArrayAreNotAppended) {
  const Scratch scratch;
  const auto path = scratch / "numbers.adm";
  NumberSeries series(StoredType::kFloat64, 2), others(StoredType::kInt32, 2);
  VolumeStore::build(path, series.source(0, 1));
  const auto refused = [&](const SeriesSource& source) -> std::string {
    try {
      VolumeStore::append(path, source);
      return {};
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_NE(refused(others.source(1, 2)).find("expected numbers of type float64 as it has, found int32"),
            std::string::npos);
  SeriesSource renamed = series.source(1, 2);
  renamed.array = "even";
  EXPECT_NE(refused(renamed).find("expected the array 'odd' as it has, found 'even'"), std::string::npos);
  EXPECT_EQ(refused(series.source(1, 2)), "");
}

/// Files of all types go into stores, and come back from them in all formats of volumes, bit for bit.
TEST(StoredNumbers, OfFilesComeBackInFiles) {
  const Scratch scratch;
  for (const StoredType type : kWideTypes) {
    const auto name = to_string(type);
    const Bytes numbers = odd_bytes(type, 19 * 13 * 21, 7);
    const auto raw = scratch / (name + ".raw"), store = scratch / (name + ".adm");
    std::ofstream(raw, std::ios::binary)
        .write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(numbers.size()));
    OutputSet outputs;
    StoreRequest request;
    request.inputs = {raw.string()};
    request.input.raw.dimensions = kDimensions;
    request.input.raw.type = type;
    request.output = store;
    EXPECT_EQ(store_files(request, outputs).numbers, type);
    outputs.commit();
    for (const char* extension : {".nrrd", ".nhdr", ".mha", ".vti", ".nii", ".nii.gz", ".zarr"}) {
      SCOPED_TRACE(name + extension);
      RestoreRequest back;
      back.store = store;
      back.output = scratch / (name + "_back" + extension);
      OutputSet files;
      const RestoreReport report = restore_files(back, files);
      EXPECT_EQ(report.written, type);
      if (report.folder) report.folder->commit();
      files.commit();
      io::VolumeReader reader = io::open_volume(back.output);
      EXPECT_EQ(reader.source().stored, type);
      Bytes found(numbers.size());
      reader.read_stored(0, found);
      EXPECT_EQ(found, numbers);
    }
  }
}

}  // namespace
}  // namespace adamas
