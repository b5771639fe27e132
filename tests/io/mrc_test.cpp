// Tests files of MRC, whose words, numbered from 1 on, are written here as the format's definition lists
// them.

#include <cmath>

#include "core/io/grid_file.h"
#include "core/io/input_formats.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::message_of_volume;
using test::put_bytes;
using test::read_numbers;
using test::says;

/// A file of 3 x 2 x 2 samples of this mode, in cells of 0.5, 2 and 3.
class Mrc {
 public:
  explicit Mrc(std::int32_t mode, bool big = false) : big_(big) {
    whole(1, {3, 2, 2, mode}).whole(8, {3, 2, 2}).real(11, {1.5f, 4, 6, 90, 90, 90}).whole(17, {1, 2, 3});
    bytes_.replace(208, 4, "MAP ");
    bytes_.replace(212, 2, big ? "\x11\x11" : "DD");
  }
  Mrc& whole(std::size_t word, const std::vector<std::int32_t>& values) { return put(word, values); }
  Mrc& real(std::size_t word, const std::vector<float>& values) { return put(word, values); }
  Mrc& text(std::size_t at, const std::string& text) {
    bytes_.replace(at, text.size(), text);
    return *this;
  }
  template <class T>
  [[nodiscard]] std::string with(const std::vector<T>& samples) const {
    return bytes_ + bytes_of_values(samples, big_);
  }

 private:
  template <class T>
  Mrc& put(std::size_t word, const std::vector<T>& values) {
    return text(4 * (word - 1), bytes_of_values(values, big_));
  }

  std::string bytes_ = std::string(1024, '\0');
  bool big_;
};

const std::vector<float> kTwelve{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

template <class T>
void expect_read(const test::Scratch& scratch, std::int32_t mode, StoredType type) {
  for (const bool big : {false, true}) {
    const auto values = test::typical_values<T>();
    for (const char* name : {"a.mrc", "a.map", "a.rec", "a.bin"}) {
      put_bytes(scratch / name, Mrc(mode, big).with(values));
      VolumeReader reader = open_volume(scratch / name);
      EXPECT_EQ(reader.source().kind, "MRC");
      EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 2}));
      EXPECT_EQ(reader.grid().spacing, (Vec3{0.5, 2, 3}));
      EXPECT_EQ(reader.grid().type, sample_type_for(type));
      EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << name << " " << mode << big;
      EXPECT_EQ(read_grid_file(scratch / name).arrays.size(), 1u);
    }
  }
}

TEST(Mrc, EveryModeInEitherByteOrder) {
  const test::Scratch scratch;
  expect_read<std::int8_t>(scratch, 0, StoredType::kInt8);
  expect_read<std::int16_t>(scratch, 1, StoredType::kInt16);
  expect_read<float>(scratch, 2, StoredType::kFloat32);
  expect_read<std::uint16_t>(scratch, 6, StoredType::kUint16);
}

TEST(Mrc, BytesOfImodHaveNoSignUnlessItSaysSo) {
  const test::Scratch scratch;
  const std::vector<std::uint8_t> values{0, 1, 2, 3, 4, 5, 6, 7, 8, 127, 128, 255};
  put_bytes(scratch / "a.mrc", Mrc(0).whole(39, {1146047817, 2}).with(values));
  VolumeReader without = open_volume(scratch / "a.mrc");
  EXPECT_EQ(read_numbers(without), test::as_doubles(values));
  put_bytes(scratch / "a.mrc", Mrc(0).whole(39, {1146047817, 3}).with(values));
  VolumeReader with = open_volume(scratch / "a.mrc");
  EXPECT_EQ(read_numbers(with).back(), -1);
}

TEST(Mrc, TheByteOrderOfFilesWithoutStamp) {
  const test::Scratch scratch;
  for (const bool big : {false, true}) {
    put_bytes(scratch / "a.mrc", Mrc(2, big).text(208, std::string(8, '\0')).with(kTwelve));
    VolumeReader reader = open_volume(scratch / "a.mrc");
    EXPECT_EQ(read_numbers(reader), test::as_doubles(kTwelve));
  }
}

