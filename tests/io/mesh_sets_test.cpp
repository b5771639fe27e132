// Side sets and node sets of ExodusII files that its own library has written.

#include <exodusII.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "adamas/file_summary.h"
#include "core/geometry/plane.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "core/io/mesh_set_surfaces.h"
#include "tests/support/hexahedra.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::says;
using test::Scratch;

/// The numbers that ExodusII gives the sides of a hexahedron whose corners are in VTK's order.
constexpr int kSideOfGreatestX = 2, kSideOfLeastX = 4, kSideOfGreatestZ = 6;

/// The sides or the nodes of a set, by their numbers in the file, from 1 on.
struct SetOfTest {
  std::string name;  ///< empty: it has none
  std::vector<int> entries, sides{};
};

class ExodusFile {
 public:
  ExodusFile(const std::filesystem::path& path, int dimensions, const std::vector<Vec3>& points,
             std::size_t cells, std::size_t node_sets, std::size_t side_sets) {
    int of_program = sizeof(double), of_file = sizeof(double);
    id_ = ex_create(path.c_str(), EX_CLOBBER, &of_program, &of_file);
    EXPECT_GE(id_, 0);
    ex_put_init(id_, "test", dimensions, static_cast<std::int64_t>(points.size()),
                static_cast<std::int64_t>(cells), 1, static_cast<std::int64_t>(node_sets),
                static_cast<std::int64_t>(side_sets));
    std::array<std::vector<double>, 3> x;
    for (const Vec3& p : points) {
      for (int axis = 0; axis < 3; ++axis) x[static_cast<std::size_t>(axis)].push_back(p[axis]);
    }
    ex_put_coord(id_, x[0].data(), x[1].data(), x[2].data());
  }
  ~ExodusFile() { ex_close(id_); }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  template <class Cells>
  void put_cells(const char* type, const Cells& cells) const {
    std::vector<int> corners;
    for (const auto& cell : cells) {
      for (const auto p : cell) corners.push_back(static_cast<int>(p) + 1);
    }
    const auto per_cell = static_cast<std::int64_t>(cells.front().size());
    ex_put_block(id_, EX_ELEM_BLOCK, 1, type, static_cast<std::int64_t>(cells.size()), per_cell, 0, 0, 0);
    ex_put_conn(id_, EX_ELEM_BLOCK, 1, corners.data(), nullptr, nullptr);
  }
  void put_set(ex_entity_type type, int number, const SetOfTest& set) const {
    ex_put_set_param(id_, type, number, static_cast<std::int64_t>(set.entries.size()), 0);
    ex_put_set(id_, type, number, set.entries.data(), set.sides.empty() ? nullptr : set.sides.data());
    if (!set.name.empty()) ex_put_name(id_, type, number, set.name.c_str());
  }
  void put_displacements(const std::vector<Vec3>& by) const {
    std::array<std::string, 3> names{"DISPLX", "DISPLY", "DISPLZ"};
    std::array<char*, 3> pointers{names[0].data(), names[1].data(), names[2].data()};
    ex_put_variable_param(id_, EX_NODAL, 3);
    ex_put_variable_names(id_, EX_NODAL, 3, pointers.data());
    const double time = 0;
    ex_put_time(id_, 1, &time);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const Vec3& p : by) values.push_back(p[axis]);
      ex_put_var(id_, 1, EX_NODAL, axis + 1, 1, static_cast<std::int64_t>(values.size()), values.data());
    }
  }

 private:
  int id_ = -1;
};

/// The numbers, from 1 on, of the cells or points for which `has` is true.
template <class Items, class Has>
std::vector<int> numbers_of(const Items& items, const Has& has) {
  std::vector<int> numbers;
  for (std::size_t n = 0; n < items.size(); ++n) {
    if (has(items[n])) numbers.push_back(static_cast<int>(n) + 1);
  }
  return numbers;
}

