// Tests volumes that libraries read in a child process: HDF5 and legacy VTK.

#define H5_USE_110_API
#include <hdf5.h>

#include "tests/io/volume_files.h"
#include "tests/support/hdf5_file.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::Hdf5File;
using test::message_of_volume;
using test::put_bytes;
using test::read_numbers;
using test::says;

TEST(Hdf5Volume, EveryTypeInEitherByteOrderAndInChunks) {
  const test::Scratch scratch;
  for (const StoredType type : test::kStoredTypes) {
    visit_stored_type(type, [&]<class T>(T) {
      const auto values = test::typical_values<T>();
      for (const bool big : {false, true}) {
        for (const std::uint64_t chunk : {0, 1, 2}) {
          {
            Hdf5File file(scratch / "a.h5");
            file.add("group/samples", {2, 2, 3}, type, values.data(), chunk, big);
            file.add_numbers("group/samples", "element_size_um", {3, 2, 0.5});
          }
          VolumeReader reader = open_volume(scratch / "a.h5");
          EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 2}));
          EXPECT_EQ(reader.grid().spacing, (Vec3{0.5, 2, 3}));
          EXPECT_EQ(reader.grid().type, sample_type_for(type));
          EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << stored_name(type) << chunk;
        }
      }
    });
  }
}

TEST(Hdf5Volume, ChosenByName) {
  const test::Scratch scratch;
  const auto first = test::typical_values<std::uint8_t>();
  const std::vector<std::uint8_t> second(12, 7);
  {
    Hdf5File file(scratch / "a");
    file.add("first", {2, 2, 3}, StoredType::kUint8, first.data());
    file.add("deep/second", {2, 2, 3}, StoredType::kUint8, second.data());
    file.add("flat", {4, 3}, StoredType::kUint8, second.data());
    file.add("empty", {2, 2, 3}, StoredType::kUint8, nullptr);
    file.add("endless", {1u << 20, 1u << 20, 1u << 10}, StoredType::kUint8, nullptr, 16);
  }
  VolumeReader reader = open_volume(scratch / "a", {"deep/second", {}});
  EXPECT_EQ(read_numbers(reader), std::vector<double>(12, 7));
  const auto message = [&](const std::string& name) { return message_of_volume(scratch / "a", {name, {}}); };
  EXPECT_TRUE(says(message(""),
                   "a: expected the name of a data set, found 'deep/second', 'empty', 'endless', 'first'"));
  EXPECT_TRUE(says(message("third"), "expected a data set 'third', found 'deep/second'"));
  EXPECT_TRUE(says(message("flat"), "flat: expected samples along three axes, found 2"));
  EXPECT_TRUE(says(message("deep"), "deep: expected a data set, found none"));
  EXPECT_TRUE(says(message("empty"), "empty: expected samples, found a data set without any"));
  EXPECT_TRUE(says(message("endless"), "endless: expected samples, found a data set without any"));
}

