#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkExodusIIReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/scratch.h"

namespace adamas::test {

using namespace io;

namespace {

/// Returns two tetrahedra of two materials with a common face, and one block without any.
SolverMesh two_tetrahedra() {
  SolverMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1.0 / 3}};
  mesh.tetrahedra = {{4, 2, 1, 3}, {0, 1, 2, 3}};
  mesh.block = {2, 0};
  mesh.blocks = {"iron \"ore\"", "nothing", "A long name, with spaces and more than 32 characters"};
  mesh.face_groups = {{"z min", {{1, 3}}}, {"none", {}}, {"iron | other", {{1, 0}}}};
  mesh.fields = {{"density", 1, std::vector<double>{2.5, 0.1}},
                 {"velocity", 3, std::vector<double>{1, 2, 3, 4, 5, 6}}};
  return mesh;
}

class SolverMeshes : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return scratch_ / name; }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  Scratch scratch_;
};

TEST_F(SolverMeshes, FacesAreSeenFromOutside) {
  const SolverMesh mesh = two_tetrahedra();
  for (std::uint32_t t = 0; t < 2; ++t) {
    const auto& v = mesh.tetrahedra[t];
    ASSERT_GT(signed_volume(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]), 0);
    for (std::uint8_t i = 0; i < 4; ++i) {
      const auto f = mesh.corners({t, i});
      EXPECT_LT(signed_volume(mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]], mesh.points[v[i]]), 0);
    }
  }
}

/// The test reads the file as Gmsh's manual describes it.
TEST_F(SolverMeshes, GmshFilesSayWhatTheMeshIs) {
  const SolverMesh mesh = two_tetrahedra();
  write_solver_mesh(path("m.msh"), mesh);
  std::ifstream in(path("m.msh"));
  std::string word;
  std::map<std::string, std::vector<std::string>> sections;
  std::string section;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '$' && line.starts_with("$End")) {
      EXPECT_EQ(line, "$End" + section.substr(1));
      section.clear();
    } else if (line[0] == '$') {
      EXPECT_TRUE(section.empty());
      section = line;
    } else {
      sections[section].push_back(line);
    }
  }
  EXPECT_EQ(sections["$MeshFormat"], std::vector<std::string>{"2.2 0 8"});
  EXPECT_EQ(sections["$PhysicalNames"][0], "6");
  EXPECT_EQ(sections["$PhysicalNames"][4], "3 1 \"iron 'ore'\"");
  ASSERT_EQ(sections["$Nodes"].size(), 6u);
  for (std::size_t p = 0; p < 5; ++p) {
    std::istringstream line(sections["$Nodes"][p + 1]);
    std::size_t number = 0;
    Vec3 x;
    line >> number >> x.x >> x.y >> x.z;
    EXPECT_EQ(number, p + 1);
    EXPECT_EQ(x, mesh.points[p]);
  }
  const std::vector<std::string> elements{"4", "1 4 2 3 3 5 3 2 4", "2 4 2 1 1 1 2 3 4", "3 2 2 4 4 1 3 2",
                                          "4 2 2 6 6 2 3 4"};
  EXPECT_EQ(sections["$Elements"], elements);
  const std::vector<std::string> data{"1",     "\"density\"", "1",       "0.0",          "3", "0",   "1", "2",
                                      "1 2.5", "2 0.1",       "1",       "\"velocity\"", "1", "0.0", "3", "0",
                                      "3",     "2",           "1 1 2 3", "2 4 5 6"};
  EXPECT_EQ(sections["$ElementData"], data);
}

TEST_F(SolverMeshes, VtkReadsTheExodusFiles) {
  const SolverMesh mesh = two_tetrahedra();
  write_solver_mesh(path("m.exo"), mesh);
  const auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  const std::string name = path("m.exo").string();
  reader->SetFileName(name.c_str());
  reader->UpdateInformation();
  ASSERT_EQ(reader->GetNumberOfElementBlockArrays(), 2);
  EXPECT_STREQ(reader->GetElementBlockArrayName(0), mesh.blocks[0].c_str());
  EXPECT_STREQ(reader->GetElementBlockArrayName(1), mesh.blocks[2].c_str());
  reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
  for (int i = 0; i < reader->GetNumberOfElementResultArrays(); ++i)
    reader->SetElementResultArrayStatus(reader->GetElementResultArrayName(i), 1);
  ASSERT_EQ(reader->GetNumberOfSideSetArrays(), 2);
  for (int i = 0; i < 2; ++i) reader->SetSideSetArrayStatus(reader->GetSideSetArrayName(i), 1);
  reader->Update();
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput()->GetBlock(0));
  ASSERT_NE(blocks, nullptr);
  const std::array<std::size_t, 2> expected{1, 0};  // tetrahedra by block
  for (unsigned b = 0; b < 2; ++b) {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(blocks->GetBlock(b));
    ASSERT_NE(grid, nullptr);
    ASSERT_EQ(grid->GetNumberOfCells(), 1);
    const std::size_t t = expected[b];
    for (vtkIdType i = 0; i < 4; ++i) {
      std::array<double, 3> x{};
      grid->GetPoint(grid->GetCell(0)->GetPointId(static_cast<int>(i)), x.data());
      // The reader converts coordinates to floats.
      EXPECT_LT(distance({x[0], x[1], x[2]}, mesh.points[mesh.tetrahedra[t][static_cast<std::size_t>(i)]]),
                1e-7);
    }
    auto* density = grid->GetCellData()->GetArray("density");
    ASSERT_NE(density, nullptr);
    EXPECT_EQ(density->GetTuple1(0), t == 0 ? 2.5 : 0.1);
    auto* velocity = grid->GetCellData()->GetArray("velocity_");
    if (velocity == nullptr) velocity = grid->GetCellData()->GetArray("velocity");
    ASSERT_NE(velocity, nullptr);
    EXPECT_EQ(velocity->GetTuple3(0)[2], t == 0 ? 3 : 6);
  }
  // The sides of the box are sets in the order of their places.
  auto* sets = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput()->GetBlock(4));
  ASSERT_NE(sets, nullptr);
  auto* bottom = vtkDataSet::SafeDownCast(sets->GetBlock(0));
  ASSERT_NE(bottom, nullptr);
  ASSERT_EQ(bottom->GetNumberOfCells(), 1);
  std::array<double, 6> bounds{};
  bottom->GetCell(0)->GetBounds(bounds.data());
  EXPECT_EQ(bounds[4], 0);
  EXPECT_EQ(bounds[5], 0);
}

