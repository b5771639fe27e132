// Tests dumps of CTH.

#include "core/io/spy_dump.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "adamas/files.h"
#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/scratch.h"
#include "tests/support/spy_file.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;
using test::SpyFileWriter;
using test::SpyTestBlock;

/// Nodes of cells of this size.
std::vector<float> nodes_from(float first, std::size_t cells, float size) {
  std::vector<float> result;
  for (std::size_t i = 0; i <= cells; ++i) result.push_back(first + static_cast<float>(i) * size);
  return result;
}

/// A block of 4 x 4 x 4 cells.
SpyTestBlock cube(int level, const Vec3& first, float size) {
  SpyTestBlock block{level, {}};
  for (int axis = 0; axis < 3; ++axis)
    block.nodes[static_cast<std::size_t>(axis)] = nodes_from(static_cast<float>(first[axis]), 4, size);
  return block;
}

/// Values that differ in all cells; the fractions of two materials add up to less than 1.
float value_of(int variable, const Vec3& p) {
  const double at = p.x + 0.1 * p.y + 0.01 * p.z;
  if (variable == 1) return static_cast<float>(1000 * at);
  if (variable < 200) return static_cast<float>(0.4 + 0.1 * std::sin(at + variable));
  return static_cast<float>(at + variable);
}

/// Two coarse blocks beside each other along x, of which the first is refined into eight, in the files of two
/// processors.
void write_refined(const std::filesystem::path& folder, const std::string& stem, double first_time = 0) {
  SpyFileWriter writer;
  writer.value = value_of;
  writer.processors = 2;
  test::SpyTestTime zero{first_time, {cube(0, {4, 0, 0}, 1)}}, one{0, {}};
  for (int n = 0; n < 8; ++n) {
    const Vec3 first{2.0 * (n & 1), 2.0 * (n >> 1 & 1), 2.0 * (n >> 2)};
    (n < 3 ? zero : one).blocks.push_back(cube(1, first, 0.5));
  }
  one.time = zero.time;
  for (writer.processor = 0; writer.processor < 2; ++writer.processor) {
    const test::SpyTestTime& own = writer.processor == 0 ? zero : one;
    put_bytes(folder / fmt::format("{}.{}", stem, writer.processor),
              writer.run({own, {own.time + 0.5, own.blocks}}));
  }
}

/// Expects that the arrays of a mesh have the values of the middles of its cells.
void expect_values(const MeshFile& file) {
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("dump", file.points, file.face_points, file.face_ends, file.cell_ends);
  ASSERT_EQ(file.arrays.size(), 6u);
  const std::map<std::string, int> numbers{{"Pressure (Pa)", 1},
                                           {"Volume fraction of material 1", 101},
                                           {"Volume fraction of material 2", 102},
                                           {"Mass for material 1 (g)", 201},
                                           {"Mass for material 2 (g)", 202}};
  for (const GridArray& array : file.arrays) {
    const auto& values = std::get<std::vector<float>>(array.values);
    ASSERT_EQ(values.size(), mesh.cell_count());
    const auto known = numbers.find(array.name);
    if (known == numbers.end()) {
      EXPECT_EQ(array.name, "Void volume fraction");
    }
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
      Box3 box;
      for (const auto p : mesh.points_of_cell(c)) box.extend(mesh.points()[p]);
      const Vec3 middle = 0.5 * (box.min + box.max);
      const float wanted = known != numbers.end() ? value_of(known->second, middle)
                                                  : 1 - value_of(101, middle) - value_of(102, middle);
      EXPECT_NEAR(values[c], wanted, 1e-6 * std::abs(wanted) + 1e-6) << array.name;
    }
  }
}

TEST(SpyDump, FilesOfAllProcessorsAreOneMeshWithoutCopies) {
  const Scratch scratch;
  write_refined(scratch.folder(), "run");
  const auto path = scratch / "run.1";
  EXPECT_EQ(kind_by_format(path), InputKind::kCells);
  EXPECT_EQ(mesh_times(path), (std::vector<double>{0, 0.5}));
  const MeshFile file = read_mesh_file(path, 0);
  EXPECT_EQ(file.kind, "CTH dump");
  EXPECT_EQ(file.cell_ends.size(), 64u + 8 * 64);
  expect_values(file);
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("dump", file.points, file.face_points, file.face_ends, file.cell_ends);
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) sum += mesh.cell_volume(c);
  EXPECT_NEAR(sum, 2 * 64, 1e-9);
  EXPECT_EQ(read_mesh_file(scratch / "run.0", 0).points, file.points);
}

