// Tests files of HDF5 whose data sets are named by a layout.

#include "core/io/hdf5_layout.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "adamas/files.h"
#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/grid_file.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "core/io/multi_material_reader.h"
#include "tests/support/hdf5_file.h"
#include "tests/support/hexahedra.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::Hdf5File;
using test::put_bytes;
using test::says;
using test::Scratch;

/// A layout that holds until the end of a test.
class Hdf5Layout : public testing::Test {
 protected:
  ~Hdf5Layout() override { set_hdf5_layout({}); }
};

void add_reals(Hdf5File& file, const std::string& name, const std::vector<std::uint64_t>& size,
               const std::vector<double>& values) {
  file.add(name, size, StoredType::kFloat64, values.data());
}

/// Writes a block of 2 x 2 x 2 hexahedra with nodes that count from `base`, an array of cells and one of
/// nodes.
void write_mesh(const std::filesystem::path& path, int base) {
  const test::Hexahedra cube =
      test::make_hexahedra({2, 2, 2}, [](const Vec3& p) { return test::jittered(p, 0.1); });
  Hdf5File file(path);
  std::vector<double> points, height, share;
  std::vector<std::int32_t> cells;
  for (const Vec3& p : cube.points) {
    points.insert(points.end(), {p.x, p.y, p.z});
    height.push_back(p.z);
  }
  for (const auto& cell : cube.cells) {
    for (const auto p : cell) cells.push_back(static_cast<std::int32_t>(p) + base);
    share.push_back(0.125 * static_cast<double>(share.size()));
  }
  add_reals(file, "mesh/xyz", {cube.points.size(), 3}, points);
  file.add("mesh/corners", {8, 8}, StoredType::kInt32, cells.data());
  add_reals(file, "values/steel", {8}, share);
  add_reals(file, "height", {cube.points.size()}, height);
  add_reals(file, "other", {5}, {1, 2, 3, 4, 5});
}

TEST_F(Hdf5Layout, NodesAndCellsAreAMeshWhateverTheirFirstNumber) {
  const Scratch scratch;
  for (const int base : {0, 1}) {
    write_mesh(scratch / "a.h5", base);
    set_hdf5_layout({});
    EXPECT_NE(kind_by_format(scratch / "a.h5"), InputKind::kCells);
    set_hdf5_layout({"nodes=mesh/xyz", "cells=/mesh/corners", fmt::format("base={}", base)});
    EXPECT_EQ(kind_by_format(scratch / "a.h5"), InputKind::kCells);
    EXPECT_TRUE(mesh_times(scratch / "a.h5").empty());
    MaterialDataOptions options;
    options.fractions = {{"steel", "values/steel"}};
    options.rest = "air";
    const MeshData data = read_mesh_data(scratch / "a.h5", options);
    ASSERT_EQ(data.mesh.cell_count(), 8u);
    double steel = 0;
    for (std::size_t c = 0; c < 8; ++c) steel += 0.125 * static_cast<double>(c) * data.mesh.cell_volume(c);
    EXPECT_NEAR(data.volumes()[MaterialId(0)], steel, 1e-12);
    ASSERT_EQ(data.fields.size(), 1u);
    EXPECT_EQ(data.fields[0].name, "height");
  }
  // With a base that is too great the first node is below all others.
  write_mesh(scratch / "a.h5", 0);
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "a.h5"); }), "--hdf5 cells"));
}

TEST_F(Hdf5Layout, CellsMayDifferInShapeAndCoordinatesLieApart) {
  const Scratch scratch;
  {
    // A hexahedron, a wedge on it, and a tetrahedron beside.
    Hdf5File file(scratch / "a.h5");
    add_reals(file, "X", {12}, {0, 1, 1, 0, 0, 1, 1, 0, 0.5, 0.5, 5, 5});
    add_reals(file, "Y", {12}, {0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 1});
    add_reals(file, "Z", {12}, {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 0, 0});
    const std::vector<std::int32_t> cells{0, 1, 2,  3,  4, 5,  6, 7, 4,  5,  8,  7,
                                          6, 9, -1, -1, 1, 10, 2, 5, -1, -1, -1, -1};
    file.add("cells", {3, 8}, StoredType::kInt32, cells.data());
    add_reals(file, "pair", {3, 2}, {1, 2, 3, 4, 5, 6});
  }
  set_hdf5_layout({"x=X", "y=Y", "z=Z", "cells=cells"});
  const MeshFile file = read_mesh_file(scratch / "a.h5");
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("a", file.points, file.face_points, file.face_ends, file.cell_ends);
  ASSERT_EQ(mesh.cell_count(), 3u);
  EXPECT_NEAR(mesh.cell_volume(0), 1, 1e-12);
  EXPECT_NEAR(mesh.cell_volume(1), 0.5, 1e-12);
  EXPECT_NEAR(mesh.cell_volume(2), 4.0 / 6, 1e-12);
  ASSERT_EQ(file.arrays.size(), 1u);
  EXPECT_EQ(file.arrays[0].components, 2);
}