/// A box of 2 x 1 x 4 in 4 x 2 x 2 hexahedra, with inner points off their places. Its side sets are the side
/// where x is least, a plane between cells where x = 1, and the side where z is greatest, which has no name;
/// its node sets the points where y = 0, and two points.
class Boxes {
 public:
  Boxes() : mesh(test::make_hexahedra({4, 2, 2}, [](const Vec3& p) { return Vec3{2 * p.x, p.y, 4 * p.z}; })) {
    const auto lies = [this](int axis, double at, std::size_t corner) {
      return [this, axis, at, corner](const auto& cell) { return mesh.points[cell[corner]][axis] == at; };
    };
    const auto add = [this](const char* name, std::vector<int> cells, int side) {
      std::vector<int> of_sides(cells.size(), side);
      side_sets.push_back({name, std::move(cells), std::move(of_sides)});
    };
    add("inlet", numbers_of(mesh.cells, lies(0, 0, 0)), kSideOfLeastX);
    add("middle", numbers_of(mesh.cells, lies(0, 1, 1)), kSideOfGreatestX);
    add("", numbers_of(mesh.cells, lies(2, 4, 6)), kSideOfGreatestZ);
    node_sets.push_back({"wall", numbers_of(mesh.points, [](const Vec3& p) { return p.y == 0; })});
    node_sets.push_back({"", {1, 2}});
  }

  void write(const std::filesystem::path& path, const std::vector<Vec3>& displacements = {}) const {
    const ExodusFile file(path, 3, mesh.points, mesh.cells.size(), node_sets.size(), side_sets.size());
    file.put_cells("HEX", mesh.cells);
    for (std::size_t n = 0; n < side_sets.size(); ++n)
      file.put_set(EX_SIDE_SET, static_cast<int>(n) + 7, side_sets[n]);
    for (std::size_t n = 0; n < node_sets.size(); ++n)
      file.put_set(EX_NODE_SET, static_cast<int>(n) + 1, node_sets[n]);
    if (!displacements.empty()) file.put_displacements(displacements);
  }

  test::Hexahedra mesh;
  std::vector<SetOfTest> side_sets, node_sets;
};

MaterialDataOptions one_material() {
  MaterialDataOptions options;
  options.plain = true;
  options.labels = "ObjectId";
  return options;
}

std::map<std::string, double> areas_of(const UnstructuredMesh& surfaces) {
  const auto& sets = std::get<std::vector<std::int32_t>>(surfaces.cell_arrays.front().values);
  const auto& names = std::get<std::vector<std::string>>(surfaces.field_arrays.front().values);
  std::map<std::string, double> areas;
  for (const std::string& name : names) areas[name] = 0;
  for (std::size_t c = 0; c < surfaces.cell_count(); ++c) {
    std::vector<Vec3> corners;
    for (std::size_t i = surfaces.offsets[c]; i < surfaces.offsets[c + 1]; ++i)
      corners.push_back(surfaces.points[surfaces.connectivity[i]]);
    areas[names.at(static_cast<std::size_t>(sets[c]))] += polygon_area(corners);
  }
  return areas;
}

TEST(MeshSets, SummariesTellNumbersAndAreas) {
  const Scratch scratch;
  Boxes().write(scratch / "a.exo");
  const FileSummary summary = summarize_file(scratch / "a.exo");
  EXPECT_EQ(summary.remark, "");
  EXPECT_EQ(summary.cells, 16u);
  ASSERT_EQ(summary.sets.size(), 5u);
  const std::array<const char*, 5> names{"inlet", "middle", "side set 9", "wall", "node set 2"};
  const std::array<std::size_t, 5> sizes{4, 4, 8, 15, 2};
  const std::array<double, 3> areas{4, 4, 2};
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(summary.sets[n].name, names[n]);
    EXPECT_EQ(summary.sets[n].size, sizes[n]);
    EXPECT_EQ(summary.sets[n].of_nodes, n >= 3);
    ASSERT_EQ(summary.sets[n].extent.has_value(), n < 3);
    if (n < 3) {
      EXPECT_NEAR(*summary.sets[n].extent, areas[n], 1e-6);
    }
  }
}

TEST(MeshSets, SurfacesHaveTheSidesOfTheSets) {
  const Scratch scratch;
  Boxes().write(scratch / "a.exo");
  const MeshData data = read_mesh_data(scratch / "a.exo", one_material());
  const UnstructuredMesh surfaces = mesh_set_surfaces(data);
  EXPECT_EQ(surfaces.cell_arrays.front().name, "side_set");
  EXPECT_EQ(surfaces.field_arrays.front().name, "side_set_names");
  const std::map<std::string, double> areas = areas_of(surfaces);
  ASSERT_EQ(areas.size(), 5u);
  EXPECT_NEAR(areas.at("inlet"), 4, 1e-6);
  EXPECT_NEAR(areas.at("middle"), 4, 1e-6);
  EXPECT_NEAR(areas.at("side set 9"), 2, 1e-6);
  EXPECT_NEAR(areas.at("wall"), 8, 1e-6);
  EXPECT_EQ(areas.at("node set 2"), 0);
  const auto& sets = std::get<std::vector<std::int32_t>>(surfaces.cell_arrays.front().values);
  EXPECT_EQ(std::ranges::count(sets, 3), 8);
}