TEST(Hdf5Volume, MoreSamplesThanAFileCanHold) {
  const test::Scratch scratch;
  {
    // Of very many chunks only one is in the file.
    Hdf5File file(scratch / "a.h5");
    const std::uint8_t value = 1;
    file.add("small", {1, 1, 1}, StoredType::kUint8, &value);
  }
  const hid_t file = H5Fopen((scratch / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hsize_t size[] = {1u << 20, 1u << 20, 1u << 10}, chunk[] = {4, 4, 4}, one[] = {1, 1, 1},
                at[] = {0, 0, 0};
  const hid_t space = H5Screate_simple(3, size, nullptr), memory = H5Screate_simple(3, one, nullptr);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(how, 3, chunk);
  const hid_t set = H5Dcreate2(file, "large", H5T_STD_U8LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, at, nullptr, one, nullptr);
  const std::uint8_t value = 1;
  H5Dwrite(set, H5T_NATIVE_UINT8, memory, space, H5P_DEFAULT, &value);
  H5Dclose(set);
  H5Pclose(how);
  H5Sclose(memory);
  H5Sclose(space);
  H5Fclose(file);
  EXPECT_TRUE(says(
      message_of_volume(scratch / "a.h5", {"large", {}}),
      "a.h5: expected 1125899906842624 bytes for 1024 x 1048576 x 1048576 samples of uint8, found a file"));
}

TEST(Hdf5Volume, SamplesInOtherFilesAreRefused) {
  const test::Scratch scratch;
  test::put_bytes(scratch / "secret", std::string(64, 's'));
  const hid_t file = H5Fcreate((scratch / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size[] = {4, 4, 4};
  const hid_t space = H5Screate_simple(3, size, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(how, (scratch / "secret").c_str(), 0, 64);
  H5Dclose(H5Dcreate2(file, "v", H5T_STD_U8LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
  H5Pclose(how);
  H5Sclose(space);
  H5Fclose(file);
  EXPECT_TRUE(says(message_of_volume(scratch / "a.h5", {"v", {}}),
                   "a.h5: v: expected samples in the file itself, found them in others"));
}

/// Stops the work after some reports.
class Impatient final : public Progress {
 public:
  void report(std::string_view, double) override { ++reports_; }
  [[nodiscard]] bool cancelled() const override { return reports_ >= 3; }

 private:
  int reports_ = 0;
};

TEST(Hdf5Volume, CanBeCancelled) {
  const test::Scratch scratch, unpacked;
  const std::vector<std::uint8_t> values(64'000'000);
  Hdf5File(scratch / "a.h5").add("v", {400, 400, 400}, StoredType::kUint8, values.data(), 100);
  Impatient progress;
  EXPECT_THROW(open_volume(scratch / "a.h5", {{}, unpacked.folder()}, progress), Cancelled);
  EXPECT_EQ(unpacked.entries(), 0);
  EXPECT_EQ(open_volume(scratch / "a.h5").grid().samples(), values.size());
}

TEST(Hdf5Volume, TruncationAndOtherBytesAreErrors) {
  const test::Scratch scratch;
  const auto values = test::typical_values<std::uint16_t>();
  Hdf5File(scratch / "a.h5").add("v", {2, 2, 3}, StoredType::kUint16, values.data(), 2);
  const auto size = std::filesystem::file_size(scratch / "a.h5");
  test::expect_every_truncation_is_an_error(scratch / "a.h5", scratch / "a.h5", size, 73);
  const std::string whole = test::bytes_of(scratch / "a.h5");
  for (std::size_t at = 8; at < whole.size(); at += 89) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0xff);
    put_bytes(scratch / "a.h5", changed);
    try {
      VolumeReader reader = open_volume(scratch / "a.h5");
      test::read_all(reader);
    } catch (const Error& error) {
      EXPECT_TRUE(says(error.what(), "a.h5")) << at;
    }
  }
}

std::string legacy(const std::string& grid, const std::string& data) {
  return "# vtk DataFile Version 3.0\nmade here\nBINARY\nDATASET " + grid + "POINT_DATA 12\n" + data;
}
const std::string kPoints = "STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nSPACING 1 2 3\nORIGIN 4 5 6\n";

TEST(LegacyVtkVolume, TypesThatItHas) {
  const test::Scratch scratch;
  const auto expect_type = [&]<class T>(const char* name, StoredType becomes, T) {
    const auto values = test::typical_values<T>();
    put_bytes(scratch / "a.vtk",
              legacy(kPoints, std::string("SCALARS v ") + name + "\nLOOKUP_TABLE default\n" +
                                  bytes_of_values(values, true) + "\n"));
    VolumeReader reader = open_volume(scratch / "a.vtk");
    EXPECT_EQ(reader.source().stored, becomes) << name;
    EXPECT_EQ(reader.grid().spacing, (Vec3{1, 2, 3}));
    EXPECT_EQ(reader.grid().origin, (Vec3{4, 5, 6}));
    EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << name;
    return reader.note();
  };
  expect_type("unsigned_char", StoredType::kUint8, std::uint8_t{});
  expect_type("short", StoredType::kInt16, std::int16_t{});
  expect_type("unsigned_short", StoredType::kUint16, std::uint16_t{});
  expect_type("int", StoredType::kInt32, std::int32_t{});
  EXPECT_EQ(expect_type("float", StoredType::kFloat32, float{}), "");
  EXPECT_TRUE(
      says(expect_type("double", StoredType::kFloat64, double{}), "float64 samples are read as float32"));
}

TEST(LegacyVtkVolume, ArraysAndGridsOfOtherKinds) {
  const test::Scratch scratch;
  const std::string bytes = "abcdefghijkl", table = "\nLOOKUP_TABLE default\n";
  const std::string scalars = "SCALARS v unsigned_char" + table + bytes + "\n";
  const std::string vectors = "VECTORS w unsigned_char\n" + bytes + bytes + bytes + "\n";
  put_bytes(scratch / "a.vtk", legacy(kPoints, scalars + vectors));
  EXPECT_EQ(open_volume(scratch / "a.vtk").grid().samples(), 12u) << "the only one of one value";
  EXPECT_TRUE(says(message_of_volume(scratch / "a.vtk", {"w", {}}),
                   "array 'w': expected one value per sample, found 3"));
  EXPECT_TRUE(says(message_of_volume(scratch / "a.vtk", {"x", {}}),
                   "expected an array 'x' on points, found 'v', 'w'"));
  const std::string axes = "Y_COORDINATES 2 float\n" + bytes_of_values(std::vector<float>{0, 1}, true) +
                           "\nZ_COORDINATES 2 float\n" + bytes_of_values(std::vector<float>{0, 1}, true) +
                           "\n";
  const auto rectilinear = [&](std::vector<float> x) {
    put_bytes(scratch / "b.vtk", legacy("RECTILINEAR_GRID\nDIMENSIONS 3 2 2\nX_COORDINATES 3 float\n" +
                                            bytes_of_values(x, true) + "\n" + axes,
                                        scalars));
  };
  rectilinear({1, 3, 5});
  EXPECT_EQ(open_volume(scratch / "b.vtk").grid().spacing, (Vec3{2, 1, 1}));
  rectilinear({1, 2, 5});
  EXPECT_TRUE(says(message_of_volume(scratch / "b.vtk"),
                   "expected even spacing along x, found a sample at 2 instead of 3"));
  const std::string whole = legacy(kPoints, scalars);
  for (std::size_t length = 0; length < whole.size() - 1; length += 5) {
    put_bytes(scratch / "a.vtk", whole.substr(0, length));
    EXPECT_TRUE(says(message_of_volume(scratch / "a.vtk"), "a.vtk: ")) << length;
  }
}

}  // namespace
}  // namespace adamas