TEST_F(SolverMeshes, VtuFilesHoldTheMeshAndSurfacesItsFaces) {
  SolverMesh mesh = two_tetrahedra();
  mesh.body = {4, 7};
  mesh.fields.push_back({"body", 1, std::vector<double>{8, 9}});
  write_solver_mesh(path("m.vtu"), mesh);
  const UnstructuredMesh read = read_unstructured_mesh(path("m.vtu"));
  EXPECT_EQ(read.points, mesh.points);
  EXPECT_EQ(read.connectivity, (std::vector<std::uint32_t>{4, 2, 1, 3, 0, 1, 2, 3}));
  const auto array = [](const std::vector<NamedArray>& arrays, const std::string& name) {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
    return found == arrays.end() ? NamedArray() : *found;
  };
  using Integers = std::vector<std::int32_t>;
  EXPECT_EQ(std::get<Integers>(array(read.cell_arrays, "material").values), (Integers{2, 0}));
  EXPECT_EQ(std::get<Integers>(array(read.cell_arrays, "body").values), (Integers{4, 7}));
  for (const char* name : {"density", "velocity", "body (field)"})
    EXPECT_EQ(array(read.cell_arrays, name).values,
              array(mesh.fields, name == std::string("body (field)") ? "body" : name).values)
        << name;
  write_unstructured_mesh(path("m.vtp"), face_surface(mesh));
  const UnstructuredMesh faces = read_unstructured_mesh(path("m.vtp"));
  const auto points = std::get<Integers>(array(faces.point_arrays, "point").values);
  const auto groups = std::get<Integers>(array(faces.cell_arrays, "group").values);
  const auto tetrahedra = std::get<Integers>(array(faces.cell_arrays, "tetrahedron").values);
  const auto names = std::get<std::vector<std::string>>(array(faces.field_arrays, "group_names").values);
  std::size_t f = 0;
  for (const auto& group : mesh.face_groups) {
    for (const SolverMesh::Face& face : group.faces) {
      ASSERT_LT(f, faces.cell_count());
      EXPECT_EQ(names.at(static_cast<std::size_t>(groups[f])), group.name);
      EXPECT_EQ(tetrahedra[f], static_cast<std::int32_t>(face.tetrahedron));
      const auto corners = mesh.corners(face);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t p = faces.connectivity[3 * f + i];
        EXPECT_EQ(points[p], static_cast<std::int32_t>(corners[i]));
        EXPECT_EQ(faces.points[p], mesh.points[corners[i]]);
      }
      ++f;
    }
  }
  EXPECT_EQ(f, faces.cell_count());
}

TEST_F(SolverMeshes, EqualMeshesGiveEqualBytes) {
  for (const std::string extension : {".vtu", ".msh", ".exo"}) {
    write_solver_mesh(path("a" + extension), two_tetrahedra());
    write_solver_mesh(path("b" + extension), two_tetrahedra());
    EXPECT_TRUE(bytes("a" + extension) == bytes("b" + extension));
  }
}

TEST_F(SolverMeshes, AFullDiskLeavesNoFile) {
  SolverMesh mesh = two_tetrahedra();
  mesh.points.resize(20000);
  for (const std::string name : {"m.msh", "m.exo"}) {
    const FileSizeLimit limit(8192);
    EXPECT_THROW(write_solver_mesh(path(name), mesh), Error) << name;
    EXPECT_FALSE(std::filesystem::exists(path(name)));
  }
  EXPECT_THROW(write_solver_mesh(path("m.xyz"), mesh), Error);
  EXPECT_THROW(write_solver_mesh(path("nowhere/m.exo"), mesh), Error);
}

}  // namespace

}  // namespace adamas::test
