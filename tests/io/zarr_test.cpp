#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "adamas/files.h"
#include "adamas/volume_input.h"
#include "core/base/error.h"
#include "core/io/grid_file.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

/// The value of a sample.
std::uint16_t value(std::size_t t, std::size_t c, std::size_t z, std::size_t y, std::size_t x) {
  return static_cast<std::uint16_t>(10000 * t + 5000 * c + 300 * z + 20 * y + x);
}

/// Writes an image of two times, two channels and 3 x 4 x 5 samples, in raw chunks of uint16, the greatest
/// byte first; the chunk of time 1, channel 1 at (1, 1, 1) is missing.
void write_image(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  put_bytes(folder / ".zgroup", R"({"zarr_format": 2})");
  put_bytes(folder / ".zattrs", R"({"multiscales": [{"version": "0.4", "axes": [{"name": "t", "type": "time"},
    {"name": "c", "type": "channel"}, {"name": "z", "type": "space"}, {"name": "y", "type": "space"},
    {"name": "x", "type": "space"}], "datasets": [{"path": "s0", "coordinateTransformations": [
    {"type": "scale", "scale": [1, 1, 2, 0.5, 0.25]}, {"type": "translation", "translation": [0, 0, 30, 20, 10]}]}]}],
    "omero": {"channels": [{"label": "DNA"}, {"label": "actin"}]}})");
  std::filesystem::create_directories(folder / "s0");
  put_bytes(folder / "s0/.zarray", R"({"zarr_format": 2, "shape": [2, 2, 3, 4, 5], "chunks": [1, 1, 2, 3, 3],
    "dtype": ">u2", "compressor": null, "filters": null, "order": "C", "fill_value": 7,
    "dimension_separator": "/"})");
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t n = 0; n < 8; ++n) {
        const std::array<std::size_t, 3> at{n / 4, n / 2 % 2, n % 2};
        if (t == 1 && c == 1 && n == 7) continue;
        std::string bytes;
        for (std::size_t z = 0; z < 2; ++z) {
          for (std::size_t y = 0; y < 3; ++y) {
            for (std::size_t x = 0; x < 3; ++x) {
              const std::uint16_t v = value(t, c, 2 * at[0] + z, 3 * at[1] + y, 3 * at[2] + x);
              bytes += static_cast<char>(v >> 8);
              bytes += static_cast<char>(v & 255);
            }
          }
        }
        const auto place = folder / fmt::format("s0/{}/{}/{}/{}", t, c, at[0], at[1]);
        std::filesystem::create_directories(place);
        put_bytes(place / std::to_string(at[2]), bytes);
      }
    }
  }
}

TEST(OmeZarr, ChunksBecomeImagesOfTimesAndChannels) {
  const Scratch scratch;
  write_image(scratch / "cells.zarr");
  for (const std::uint64_t time : {0u, 1u}) {
    VolumeInput input;
    input.path = (scratch / "cells.zarr").string();
    input.array = "actin";
    input.time = time;
    const Volume volume = read_volume(input);
    EXPECT_EQ(volume.grid.dimensions, (std::array<std::uint64_t, 3>{5, 4, 3}));
    EXPECT_EQ(volume.grid.spacing, (Vec3{0.25, 0.5, 2}));
    EXPECT_EQ(volume.grid.origin, (Vec3{10, 20, 30}));
    ASSERT_EQ(volume.grid.type, SampleType::kUint16);
    const auto* samples = reinterpret_cast<const std::uint16_t*>(volume.samples.data());
    for (std::size_t z = 0; z < 3; ++z) {
      for (std::size_t y = 0; y < 4; ++y) {
        for (std::size_t x = 0; x < 5; ++x) {
          const bool missing = time == 1 && z > 1 && y > 2 && x > 2;
          EXPECT_EQ(samples[x + 5 * (y + 4 * z)], missing ? 7 : value(time, 1, z, y, x));
        }
      }
    }
  }
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "cells.zarr"); }), "--time (0 to 1)"));
}

TEST(OmeZarr, AnArrayAloneIsAGrid) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "a");
  put_bytes(scratch / "a/.zarray",
            R"({"zarr_format": 2, "shape": [1, 2, 2], "chunks": [1, 2, 2], "dtype": "<i8",
    "compressor": null, "filters": null, "order": "C", "fill_value": 0})");
  put_bytes(scratch / "a/0.0.0", std::string(7, '\0') + "\x40" + std::string(24, '\0'));
  const GridFile file = read_grid_file(scratch / "a");
  ASSERT_EQ(file.arrays.size(), 1u);
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(file.arrays[0].values)[0], std::int64_t{1} << 62);
}

TEST(OmeZarr, WhatIsDamagedOrOfAnotherKindIsRefusedInOneLine) {
  const Scratch scratch;
  const auto refusal = [&] { return error_of([&] { read_grid_file(scratch / "z"); }); };
  std::filesystem::create_directories(scratch / "z");
  put_bytes(scratch / "z/zarr.json", "{}");
  EXPECT_TRUE(says(refusal(), "found Zarr 3"));
  std::filesystem::remove(scratch / "z/zarr.json");
  put_bytes(scratch / "z/.zattrs", "{\"multiscales\": []}");
  EXPECT_TRUE(says(refusal(), "z: expected the metadata of OME-Zarr"));
  const auto with = [&](const char* text) {
    put_bytes(scratch / "z/.zarray", text);
    put_bytes(scratch / "z/0.0.0", "12345678");
    return refusal();
  };
  EXPECT_TRUE(says(with("{"), "as JSON"));
  EXPECT_TRUE(
      says(with(R"({"shape": [2, 2], "chunks": [2, 2], "dtype": "|u1", "order": "C"})"), "3 to 5 axes"));
  EXPECT_TRUE(
      says(with(R"({"shape": [2, 2, 2], "chunks": [2, 2, 2], "dtype": "|S9", "order": "C"})"), "'|S9'"));
  EXPECT_TRUE(says(with(R"({"shape": [2, 2, 3], "chunks": [2, 2, 3], "dtype": "|u1", "order": "C"})"),
                   "chunk 0.0.0: expected 12 bytes"));
  EXPECT_TRUE(says(with(R"({"shape": [2, 2, 2], "chunks": [2, 2, 2], "dtype": "|u1", "order": "C",
    "compressor": {"id": "blosc"}})"),
                   "chunk 0.0.0"));
  EXPECT_TRUE(says(with(R"({"shape": [2, 2, 2], "chunks": [2, 2, 2], "dtype": "|u1", "order": "C",
    "compressor": {"id": "lzma"}})"),
                   "found 'lzma'"));
  EXPECT_TRUE(
      says(with(R"({"shape": [99999999, 99999999, 2], "chunks": [1, 1, 2], "dtype": "|u1", "order": "C"})"),
           "bytes of samples"));
}

}  // namespace
}  // namespace adamas
