#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/io/volume_reader.h"
#include "tests/io/written_bytes.h"
#include "tests/support/scratch.h"

namespace adamas::test {

using namespace io;

inline std::vector<std::byte> read_all(VolumeReader& reader) {
  const VolumeGrid& grid = reader.grid();
  std::vector<std::byte> samples(grid.plane_bytes() * grid.dimensions[2]);
  // Planes may be read in any order, and here are read backwards.
  for (std::uint64_t k = grid.dimensions[2]; k-- > 0;) {
    reader.read_plane(k, std::span(samples).subspan(k * grid.plane_bytes(), grid.plane_bytes()));
  }
  return samples;
}

template <class T>
std::vector<T> read_as(VolumeReader& reader) {
  EXPECT_EQ(sizeof(T), sample_bytes(reader.grid().type));
  const auto bytes = read_all(reader);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Returns all samples of a volume of any type as doubles.
inline std::vector<double> read_numbers(VolumeReader& reader) {
  const auto bytes = read_all(reader);
  std::vector<double> numbers;
  visit_stored_type(stored_type(reader.grid().type), [&]<class T>(T value) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
      std::memcpy(&value, bytes.data() + at, sizeof(T));
      numbers.push_back(static_cast<double>(value));
    }
  });
  return numbers;
}

/// Returns twelve numbers that every type of samples holds, including the ends of its range (for floats, of
/// their whole numbers).
template <class T>
std::vector<T> typical_values() {
  std::vector<T> values{0, 1, 2, 3, 50, 60, 70, 80, 90, 100, 127, std::numeric_limits<T>::max()};
  if constexpr (sizeof(T) > 2) values.back() = 16777216;
  if constexpr (std::numeric_limits<T>::is_signed) values[1] = -5;
  return values;
}

template <class T>
std::vector<double> as_doubles(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

constexpr StoredType kStoredTypes[] = {
    StoredType::kInt8,   StoredType::kUint8, StoredType::kInt16,  StoredType::kUint16,  StoredType::kInt32,
    StoredType::kUint32, StoredType::kInt64, StoredType::kUint64, StoredType::kFloat32, StoredType::kFloat64};

enum class Wrapping { kNone = -15, kZlib = 15, kGzip = 31 };

inline std::string deflated(const std::string& bytes, Wrapping wrapping) {
  z_stream zip{};
  deflateInit2(&zip, 6, Z_DEFLATED, static_cast<int>(wrapping), 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&zip, bytes.size()) + 32, '\0');
  zip.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zip.avail_in = static_cast<uInt>(bytes.size());
  zip.next_out = reinterpret_cast<Bytef*>(out.data());
  zip.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&zip, Z_FINISH), Z_STREAM_END);
  out.resize(zip.total_out);
  deflateEnd(&zip);
  return out;
}

inline std::string bzipped(const std::string& bytes) {
  std::string out(bytes.size() + bytes.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(out.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                                     static_cast<unsigned>(bytes.size()), 9, 0, 0),
            BZ_OK);
  out.resize(size);
  return out;
}

/// Returns the message of the Error that is thrown when the volume is opened and its planes are read.
inline std::string message_of_volume(const std::filesystem::path& path, const VolumeOptions& options = {}) {
  return error_of([&] {
    VolumeReader reader = open_volume(path, options);
    read_all(reader);
  });
}

/// Expects that truncating a file to `least`, `least` + `step`, ... bytes below `end` is an error of one line
/// that names it.
inline void expect_every_truncation_is_an_error(const std::filesystem::path& opened,
                                                const std::filesystem::path& cut, std::size_t end,
                                                std::size_t step = 1, std::size_t least = 0) {
  const std::string whole = bytes_of(cut);
  ASSERT_LE(end, whole.size());
  for (std::size_t length = least; length < end; length += step) {
    put_bytes(cut, whole.substr(0, length));
    const std::string message = message_of_volume(opened);
    EXPECT_TRUE(says(message, "expected")) << length;
    EXPECT_TRUE(says(message, cut.parent_path().string())) << length;
  }
  put_bytes(cut, whole);
}

}  // namespace adamas::test