/// Expects that the sample at (1, 1, 1) of the array lies at this place.
void expect_place(const test::Scratch& scratch, const Mrc& file, const Vec3& place) {
  put_bytes(scratch / "a.mrc", file.with(kTwelve));
  VolumeReader reader = open_volume(scratch / "a.mrc");
  const VolumeGrid& grid = reader.grid();
  Vec3 found = grid.origin;
  for (int a = 0; a < 3; ++a) found += grid.spacing[a] * grid.directions[static_cast<std::size_t>(a)];
  EXPECT_LT(norm(found - place), 1e-6) << found[0] << " " << found[1] << " " << found[2];
}

TEST(Mrc, PlacesOfSamples) {
  const test::Scratch scratch;
  expect_place(scratch, Mrc(2), {0.5, 2, 3});
  expect_place(scratch, Mrc(2).whole(5, {2, -1, 3}), {1.5, 0, 12});
  expect_place(scratch, Mrc(2).whole(5, {2, -1, 3}).real(50, {10, 20, 30}), {10.5, 22, 33});
  // Without steps or lengths, steps are 1; without stated axes, they are x, y and z.
  expect_place(scratch, Mrc(2).whole(8, {0, 0, 0}).whole(17, {0, 0, 0}), {1, 1, 1});
  // Columns along z, rows along x, sections along y: the starts are those of columns, rows and sections.
  expect_place(scratch, Mrc(2).whole(17, {3, 1, 2}).whole(5, {1, 0, 0}), {0.5, 2, 6});
  // A monoclinic cell: the third axis leans by 30 degrees in the plane of x and z.
  expect_place(scratch, Mrc(2).real(14, {90, 60, 90}), {0.5 + 1.5, 2, 3 * std::sqrt(0.75)});
  // A hexagonal one: the second axis stands at 120 degrees to the first.
  expect_place(scratch, Mrc(2).real(14, {90, 90, 120}), {0.5 - 1, 2 * std::sqrt(0.75), 3});
}

TEST(Mrc, VolumesOfAStackAreTimesAndExtendedHeadersAreSkipped) {
  const test::Scratch scratch;
  const std::string file = Mrc(2).whole(10, {1}).whole(23, {401, 80}).with(std::vector<char>(80, 'x'));
  put_bytes(scratch / "a.mrc", file + bytes_of_values(kTwelve));
  EXPECT_EQ(find_volume_series(scratch / "a.mrc", "").steps.size(), 2u);
  VolumeOptions options;
  options.time = 1;
  VolumeReader reader = open_volume(scratch / "a.mrc", options);
  EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 1}));
  EXPECT_EQ(read_numbers(reader), (std::vector<double>{7, 8, 9, 10, 11, 12}));
}

TEST(Mrc, WhatIsNoVolumeOfNumbers) {
  const test::Scratch scratch;
  const auto expect_message = [&](const Mrc& file, const std::string& part) {
    put_bytes(scratch / "a.mrc", file.with(kTwelve));
    const std::string message = message_of_volume(scratch / "a.mrc");
    EXPECT_TRUE(says(message, "a.mrc: ")) << message;
    EXPECT_TRUE(says(message, part)) << message;
  };
  for (const int mode : {3, 4, 12, 101, 7})
    expect_message(Mrc(mode), fmt::format("(int8, int16, float32, uint16), found {}", mode));
  expect_message(Mrc(2).whole(1, {0}), "expected an MRC file of positive sizes, found 0");
  expect_message(Mrc(2).whole(17, {1, 2, 2}), "expected the axes 1, 2 and 3 in any order, found 1, 2, 2");
  expect_message(Mrc(2).whole(24, {-1}), "expected a number of bytes of an extended header, found -1");
  expect_message(Mrc(2).whole(23, {401}).whole(10, {4}), "volumes of 4 sections each, found 2 sections");
  expect_message(Mrc(2).real(50, {NAN}), "expected an origin, found nan");
  expect_message(Mrc(2).real(14, {90, INFINITY}), "expected angles of the cell, found inf");
  expect_message(Mrc(2).real(14, {10, 90, 120}), "expected angles of a cell with a volume");
  const std::string whole = Mrc(2).with(kTwelve);
  put_bytes(scratch / "b.mrc", whole);
  test::expect_every_truncation_is_an_error(scratch / "b.mrc", scratch / "b.mrc", whole.size());
}

}  // namespace

}  // namespace adamas
