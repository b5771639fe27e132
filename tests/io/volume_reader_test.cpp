// Tests VolumeReader: round trips of every type and format, and files of other programs.

#include "core/io/volume_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/io/volume_files.h"
#include "tests/io/volume_samples.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::put_bytes;
using test::read_all;
using test::read_as;

RawVolume raw_volume(const VolumeGrid& grid) {
  RawVolume raw;
  raw.dimensions = grid.dimensions;
  raw.type = *find_stored_type(sample_name(grid.type));
  raw.spacing = grid.spacing;
  raw.origin = grid.origin;
  return raw;
}

void expect_same_grid(const VolumeGrid& found, const VolumeGrid& expected, const std::string& name) {
  EXPECT_EQ(found.dimensions, expected.dimensions) << name;
  EXPECT_EQ(found.type, expected.type) << name;
  EXPECT_EQ(found.spacing, expected.spacing) << name;
  EXPECT_EQ(found.origin, expected.origin) << name;
}

TEST(VolumeReader, ReadsWhatTheWriterWrites) {
  for (const VolumeGrid& grid : test::sample_grids()) {
    const test::Scratch scratch;
    const auto samples = test::random_samples(grid);
    for (const std::string name : {"a.vti", "b.nrrd", "c.nhdr", "d.mha", "e.mhd"}) {
      test::write_volume(scratch / name, grid, samples);
      VolumeReader reader = open_volume(scratch / name);
      expect_same_grid(reader.grid(), grid, name);
      EXPECT_EQ(read_all(reader), samples) << name;
      EXPECT_EQ(reader.note(), "");
    }
    test::write_volume(scratch / "f.raw", grid, samples);
    VolumeReader reader = open_raw_volume(scratch / "f.raw", raw_volume(grid));
    expect_same_grid(reader.grid(), grid, "f.raw");
    EXPECT_EQ(read_all(reader), samples);
  }
}

TEST(VolumeReader, BigEndianFilesAndBytesToSkip) {
  const test::Scratch scratch;
  const std::vector<std::uint16_t> values{1, 256, 65535, 4660, 0, 513};
  RawVolume raw;
  raw.dimensions = {3, 1, 2};
  raw.type = StoredType::kUint16;
  raw.big_endian = true;
  raw.header_bytes = 5;
  put_bytes(scratch / "a.raw", "12345" + bytes_of_values(values, true));
  VolumeReader plain = open_raw_volume(scratch / "a.raw", raw);
  EXPECT_EQ(read_as<std::uint16_t>(plain), values);

  const std::string nrrd = "NRRD0004\ntype: ushort\nendian: big\nencoding: raw\nsizes: 3 1 2\n";
  put_bytes(scratch / "b.nrrd",
            nrrd + "line skip: 2\nbyte skip: 3\n\na\nb\nxyz" + bytes_of_values(values, true));
  put_bytes(scratch / "c.nhdr", nrrd + "byte skip: -1\ndata file: a.raw\n");
  put_bytes(scratch / "d.nhdr", nrrd + "byte skip: 5\ndata file: a.raw");
  const std::string meta =
      "ObjectType = Image\r\nNDims = 3\r\nDimSize = 3 1 2\r\nElementType = MET_USHORT\r\n"
      "BinaryDataByteOrderMSB = True\r\n";
  put_bytes(scratch / "e.mhd", meta + "HeaderSize = -1\nElementDataFile = a.raw");
  put_bytes(scratch / "f.mhd", meta + "HeaderSize = 5\nElementDataFile = a.raw\n");
  put_bytes(scratch / "g.mha", meta + "ElementDataFile = LOCAL\n" + bytes_of_values(values, true));
  for (const char* name : {"b.nrrd", "c.nhdr", "d.nhdr", "e.mhd", "f.mhd", "g.mha"}) {
    VolumeReader reader = open_volume(scratch / name);
    EXPECT_EQ(read_as<std::uint16_t>(reader), values) << name;
  }
}

/// Returns a .vti as other programs write it.
std::string vti(const std::string& attributes, const std::string& arrays, const std::string& appended,
                const std::string& image = "WholeExtent=\"2 4 0 0 -1 0\" Origin=\"1 0 0\" Spacing=\"2 1 4\"",
                const std::string& piece = "2 4 0 0 -1 0") {
  return "<?xml version='1.0'?><!-- <none> -->\n<VTKFile type=\"ImageData\" " + attributes +
         ">\n<ImageData " + image + ">\n<Piece Extent=\"" + piece + "\">\n" + arrays +
         "</Piece></ImageData>\n<AppendedData encoding=\"raw\">\n  _" + appended +
         "\n</AppendedData>\n</VTKFile>\n";
}

