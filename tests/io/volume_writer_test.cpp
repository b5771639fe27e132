// Tests the output of VolumeWriter, read back by the readers of grid files (VTK's, and that of NRRD).

#include "core/io/volume_writer.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/io/grid_file.h"
#include "core/io/input_file.h"
#include "core/io/volume_reader.h"
#include "tests/io/volume_samples.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;

double value_at(const std::vector<std::byte>& samples, SampleType type, std::size_t at) {
  const auto get = [&]<class T>(T value) {
    std::memcpy(&value, samples.data() + at * sizeof(T), sizeof(T));
    return static_cast<double>(value);
  };
  switch (type) {
    case SampleType::kUint8:
      return get(std::uint8_t{});
    case SampleType::kUint16:
      return get(std::uint16_t{});
    case SampleType::kInt16:
      return get(std::int16_t{});
    case SampleType::kFloat32:
      return get(float{});
  }
  return 0;
}

void expect_read_back(const std::filesystem::path& path, const VolumeGrid& grid,
                      const std::vector<std::byte>& samples, double tolerance = 1e-12) {
  GridFile file = read_grid_file(path);
  ASSERT_EQ(file.arrays.size(), 1u) << path;
  EXPECT_EQ(file.arrays[0].type, sample_name(grid.type)) << path;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& nodes = file.nodes[static_cast<std::size_t>(axis)];
    ASSERT_EQ(nodes.size(), grid.dimensions[static_cast<std::size_t>(axis)]) << path;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double expected = grid.origin[axis] + static_cast<double>(i) * grid.spacing[axis];
      EXPECT_NEAR(nodes[i], expected, tolerance * (std::abs(expected) + grid.spacing[axis])) << path;
    }
  }
  const std::vector<float> values = file.arrays[0].take_floats();
  ASSERT_EQ(values.size(), grid.samples());
  for (std::size_t at = 0; at < values.size(); ++at) {
    ASSERT_EQ(values[at], value_at(samples, grid.type, at)) << path << " at " << at;
  }
}

TEST(VolumeWriter, OtherReadersFindEverySample) {
  for (const VolumeGrid& grid : test::sample_grids()) {
    const test::Scratch scratch;
    const auto samples = test::random_samples(grid);
    for (const char* name : {"a.vti", "b.nrrd", "c.nhdr", "d.mha", "e.mhd"}) {
      test::write_volume(scratch / name, grid, samples);
      expect_read_back(scratch / name, grid, samples);
    }
    // NIfTI states places in single precision.
    for (const char* name : {"g.nii", "h.nii.gz"}) {
      test::write_volume(scratch / name, grid, samples);
      expect_read_back(scratch / name, grid, samples, 1e-6);
    }
    test::write_volume(scratch / "f.raw", grid, samples);
    const std::string all(reinterpret_cast<const char*>(samples.data()), samples.size());
    for (const char* name : {"c.raw", "e.raw", "f.raw"}) {
      EXPECT_EQ(test::bytes_of(scratch / name), all) << name;
    }
    EXPECT_EQ(scratch.entries(), 10);
  }
}

TEST(VolumeWriter, FilesGetTheirNamesTogetherAtTheEnd) {
  const VolumeGrid grid{{2, 2, 3}, SampleType::kUint8, {1, 1, 1}, {}};
  const auto samples = test::random_samples(grid);
  const test::Scratch scratch;
  {
    VolumeWriter writer(scratch / "a.nhdr", grid);
    writer.write_plane(test::plane_of(samples, grid, 0));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.nhdr"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.raw"));
  }
  EXPECT_EQ(scratch.entries(), 0) << "what is not finished is gone";
}

TEST(VolumeWriter, ADataFileOfAnotherName) {
  const VolumeGrid grid{{2, 2, 3}, SampleType::kUint16, {1, 1, 1}, {}};
  const auto samples = test::random_samples(grid);
  const test::Scratch scratch;
  test::write_volume(scratch / "a.mhd", grid, samples, {"", scratch / "t.bin", "s 1.bin", {}});
  std::filesystem::rename(scratch / "t.bin", scratch / "s 1.bin");
  expect_read_back(scratch / "a.mhd", grid, samples);
}

TEST(VolumeWriter, NamesOfArraysAreQuoted) {
  const VolumeGrid grid{{2, 1, 1}, SampleType::kUint8, {1, 1, 1}, {}};
  const test::Scratch scratch;
  test::write_volume(scratch / "a.vti", grid, test::random_samples(grid), {"a<\"b\">&c", {}, {}, {}});
  EXPECT_EQ(read_grid_file(scratch / "a.vti").array_names(), "'a<\"b\">&c'");
}

