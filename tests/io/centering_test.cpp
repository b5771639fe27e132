// Tests whether the values of a grid file belong to cells or to points.

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

#include "adamas/file_summary.h"
#include "core/io/multi_material_reader.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

constexpr std::array<std::size_t, 3> kSizes{5, 4, 3};

std::vector<float> random_fractions() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> values(kSizes[0] * kSizes[1] * kSizes[2]);
  std::generate(values.begin(), values.end(), [&] { return unit(random); });
  return values;
}

class CenteringTest : public ::testing::Test {
 protected:
  /// Writes random fractions of one material as NRRD.
  std::filesystem::path put(const std::string& name, const std::string& fields) const {
    std::string bytes =
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nencoding: raw\nendian: little\n" + fields + "\n";
    for (const float v : values_) bytes.append(reinterpret_cast<const char*>(&v), sizeof(v));
    put_bytes(scratch_ / name, bytes);
    return scratch_ / name;
  }

  /// Reads the file with the rest as a second material, and keeps the notes in notes_.
  MultiMaterialData read(const std::filesystem::path& path, std::optional<Centering> wanted = {}) {
    MaterialDataOptions options;
    options.fractions = {{"a", path.string()}};
    options.rest = "b";
    options.centering = wanted;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_.push_back(text); };
    return read_multi_material_data(path, options);
  }

  /// Returns the volume of material a where the sample (i, j, k) stands for a box with these sides.
  template <class Side>
  [[nodiscard]] double volume(const Side& side) const {
    double sum = 0;
    std::size_t at = 0;
    for (std::size_t k = 0; k < kSizes[2]; ++k) {
      for (std::size_t j = 0; j < kSizes[1]; ++j) {
        for (std::size_t i = 0; i < kSizes[0]; ++i)
          sum += static_cast<double>(values_[at++]) * side(0, i) * side(1, j) * side(2, k);
      }
    }
    return sum;
  }

  void expect_domain(const MultiMaterialData& data, const Vec3& low, const Vec3& high) const {
    EXPECT_LT(distance(data.grid.domain().min, low), 1e-12);
    EXPECT_LT(distance(data.grid.domain().max, high), 1e-12);
    EXPECT_NEAR(data.volumes()[MaterialId(0)] + data.volumes()[MaterialId(1)], data.grid.domain().volume(),
                1e-5 * data.grid.domain().volume());
  }

  test::Scratch scratch_;
  std::vector<float> values_ = random_fractions();
  std::vector<std::string> notes_;
};

/// Returns the side of any cell.
double half(std::size_t, std::size_t) { return 0.5; }

/// Returns the part of the domain that is nearest to a point, for points half a unit apart.
double near_point(std::size_t axis, std::size_t i) { return i == 0 || i + 1 == kSizes[axis] ? 0.25 : 0.5; }

const std::string kHalf = "spacings: 0.5 0.5 0.5\n";

TEST_F(CenteringTest, CellsReachToTheirFaces) {
  for (const std::string& fields : std::vector<std::string>{
           kHalf + "centers: cell cell cell\n", kHalf + "centerings: cell cell cell\n",
           "centers: cell cell cell\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\nspace origin: "
           "(0,0,0)\n"}) {
    const MultiMaterialData data = read(put("a.nrrd", fields));
    EXPECT_EQ(data.grid.centering, Centering::kCells);
    expect_domain(data, {-0.25, -0.25, -0.25}, {2.25, 1.75, 1.25});
    EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(half), 1e-5);
    EXPECT_TRUE(notes_.empty());
  }
}

TEST_F(CenteringTest, ExtremesOfAxesAreFacesOfCells) {
  for (const std::string fields :
       {"axis mins: 1 2 3\naxis maxs: 3.5 4 4.5\ncenters: cell cell cell\n",
        "axis mins: 1 2 3\nspacings: 0.5 0.5 0.5\ncenters: cell cell cell\n",
        "axis mins: 1 2 3\naxis maxs: 3.5 4 4.5\n", "axis mins: 1 2 3\nspacings: 0.5 0.5 0.5\n"}) {
    const MultiMaterialData data = read(put("a.nrrd", fields));
    expect_domain(data, {1, 2, 3}, {3.5, 4, 4.5});
    EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(half), 1e-5);
    EXPECT_LT(distance(data.grid.site(0, 0, 0), {1.25, 2.25, 3.25}), 1e-12);
  }
  // For nodes the extremes are the first and the last one.
  for (const std::string centers : {"centers: node node node\n", ""}) {
    const MultiMaterialData data =
        read(put("a.nrrd", "axis mins: 1 2 3\naxis maxs: 3 3.5 4\n" + centers), Centering::kPoints);
    expect_domain(data, {1, 2, 3}, {3, 3.5, 4});
    EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(near_point), 1e-5);
  }
}

TEST_F(CenteringTest, NodesEndAtTheLast) {
  const MultiMaterialData data = read(put("a.nrrd", kHalf + "centers: node node node\n"));
  EXPECT_EQ(data.grid.centering, Centering::kPoints);
  expect_domain(data, {0, 0, 0}, {2, 1.5, 1});
  EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(near_point), 1e-5);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(CenteringTest, WhatIsAssumedIsSaidOnce) {
  const auto path = put("a.nrrd", kHalf);
  expect_domain(read(path), {-0.25, -0.25, -0.25}, {2.25, 1.75, 1.25});
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_TRUE(says(notes_[0], path.string() + ": nothing says"));
  EXPECT_TRUE(says(notes_[0], "--points"));
  expect_domain(read(path, Centering::kCells), {-0.25, -0.25, -0.25}, {2.25, 1.75, 1.25});
  EXPECT_TRUE(notes_.empty());
  expect_domain(read(path, Centering::kPoints), {0, 0, 0}, {2, 1.5, 1});
  EXPECT_TRUE(notes_.empty());
  expect_domain(read(put("b.nrrd", kHalf + "centers: ??? ??? ???\n")), {-0.25, -0.25, -0.25},
                {2.25, 1.75, 1.25});
  EXPECT_EQ(notes_.size(), 1u);
  // The centering asked for takes precedence over that of the file.
  expect_domain(read(put("b.nrrd", kHalf + "centers: cell cell cell\n"), Centering::kPoints), {0, 0, 0},
                {2, 1.5, 1});
}