TEST(SpyDump, WhatMaterialsLeaveIsTheVoid) {
  const Scratch scratch;
  write_refined(scratch.folder(), "run");
  const MeshData data = read_mesh_data(scratch / "run.0");
  ASSERT_EQ(data.materials.size(), 3u);
  EXPECT_EQ(data.materials[MaterialId(0)], "material 1");
  EXPECT_EQ(data.materials[MaterialId(2)], "Void");
  ASSERT_EQ(data.fields.size(), 2u);
  EXPECT_EQ(data.fields[0].name, "Pressure");
  EXPECT_EQ(data.fields[1].name, "Mass");
  EXPECT_EQ(data.fields[1].unit, "g");
  EXPECT_FALSE(data.fields[1].material_values[MaterialId(1)].empty());
  EXPECT_TRUE(data.fields[1].material_values[MaterialId(2)].empty());
}

TEST(SpyDump, UnevenBlocksOfOneLevelKeepTheirNodes) {
  const Scratch scratch;
  SpyFileWriter writer;
  writer.value = value_of;
  writer.version = 105;
  const std::vector<float> left{0, 1, 1.5, 4}, right{4, 4.25, 7}, y{-1, 0, 2, 2.5}, z{3, 4, 9};
  put_bytes(scratch / "run", writer.run({{0, {{0, {right, y, z}}, {0, {left, y, z}}}}}));
  const MeshFile file = read_mesh_file(scratch / "run");
  EXPECT_EQ(file.cell_ends.size(), 5u * 3 * 2);
  expect_values(file);
  Box3 box;
  for (const Vec3& p : file.points) box.extend(p);
  EXPECT_EQ(box.min, (Vec3{0, -1, 3}));
  EXPECT_EQ(box.max, (Vec3{7, 2.5, 9}));
  // Blocks that do not fit each other are refused.
  put_bytes(scratch / "run", writer.run({{0, {{0, {right, y, z}}, {0, {left, {-1, 0.6f, 2.5}, z}}}}}));
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run"); }), "cells are those of one grid"));
}

TEST(SpyDump, FlatDumpsAreTurnedRoundTheirAxis) {
  const Scratch scratch;
  SpyFileWriter writer;
  writer.value = value_of;
  writer.geometry = 21;
  writer.version = 102;
  put_bytes(scratch / "run.0",
            writer.run({{0, {{0, {nodes_from(0, 3, 0.5), nodes_from(-1, 4, 0.25), {0}}}}}}));
  const MeshFile file = read_mesh_file(scratch / "run.0");
  EXPECT_TRUE(file.flat);
  EXPECT_EQ(file.cell_ends.size(), 12u);
  EXPECT_TRUE(says(file.remark, "--axisymmetric"));
  MaterialDataOptions options;
  options.axisymmetric = true;
  const MeshData data = read_mesh_data(scratch / "run.0", options);
  double sum = 0;
  for (const double volume : data.volumes()) sum += volume;
  EXPECT_NEAR(sum, 3.14159265358979 * 1.5 * 1.5, 1e-6);
}

TEST(SpyDump, LaterDumpsOfAListTakeThePlaceOfEarlierTimes) {
  const Scratch scratch;
  write_refined(scratch.folder(), "run");          // times 0 and 0.5
  write_refined(scratch.folder(), "again", 0.25);  // and 0.25 and 0.75
  std::ofstream(scratch / "all.spcth-timeseries") << "run.0\nagain.1\n";
  EXPECT_EQ(mesh_times(scratch / "all.spcth-timeseries"), (std::vector<double>{0, 0.25, 0.75}));
  expect_values(read_mesh_file(scratch / "all.spcth-timeseries", 1));
  std::ofstream(scratch / "all.spcth-timeseries") << "run.0\nnone.0\n";
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "all.spcth-timeseries"); }), "none.0"));
}