TEST_F(Hdf5Layout, StepsAreGroupsOrPartsOfDataSets) {
  const Scratch scratch;
  {
    Hdf5File file(scratch / "a.h5");
    add_reals(file, "grid/x", {3}, {0, 1, 3});
    add_reals(file, "grid/y", {2}, {0, 2});
    add_reals(file, "t", {2}, {0.5, 4});
    add_reals(file, "all", {2, 1, 2}, {10, 11, 20, 21});
    add_reals(file, "still", {1, 2}, {7, 8});
    for (const int step : {9, 10}) {
      add_reals(file, fmt::format("run/step {}/heat", step), {1, 2}, {1.0 * step, 2.0 * step});
      file.add_numbers(fmt::format("run/step {}", step), "time", {0.1 * step});
    }
  }
  const auto values = [&](const std::string& array, std::uint64_t time) {
    const MeshFile file = read_mesh_file(scratch / "a.h5", time);
    EXPECT_TRUE(file.flat);
    const auto found = std::ranges::find(file.arrays, array, &GridArray::name);
    EXPECT_NE(found, file.arrays.end());
    std::vector<double> result;
    if (found == file.arrays.end()) return result;
    std::visit([&](const auto& all) { result.assign(all.begin(), all.end()); }, found->values);
    return result;
  };
  set_hdf5_layout({"x=grid/x", "y=grid/y", "steps=run/step *"});
  EXPECT_EQ(mesh_times(scratch / "a.h5"), (std::vector<double>{0.9, 1}));
  EXPECT_EQ(values("heat", 1), (std::vector<double>{10, 20}));
  EXPECT_EQ(values("still", 1), (std::vector<double>{7, 8}));
  EXPECT_TRUE(says(error_of([&] { read_mesh_file(scratch / "a.h5", 2); }), "from 0 to 1, found 2"));
  set_hdf5_layout({"x=grid/x", "y=grid/y", "steps=run"});
  EXPECT_EQ(mesh_times(scratch / "a.h5").size(), 2u);
  set_hdf5_layout({"x=grid/x", "y=grid/y", "times=t"});
  EXPECT_EQ(mesh_times(scratch / "a.h5"), (std::vector<double>{0.5, 4}));
  EXPECT_EQ(values("all", 0), (std::vector<double>{10, 11}));
  EXPECT_EQ(values("all", 1), (std::vector<double>{20, 21}));
}

TEST_F(Hdf5Layout, BlocksOfSeveralSizesShareTheirFaces) {
  const Scratch scratch;
  {
    Hdf5File file(scratch / "a.h5");
    std::vector<double> boxes{1, 2, 0, 1, 0, 1}, values{-1, -1, -1, -1, -1, -1, -1, -1};
    for (int n = 0; n < 8; ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        const double low = 0.5 * (n >> axis & 1);
        boxes.insert(boxes.end(), {low, low + 0.5});
      }
      for (int c = 0; c < 8; ++c) values.push_back(10 * n + c);
    }
    add_reals(file, "boxes", {9, 3, 2}, boxes);
    add_reals(file, "rho", {9, 2, 2, 2}, values);
  }
  set_hdf5_layout({"boxes=boxes"});
  const MeshFile file = read_mesh_file(scratch / "a.h5");
  const PolyhedralMesh mesh =
      PolyhedralMesh::make("a", file.points, file.face_points, file.face_ends, file.cell_ends);
  ASSERT_EQ(mesh.cell_count(), 72u);
  double sum = 0;
  for (std::size_t c = 0; c < 72; ++c) {
    sum += mesh.cell_volume(c);
    Box3 box;
    for (const auto p : mesh.points_of_cell(c)) box.extend(mesh.points()[p]);
    int wanted = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = 0.5 * (box.min[axis] + box.max[axis]);
      wanted += ((at > 0.5 ? 10 : 0) + (at - (at > 0.5 ? 0.5 : 0) > 0.25 ? 1 : 0)) << axis;
    }
    double found = 0;
    std::visit([&](const auto& all) { found = static_cast<double>(all[c]); }, file.arrays.at(0).values);
    EXPECT_EQ(found, box.min.x >= 1 ? -1 : wanted);
  }
  EXPECT_NEAR(sum, 2, 1e-12);
}