/// Sets are at the points that displacements have moved, as cells are.
TEST(MeshSets, SetsMoveWithTheirCells) {
  const Scratch scratch;
  const Boxes boxes;
  std::vector<Vec3> by;
  for (const Vec3& p : boxes.mesh.points) by.push_back({0.5 * p.x, 0, 0.25 * p.z});
  boxes.write(scratch / "a.exo", by);
  const FileSummary summary = summarize_file(scratch / "a.exo");
  EXPECT_NEAR(summary.box.volume(), 3 * 1 * 5, 1e-5);
  ASSERT_EQ(summary.sets.size(), 5u);
  EXPECT_EQ(summary.sets[0].size, 4u);
  EXPECT_NEAR(*summary.sets[0].extent, 5, 1e-5);
  EXPECT_NEAR(*summary.sets[2].extent, 3, 1e-5);
}

/// The edges of flat cells become sides: of prisms with the area of length times height, of rings with that
/// of a cylinder.
TEST(MeshSets, EdgesOfFlatCellsAreSwept) {
  const Scratch scratch;
  // Two squares, and their outer edges: x = 0, x = 2; all points where y = 0.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const std::vector<std::array<std::uint32_t, 4>> cells{{0, 1, 4, 3}, {1, 2, 5, 4}};
  {
    const ExodusFile file(scratch / "a.exo", 2, points, 2, 1, 2);
    file.put_cells("QUAD", cells);
    file.put_set(EX_SIDE_SET, 1, {"axis", {1}, {4}});
    file.put_set(EX_SIDE_SET, 2, {"rim", {2}, {2}});
    file.put_set(EX_NODE_SET, 1, {"floor", {1, 2, 3}});
  }
  const FileSummary summary = summarize_file(scratch / "a.exo");
  EXPECT_TRUE(summary.flat);
  ASSERT_EQ(summary.sets.size(), 3u);
  EXPECT_EQ(summary.sets[1].name, "rim");
  EXPECT_NEAR(*summary.sets[1].extent, 1, 1e-6);
  MaterialDataOptions options = one_material();
  options.extrude = 0.5;
  std::map<std::string, double> areas =
      areas_of(mesh_set_surfaces(read_mesh_data(scratch / "a.exo", options)));
  EXPECT_NEAR(areas.at("axis"), 0.5, 1e-6);
  EXPECT_NEAR(areas.at("rim"), 0.5, 1e-6);
  EXPECT_NEAR(areas.at("floor"), 1, 1e-6);
  options.extrude.reset();
  options.axisymmetric = true;
  areas = areas_of(mesh_set_surfaces(read_mesh_data(scratch / "a.exo", options)));
  EXPECT_EQ(areas.at("axis"), 0);
  EXPECT_NEAR(areas.at("rim"), 4 * M_PI, 0.01 * 4 * M_PI);
  EXPECT_NEAR(areas.at("floor"), 4 * M_PI, 1e-5);
}

TEST(MeshSets, FilesWithoutSetsHaveNone) {
  const Scratch scratch;
  Boxes boxes;
  boxes.side_sets.clear();
  boxes.node_sets.clear();
  boxes.write(scratch / "a.exo");
  EXPECT_TRUE(summarize_file(scratch / "a.exo").sets.empty());
  EXPECT_TRUE(read_mesh_data(scratch / "a.exo", one_material()).sets.empty());
}

TEST(MeshSets, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  Boxes().write(scratch / "a.exo");
  const std::string whole = test::bytes_of(scratch / "a.exo");
  std::mt19937 random(3);
  for (int n = 0; n < 60; ++n) {
    std::string damaged = whole;
    const std::size_t at = random() % whole.size();
    if (n % 3 != 0) {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    } else {
      damaged.resize(at);
    }
    test::put_bytes(scratch / "a.exo", damaged);
    try {
      static_cast<void>(mesh_set_surfaces(read_mesh_data(scratch / "a.exo", one_material())));
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_TRUE(says(message, "a.exo")) << message;
    }
  }
}

}  // namespace
}  // namespace adamas