TEST(VolumeWriter, SeveralArraysHaveScalesOfTheirOwn) {
  const VolumeGrid grid{{5, 4, 3}, SampleType::kUint16, {1, 2, 3}, {4, 5, 6}};
  const test::Scratch scratch;
  const auto first = test::random_samples(grid);
  auto second = first;
  std::reverse(second.begin(), second.end());
  const auto planes_of = [&grid](const std::vector<std::byte>& samples) {
    return [&](std::uint64_t k) {
      return std::span(samples).subspan(k * grid.plane_bytes(), grid.plane_bytes());
    };
  };
  const auto path = scratch / "a.vti";
  write_point_arrays(path, grid,
                     {{"plain", 1, 0, planes_of(first)}, {"scaled", 0.125, -3, planes_of(second)}});
  GridFile file = read_grid_file(path);
  EXPECT_EQ(file.array_names(), "'plain', 'scaled'");
  const auto plain = file.arrays[0].take_floats(), scaled = file.arrays[1].take_floats();
  VolumeReader kept = open_volume(path, {"scaled", {}, {}, true});
  EXPECT_EQ(kept.grid().type, SampleType::kUint16);
  EXPECT_EQ(kept.grid().slope, 0.125);
  EXPECT_EQ(kept.grid().intercept, -3);
  std::vector<std::byte> plane(grid.plane_bytes());
  kept.read_plane(2, plane);
  EXPECT_TRUE(
      std::equal(plane.begin(), plane.end(), second.end() - static_cast<std::ptrdiff_t>(plane.size())));
  for (std::size_t at = 0; at < grid.samples(); ++at) {
    EXPECT_EQ(plain[at], value_at(first, grid.type, at));
    EXPECT_EQ(scaled[at], 0.125 * value_at(second, grid.type, at) - 3);
  }
}

TEST(VolumeWriter, ScalesThatAreNoneAreBadInput) {
  const VolumeGrid grid{{2, 2, 2}, SampleType::kUint8, {1, 1, 1}, {}};
  const test::Scratch scratch;
  const std::vector<std::byte> samples(8);
  write_point_arrays(scratch / "a.vti", grid,
                     {{"v", 0.5, 1, [&](std::uint64_t k) { return std::span(samples).subspan(4 * k, 4); }}});
  const std::string text = read_file(scratch / "a.vti");
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(scratch / "b.vti", std::ios::binary) << changed;
    return error_of([&] { open_volume(scratch / "b.vti"); });
  };
  for (const char* slope : {"0", "-1", "nan", "inf", "x", ""}) {
    const std::string attribute = "slope=\"" + std::string(slope) + "\"";
    EXPECT_TRUE(says(message("slope=\"0.5\"", attribute), "b.vti: slope: expected")) << slope;
  }
  EXPECT_TRUE(says(message("intercept=\"1\"", "intercept=\"inf\""), "b.vti: intercept: expected"));
  EXPECT_TRUE(says(message(" intercept=\"1\"", ""), "b.vti: intercept: expected 1 numbers"));
}

TEST(VolumeWriter, WhatCannotBeWrittenIsRefused) {
  const test::Scratch scratch;
  const auto message = [&scratch](const std::string& name, VolumeGrid grid) {
    return error_of([&] { VolumeWriter(scratch / name, grid); });
  };
  const VolumeGrid good{{2, 2, 2}, SampleType::kUint8, {1, 1, 1}, {}};
  EXPECT_TRUE(
      says(message("a.png", good), "a.png: expected .vti, .nrrd, .nhdr, .mha, .mhd, .nii, .nii.gz or .raw"));
  EXPECT_TRUE(says(message("none/a.vti", good), "expected an existing output folder"));
  EXPECT_TRUE(says(message("%.nhdr", good), "name a header can hold, found '%.raw'"));
  EXPECT_TRUE(says(message("LIST.mhd", good), "name a header can hold, found 'LIST.raw'"));
  VolumeGrid bad = good;
  bad.dimensions = {1, 0, 1};
  EXPECT_TRUE(says(message("a.vti", bad), "expected at least one sample along each axis"));
  bad.dimensions = {1ull << 62, 8, 8};
  EXPECT_TRUE(says(message("a.vti", bad), "at most 2^59 in all, found 4611686018427387904 x 8 x 8"));
  bad.dimensions = {1ull << 32, 1, 1};
  EXPECT_TRUE(says(message("a.vti", bad), "at most 2147483647 samples along each axis of a .vti"));
  bad.dimensions = {1ull << 20, 1ull << 20, 1ull << 19};
  EXPECT_TRUE(says(message("a.raw", bad), "a.raw: expected 576460752303423488 bytes of room"));
  for (const double step : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    bad = good;
    bad.spacing.y = step;
    EXPECT_TRUE(says(message("a.vti", bad), "a.vti: expected a positive spacing along y"));
    bad = good;
    bad.origin.z = -HUGE_VAL;
    EXPECT_TRUE(says(message("a.vti", bad), "a.vti: expected a finite origin along z"));
  }
  EXPECT_EQ(scratch.entries(), 0);
}

}  // namespace
}  // namespace adamas