template <class Count>
std::string counted(const std::string& bytes, bool big_endian = false) {
  return bytes_of_values(std::vector<Count>{static_cast<Count>(bytes.size())}, big_endian) + bytes;
}

TEST(VolumeReader, VtiOfOtherPrograms) {
  const test::Scratch scratch;
  const std::vector<float> values{1, 2.5f, -3, 4, 5e9f, 6};
  const std::string other = counted<std::uint32_t>("abcdef", true);
  const std::string arrays =
      "<PointData Scalars=\"second\">\n<DataArray type='Int8' Name='first' format='appended' offset='0'/>\n"
      "<DataArray Name=\"second\" type=\"Float32\" NumberOfComponents=\"1\" format=\"appended\"\n "
      "offset=\"10\">\n"
      "</DataArray></PointData><CellData>\n"
      "<DataArray type='Int8' Name='cells' format='appended' offset='0'/></CellData>\n";
  put_bytes(scratch / "a.vti", vti("byte_order='BigEndian'", arrays,
                                   other + counted<std::uint32_t>(bytes_of_values(values, true), true)));
  VolumeReader reader = open_volume(scratch / "a.vti");
  EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 1, 2}));
  EXPECT_EQ(reader.grid().spacing, (Vec3{2, 1, 4}));
  EXPECT_EQ(reader.grid().origin, (Vec3{5, 0, -4})) << "of the extent's first sample";
  EXPECT_EQ(read_as<float>(reader), values);
  VolumeReader first = open_volume(scratch / "a.vti", {"first", {}});
  EXPECT_EQ(read_as<std::int16_t>(first), (std::vector<std::int16_t>{97, 98, 99, 100, 101, 102}));
  EXPECT_TRUE(test::says(first.note(), "a.vti: int8 samples are read as int16, without loss"));
}