TEST_F(CenteringTest, EachAxisHasItsOwn) {
  const MultiMaterialData data = read(put("a.nrrd", kHalf + "centers: cell node cell\n"));
  EXPECT_EQ(data.grid.centering, Centering::kCells);
  expect_domain(data, {-0.25, 0, -0.25}, {2.25, 1.5, 1.25});
  const auto side = [](std::size_t axis, std::size_t i) { return axis == 1 ? near_point(axis, i) : 0.5; };
  EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(side), 1e-5);
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_TRUE(says(notes_[0], "nodes along others"));
  // An axis without a centering has that of the others. Where axes are exchanged each keeps its own.
  expect_domain(read(put("a.nrrd", kHalf + "centers: ??? cell ???\n")), {-0.25, -0.25, -0.25},
                {2.25, 1.75, 1.25});
  expect_domain(read(put("a.nrrd",
                         "centers: cell node node\nspace directions: (0,0.5,0) (-0.5,0,0) (0,0,0.5)\n"
                         "space origin: (0,0,0)\n")),
                {-1.5, -0.25, 0}, {0, 2.25, 1});
  EXPECT_TRUE(
      says(error_of([&] { read(put("a.nrrd", "centers: cell middle cell\n")); }),
           "a.nrrd: line 7: expected cell, node, ??? or none for each axis, found 'cell middle cell'"));
}

TEST_F(CenteringTest, OtherFilesFitTheMainOne) {
  const auto fractions = put("a.nrrd", kHalf);
  std::string grid =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\nORIGIN -0.25 -0.25 "
      "-0.25\nSPACING 0.5 0.5 0.5\nCELL_DATA 60\nSCALARS f float 1\nLOOKUP_TABLE default\n";
  for (int i = 0; i < 60; ++i) grid += "1 ";
  put_bytes(scratch_ / "f.vtk", grid + "\n");
  MaterialDataOptions options;
  options.fractions = {{"a", fractions.string()}};
  options.rest = "b";
  const MultiMaterialData data = read_multi_material_data(scratch_ / "f.vtk", options);
  expect_domain(data, {-0.25, -0.25, -0.25}, {2.25, 1.75, 1.25});
  EXPECT_NEAR(data.volumes()[MaterialId(0)], volume(half), 1e-5);
  const auto nodes = put("n.nrrd", kHalf + "centers: node node node\n");
  options.fractions = {{"a", nodes.string()}};
  EXPECT_TRUE(
      says(error_of([&] { read_multi_material_data(scratch_ / "f.vtk", options); }), "expected the grid of"));
}

TEST_F(CenteringTest, ArraysOfVtkMoveWhereAskedTo) {
  const auto put_vtk = [this](const std::string& on, std::size_t count) {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 4 3 2\nX_COORDINATES 4 "
        "float\n0 1 3 4\nY_COORDINATES 3 float\n0 1 2\nZ_COORDINATES 2 float\n5 6\n" +
        on + " " + std::to_string(count) + "\nSCALARS l int 1\nLOOKUP_TABLE default\n";
    for (std::size_t i = 0; i < count; ++i) text += std::to_string(i % 2) + " ";
    put_bytes(scratch_ / "l.vtk", text + "\n");
  };
  MaterialDataOptions options;
  options.labels = "l";
  put_vtk("POINT_DATA", 24);
  EXPECT_EQ(read_multi_material_data(scratch_ / "l.vtk", options).grid.centering, Centering::kPoints);
  options.centering = Centering::kCells;
  MultiMaterialData data = read_multi_material_data(scratch_ / "l.vtk", options);
  EXPECT_EQ(data.grid.nodes, (std::array<std::vector<double>, 3>{
                                 {{-0.5, 0.5, 2, 3.5, 4.5}, {-0.5, 0.5, 1.5, 2.5}, {4.5, 5.5, 6.5}}}));
  EXPECT_EQ(data.labels.size(), 24u);
  put_vtk("CELL_DATA", 6);
  options.centering = Centering::kPoints;
  // The points of one layer of cells have no extent.
  EXPECT_TRUE(
      says(error_of([&] { read_multi_material_data(scratch_ / "l.vtk", options); }), "l.vtk: expected"));
}

TEST_F(CenteringTest, SummariesSayIt) {
  const auto arrays_on = [](const FileSummary& s) { return s.arrays.at(0).location; };
  const FileSummary cells = summarize_file(put("a.nrrd", kHalf + "centers: cell cell cell\n"));
  EXPECT_EQ(arrays_on(cells), "cells");
  EXPECT_EQ(cells.cells, 60u);
  EXPECT_NEAR(cells.box.volume(), 2.5 * 2 * 1.5, 1e-12);
  const auto plain = put("b.nrrd", kHalf);
  EXPECT_EQ(arrays_on(summarize_file(plain)), "points");
  EXPECT_EQ(summarize_file(plain).points, 60u);
  EXPECT_EQ(arrays_on(summarize_file(plain, Centering::kCells)), "cells");
}

}  // namespace
}  // namespace adamas