TEST(SpyDump, FilesThatAreMissingOrOfAnotherRunAreNamed) {
  const Scratch scratch;
  write_refined(scratch.folder(), "run");
  write_refined(scratch.folder(), "other", 3);
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run.0", 2); }), "from 0 to 1, found 2"));
  const std::string second = bytes_of(scratch / "run.1");
  put_bytes(scratch / "run.1", bytes_of(scratch / "other.1"));
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run.0"); }), "the same run"));
  put_bytes(scratch / "run.1", bytes_of(scratch / "run.0"));
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run.0"); }),
                   "expected the file of processor 1, found that of processor 0"));
  std::filesystem::remove(scratch / "run.1");
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run.0"); }), "found no 'run.1'"));
  put_bytes(scratch / "run_b", second);
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "run_b"); }), "number of a processor"));
}

TEST(SpyDump, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  write_refined(scratch.folder(), "run");
  const std::string whole = bytes_of(scratch / "run.1");
  std::mt19937 random(5);
  int refused = 0;
  for (int n = 0; n < 200; ++n) {
    std::string damaged = whole;
    const std::size_t at = n % 3 == 0 ? random() % 700 : random() % whole.size();
    if (n % 2 == 0) {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    } else {
      damaged.resize(at);
    }
    put_bytes(scratch / "run.1", damaged);
    try {
      read_spy_dump(scratch / "run.0", 1);
    } catch (const Error& error) {
      ++refused;
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_TRUE(says(message, "run.")) << message;
    }
  }
  // Of a file that is cut off, something is missing at any place.
  EXPECT_GE(refused, 90);
}

/// The share of a material that ParaView's reader, in another program, finds in cells of 0.78125 cm, cut off
/// to bytes, at each time.
TEST(RealData, SpcthFractionsAreThoseOfAnotherReader) {
  const auto path = test::shared_data("material/spcth/spcth.2"),
             folder = test::shared_data("derived/spcth_vf");
  ADAMAS_SKIP_WITHOUT(path);
  ADAMAS_SKIP_WITHOUT(folder);
  for (const std::uint64_t time : {0, 4, 7, 8}) {
    const MeshFile file = read_mesh_file(path, time);
    const auto array = std::ranges::find(file.arrays, "Volume fraction of material 3", &GridArray::name);
    ASSERT_NE(array, file.arrays.end());
    const auto& fractions = std::get<std::vector<float>>(array->values);
    const std::string bytes = bytes_of(folder / fmt::format("spcth_vf3_t{:02}_64x64x64_uint8.raw", time));
    ASSERT_EQ(bytes.size(), 64u * 64 * 64);
    std::size_t face = 0, point = 0, compared = 0;
    for (std::size_t c = 0; c < file.cell_ends.size(); ++c) {
      Box3 box;
      for (; face < file.cell_ends[c]; ++face) {
        for (; point < file.face_ends[face]; ++point) box.extend(file.points[file.face_points[point]]);
      }
      const auto first = [&](int axis) { return std::lround(box.min[axis] / 0.78125); };
      const auto last = [&](int axis) { return std::lround(box.max[axis] / 0.78125); };
      for (auto k = first(2); k < last(2); ++k) {
        for (auto j = first(1); j < last(1); ++j) {
          for (auto i = first(0); i < last(0); ++i, ++compared)
            ASSERT_EQ(static_cast<unsigned char>(bytes[static_cast<std::size_t>(i + 64 * (j + 64 * k))]),
                      static_cast<unsigned char>(255 * fractions[c]))
                << time;
        }
      }
    }
    EXPECT_EQ(compared, bytes.size());
  }
}

TEST(RealData, SpcthRestartsFollowEachOther) {
  const auto path = test::shared_data("material/spcth/sample.spcth-timeseries");
  ADAMAS_SKIP_WITHOUT(path);
  const std::vector<double> times = mesh_times(path),
                            of_run = mesh_times(test::shared_data("material/spcth/spcth.0"));
  EXPECT_EQ(times, of_run);
  EXPECT_EQ(times.size(), 9u);
  const MeshFile again = read_mesh_file(path, 6),
                 first = read_mesh_file(test::shared_data("material/spcth/spcth.1"), 6);
  EXPECT_EQ(again.cell_ends.size(), first.cell_ends.size());
}

}  // namespace
}  // namespace adamas