TEST(VolumeReader, SamplesStayInTheOrderOfTheFile) {
  const test::Scratch scratch;
  const std::string head = "NRRD0004\ntype: short\nencoding: raw\nsizes: 3 2 2\nspace origin: (10,20,30)\n";
  const std::vector<std::int16_t> values{0, 1, 2, 10, 11, 12, 100, 101, 102, 110, 111, 112};
  const auto read = [&](const std::string& directions) {
    put_bytes(scratch / "a.nrrd",
              head + "space directions: " + directions + "\n\n" + bytes_of_values(values));
    return open_volume(scratch / "a.nrrd");
  };
  VolumeReader x = read("(-2,0,0) (0,1,0) (0,0,1)");
  EXPECT_EQ(x.grid().spacing, (Vec3{2, 1, 1}));
  EXPECT_EQ(x.grid().directions, (std::array<Vec3, 3>{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
  EXPECT_EQ(x.grid().origin, (Vec3{10, 20, 30}));
  EXPECT_EQ(x.grid().box().min, (Vec3{6, 20, 30}));
  EXPECT_EQ(read_as<std::int16_t>(x), values);
  VolumeReader exchanged = read("(0,0,-0.5) (3,0,0) (0,1,0)");
  EXPECT_EQ(exchanged.grid().spacing, (Vec3{0.5, 3, 1}));
  EXPECT_EQ(exchanged.grid().directions, (std::array<Vec3, 3>{{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(read_as<std::int16_t>(exchanged), values);
  EXPECT_TRUE(test::says(test::error_of([&] { read("(0,1,0) (0,2,0) (0,0,1)"); }),
                         "a.nrrd: expected axes that are not in one plane, found (0, 1, 0), (0, 1, 0) and"));
  EXPECT_TRUE(test::says(test::error_of([&] { read("(0,0,0) (0,2,0) (0,0,1)"); }),
                         "a.nrrd: expected a positive spacing along x, found 0"));
}

template <class T>
VolumeReader open_values(const test::Scratch& scratch, StoredType type, const std::vector<T>& values) {
  RawVolume raw;
  raw.dimensions = {values.size(), 1, 1};
  raw.type = type;
  put_bytes(scratch / "v.raw", bytes_of_values(values));
  return open_raw_volume(scratch / "v.raw", raw);
}

TEST(VolumeReader, OtherTypesAreConvertedAndTheLossIsTold) {
  const test::Scratch scratch;
  auto small = open_values<std::int8_t>(scratch, StoredType::kInt8, {-128, 127});
  EXPECT_EQ(read_as<std::int16_t>(small), (std::vector<std::int16_t>{-128, 127}));
  EXPECT_EQ(small.changed(), 0u);

  auto whole = open_values<std::int32_t>(scratch, StoredType::kInt32, {-5, 16777216, 16777217, 2147483647});
  EXPECT_EQ(read_as<float>(whole), (std::vector<float>{-5, 16777216, 16777216, 2147483648.0f}));
  EXPECT_EQ(whole.changed(), 2u);
  EXPECT_EQ(whole.greatest_change(), 1);
  EXPECT_TRUE(
      test::says(whole.note(), "v.raw: int32 samples are read as float32, 2 of them changed, by at most 1"));

  auto unsigned_ones = open_values<std::uint32_t>(scratch, StoredType::kUint32, {7, 4294967295u});
  EXPECT_EQ(read_as<float>(unsigned_ones), (std::vector<float>{7, 4294967296.0f}));
  auto longs = open_values<std::int64_t>(scratch, StoredType::kInt64, {-3, (1ll << 40) + 1});
  EXPECT_EQ(read_as<float>(longs), (std::vector<float>{-3, 1099511627776.0f}));
  EXPECT_EQ(longs.greatest_change(), 1);
  auto longest = open_values<std::uint64_t>(scratch, StoredType::kUint64, {~0ull, 2});
  EXPECT_EQ(read_as<float>(longest), (std::vector<float>{18446744073709551616.0f, 2}));
  EXPECT_EQ(longest.changed(), 1u);
  EXPECT_EQ(longest.greatest_change(), 1);

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  auto doubles =
      open_values<double>(scratch, StoredType::kFloat64, {0.5, 0.1, 1e300, -kInfinity, std::nan("")});
  const auto read = read_as<float>(doubles);
  EXPECT_EQ(read[0], 0.5f);
  EXPECT_EQ(read[1], 0.1f);
  EXPECT_EQ(read[2], std::numeric_limits<float>::max());
  EXPECT_EQ(read[3], -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(read[4]));
  EXPECT_EQ(doubles.changed(), 2u);
  EXPECT_TRUE(test::says(doubles.note(),
                         "1 of them changed, by at most 1.49e-09, 1 beyond its range set to its ends"));
}

TEST(VolumeReader, LongRowsAreConvertedInPieces) {
  const test::Scratch scratch;
  std::vector<double> values(100'003);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  auto reader = open_values(scratch, StoredType::kFloat64, values);
  EXPECT_EQ(read_as<float>(reader), std::vector<float>(values.begin(), values.end()));
}

TEST(VolumeReader, AddressesBeyond32Bits) {
  const test::Scratch scratch;
  constexpr std::uint64_t kPlanes = std::uint64_t{1} << 32;
  RawVolume raw;
  raw.dimensions = {2, 1, kPlanes};
  raw.type = StoredType::kUint16;
  raw.header_bytes = 3;
  // The file consists of holes except for one plane near its end.
  {
    std::ofstream stream(scratch / "sparse.raw", std::ios::binary);
    stream.seekp(3 + 4 * static_cast<std::streamoff>(kPlanes - 2));
    stream << "abcdefgh";
    if (!stream.flush()) GTEST_SKIP() << "no files of 16 GiB here";
  }
  VolumeReader reader = open_raw_volume(scratch / "sparse.raw", raw);
  EXPECT_EQ(reader.grid().samples(), 2 * kPlanes);
  std::array<std::byte, 4> plane{};
  const auto text = [&plane] {
    return std::string(reinterpret_cast<const char*>(plane.data()), plane.size());
  };
  reader.read_plane(kPlanes - 2, plane);
  EXPECT_EQ(text(), "abcd");
  reader.read_plane(kPlanes - 1, plane);
  EXPECT_EQ(text(), "efgh");
  reader.read_plane(std::uint64_t{1} << 31, plane);
  EXPECT_EQ(text(), std::string(4, '\0'));
}

}  // namespace
}  // namespace adamas
