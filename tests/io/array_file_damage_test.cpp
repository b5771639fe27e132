// Tests files of arrays that HDF5 itself has written, with the right checksum, whose arrays are not as they
// should be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <functional>
#include <span>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "core/io/array_file.h"
#include "core/io/array_file_head.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using ::testing::HasSubstr;

/// An identifier of HDF5 and the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class ArrayFileDamage : public ::testing::Test {
 protected:
  /// Writes a file with what `fill` puts into it, and a head that fits.
  void write(const std::function<void(hid_t)>& fill) const {
    {
      const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
      H5Pset_userblock(creation.id(), kArrayFileHeadBytes);
      const Handle file(H5Fcreate(path().c_str(), H5F_ACC_TRUNC, creation.id(), H5P_DEFAULT), H5Fclose);
      fill(file.id());
    }
    std::ifstream in(path(), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    bytes.erase(0, kArrayFileHeadBytes);
    std::ofstream(path(), std::ios::binary)
        << array_file_head("thing", 1, bytes.size(), crc32c(std::as_bytes(std::span(bytes)))) << bytes;
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "a.h5"; }
  /// Returns the message of the error, or the number of arrays where there is none.
  [[nodiscard]] std::string found() const {
    try {
      return std::to_string(read_array_file(path(), "thing", {"x", "g/y", "n/#/z"}, 1, 1).arrays.size());
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path().string() + ": ", 0), 0u) << error.what();
      return error.what();
    }
  }
  /// Adds a data set of doubles of this size, with all its values unless there are too many.
  static void add(hid_t place, const char* name, std::vector<hsize_t> size, hid_t layout = H5P_DEFAULT,
                  hid_t type = H5T_IEEE_F64LE) {
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle set(H5Dcreate2(place, name, type, space.id(), H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose);
    ASSERT_GE(set.id(), 0);
    if (size[0] > 1000) return;
    const std::vector<double> values(1'000'000, 0.5);
    H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  [[nodiscard]] Handle chunked(hsize_t rows) const {
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, 1, &rows);
    return {layout, H5Pclose};
  }

  test::Scratch folder_;
};

TEST_F(ArrayFileDamage, WhatIsNotAskedForIsNotLookedAt) {
  write([&](hid_t file) {
    add(file, "x", {4});
    add(file, "other", {hsize_t{1} << 40}, chunked(1000).id());
    hid_t group = H5Gcreate2(file, "deep", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (int depth = 0; depth < 1000; ++depth) {
      const hid_t inner = H5Gcreate2(group, "deep", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Gclose(group);
      group = inner;
    }
    H5Gclose(group);
    H5Lcreate_external("/etc/hosts", "/", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_EQ(found(), "1");
}

TEST_F(ArrayFileDamage, NumberedArraysAreReadAsFarAsThereAreAny) {
  write([](hid_t file) {
    for (const char* name : {"n", "n/0", "n/1", "n/3"})
      H5Gclose(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    for (const char* name : {"n/0/z", "n/1/z", "n/3/z"}) add(file, name, {4});
  });
  EXPECT_EQ(found(), "2");
}

TEST_F(ArrayFileDamage, MoreValuesThanAFileCanHoldAreRefusedUnread) {
  for (const hsize_t rows : {hsize_t{1} << 27, hsize_t{1} << 40, hsize_t{1} << 62}) {
    write([&](hid_t file) { add(file, "x", {rows}, chunked(1000).id()); });
    EXPECT_THAT(found(), HasSubstr("array 'x': expected")) << rows;
    write([&](hid_t file) {
      const std::vector<hsize_t> chunk{1000, 1};
      const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_chunk(layout.id(), 2, chunk.data());
      add(file, "x", {rows, rows}, layout.id());
    });
    EXPECT_THAT(found(), HasSubstr("array 'x': expected")) << rows;
  }
  // There are many arrays, each of which is small enough.
  write([&](hid_t file) {
    add(file, "x", {hsize_t{1} << 17}, chunked(1000).id());
    H5Gclose(H5Gcreate2(file, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    add(file, "g/y", {hsize_t{1} << 22}, chunked(1000).id());
  });
  EXPECT_THAT(found(), HasSubstr("array 'g/y': expected no more values"));
}

TEST_F(ArrayFileDamage, ValuesInOtherFilesAreNotRead) {
  const std::string secret = (folder_ / "secret").string();
  std::ofstream(secret, std::ios::binary) << std::string(800, 'x');
  write([&](hid_t file) {
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_external(layout.id(), secret.c_str(), 0, 32);
    add(file, "x", {4}, layout.id());
  });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected values in the file itself"));
  write([&](hid_t file) {
    const hsize_t rows = 4;
    const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_virtual(layout.id(), space.id(), secret.c_str(), "x", space.id());
    const Handle set(H5Dcreate2(file, "x", H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, layout.id(), H5P_DEFAULT),
                     H5Dclose);
    ASSERT_GE(set.id(), 0);
  });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected values in the file itself"));
  write([&](hid_t file) { H5Lcreate_external(secret.c_str(), "/x", file, "x", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected arrays and groups in the file itself"));
  write([&](hid_t file) { H5Lcreate_external(secret.c_str(), "/", file, "g", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_THAT(found(), HasSubstr("array 'g': expected arrays and groups in the file itself"));
  write([&](hid_t file) { H5Lcreate_soft("/other", file, "x", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected arrays and groups in the file itself"));
}

TEST_F(ArrayFileDamage, OtherTypesAndFiltersAreRefused) {
  for (const hid_t type : {H5T_STD_I64LE, H5T_STD_I16LE, H5T_STD_B8LE}) {
    write([&](hid_t file) { add(file, "x", {4}, H5P_DEFAULT, type); });
    EXPECT_THAT(found(), HasSubstr("array 'x': expected "));
  }
  write([&](hid_t file) { add(file, "x", {2, 2, 2}); });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected one or two dimensions"));
  write([&](hid_t file) {
    const Handle layout = chunked(4);
    H5Pset_fletcher32(layout.id());
    add(file, "x", {4}, layout.id());
  });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected values that are shuffled or deflated"));
  write([&](hid_t file) { H5Gclose(H5Gcreate2(file, "x", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); });
  EXPECT_THAT(found(), HasSubstr("array 'x': expected one or two dimensions"));
}

}  // namespace
}  // namespace adamas