TEST_F(Hdf5Layout, AxesAreThoseOfAGrid) {
  const Scratch scratch;
  {
    Hdf5File file(scratch / "a.h5");
    add_reals(file, "x", {4}, {0, 1, 2, 5});
    add_reals(file, "y", {3}, {-1, 0, 3});
    add_reals(file, "z", {2}, {0, 4});
    std::vector<double> cells, points;
    for (int n = 0; n < 6; ++n) cells.push_back(n);
    for (int n = 0; n < 24; ++n) points.push_back(100 + n);
    add_reals(file, "share", {1, 2, 3}, cells);
    add_reals(file, "heat", {2, 3, 4}, points);
    add_reals(file, "odd", {7, 7, 7}, std::vector<double>(343, 1));
  }
  set_hdf5_layout({"x=x", "y=y", "z=z"});
  EXPECT_EQ(kind_by_format(scratch / "a.h5"), InputKind::kGrid);
  const GridFile file = read_grid_file(scratch / "a.h5");
  EXPECT_EQ(file.nodes[0], (std::vector<double>{0, 1, 2, 5}));
  EXPECT_EQ(file.nodes[1], (std::vector<double>{-1, 0, 3}));
  ASSERT_EQ(file.arrays.size(), 2u);
  for (const GridArray& array : file.arrays)
    EXPECT_EQ(array.centering, array.name == "heat" ? Centering::kPoints : Centering::kCells);
}

TEST_F(Hdf5Layout, NamesThatAreNotThereAreAnsweredWithThoseThatAre) {
  const Scratch scratch;
  write_mesh(scratch / "a.h5", 0);
  const auto error = [&](const std::vector<std::string>& layout) {
    return error_of([&] {
      set_hdf5_layout(layout);
      read_mesh_file(scratch / "a.h5");
    });
  };
  EXPECT_TRUE(says(error({"nodes=mesh/xy", "cells=mesh/corners"}),
                   "--hdf5 nodes: expected 'mesh/xy', found 'height', 'mesh/corners', 'mesh/xyz', 'other', "
                   "'values/steel'"));
  EXPECT_TRUE(says(error({"nodes=mesh/xyz", "cells=mesh/corners", "steps=run/*"}), "--hdf5 steps"));
  EXPECT_TRUE(says(error({"nodes=mesh/xyz"}), "cells beside nodes"));
  EXPECT_TRUE(says(error({"cells=mesh/corners"}), "nodes, or x and y"));
  EXPECT_TRUE(says(error({"nodes=mesh/corners", "cells=mesh/corners"}), "2 or 3 coordinates"));
  EXPECT_TRUE(says(error({"boxes=mesh/xyz"}), "--hdf5 boxes"));
  EXPECT_TRUE(says(error({"knots=mesh/xyz"}), "'knots=mesh/xyz'"));
  EXPECT_TRUE(says(error({"nodes=mesh/xyz", "nodes=other"}), "'nodes' twice"));
  EXPECT_TRUE(says(error({"base=2"}), "base=0 or base=1"));
  EXPECT_TRUE(says(error({"nodes="}), "'nodes='"));
}

TEST_F(Hdf5Layout, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  write_mesh(scratch / "a.h5", 1);
  set_hdf5_layout({"nodes=mesh/xyz", "cells=mesh/corners", "base=1"});
  const std::string whole = bytes_of(scratch / "a.h5");
  std::mt19937 random(3);
  for (int n = 0; n < 24; ++n) {
    std::string damaged = whole;
    const std::size_t at = random() % whole.size();
    if (n % 2 == 0) {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    } else {
      damaged.resize(std::max<std::size_t>(at, 16));
    }
    put_bytes(scratch / "a.h5", damaged);
    try {
      read_mesh_file(scratch / "a.h5");
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_TRUE(says(message, "a.h5")) << message;
    }
  }
}

}  // namespace
}  // namespace adamas
