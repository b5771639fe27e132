// Tests meshes that are cut along their interfaces, as the commands write them.

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "program.h"

namespace adamas::test {

namespace {

class CutMesh : public ProgramTest {
 protected:
  CutMesh() { make_scene("voronoi10", 7); }

  /// Returns the lines of a section of a Gmsh file.
  [[nodiscard]] std::vector<std::string> section(const std::string& file, const std::string& name) const {
    std::istringstream in(read(file));
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
      if (line == "$End" + name) return lines;
      if (inside) lines.push_back(line);
      inside = inside || line == "$" + name;
    }
    return {};
  }
};

TEST_F(CutMesh, FiguresAndFilesAgree) {
  const auto run = run_well({"resample", "scene.vtr", "--interface-error", "4%", "--cut-mesh", "c.msh",
                             "--save", "h.h5", "--ledger", "l.csv", "--json", "j.json"});
  EXPECT_NE(run.out.find("dihedral angles"), std::string::npos);
  const auto figures = read_json("j.json");
  const auto& cut = figures.at("cut_mesh");
  EXPECT_GT(cut.at("dihedral_min"), 5);
  EXPECT_LT(cut.at("dihedral_max"), 175);
  EXPECT_EQ(cut.at("lost_bodies"), 0);
  const double target = figures.at("interface_error_target");
  EXPECT_LE(cut.at("to_mesh").at("interface_error"), target);
  EXPECT_LE(cut.at("to_input").at("interface_error"), 2 * target);
  EXPECT_LE(cut.at("to_input").at("interface_error_found"), cut.at("to_input").at("interface_error"));
  EXPECT_LE(cut.at("to_input").at("interface_error"), cut.at("to_input").at("interface_error_per_material"));
  // The file has the right counts, the names of all ten materials and of the box's sides, and elements that
  // refer to existing nodes.
  EXPECT_EQ(section("c.msh", "Nodes").at(0), std::to_string(cut.at("vertices").get<std::size_t>()));
  std::size_t tetrahedra = 0;
  std::set<std::string> groups;
  for (const std::string& line : section("c.msh", "Elements")) {
    std::istringstream in(line);
    int number = 0, type = 0, tags = 0;
    std::string group;
    if (in >> number >> type >> tags >> group) {
      tetrahedra += type == 4 ? 1 : 0;
      groups.insert(group);
    }
  }
  EXPECT_EQ(tetrahedra, cut.at("tetrahedra"));
  const auto names = section("c.msh", "PhysicalNames");
  for (const char* name : {"\"cell0\"", "\"cell9\"", "\"x min\"", "\"z max\"", "\"cell0 | cell"}) {
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const std::string& line) {
      return line.find(name) != std::string::npos;
    })) << name;
  }
  EXPECT_EQ(groups.size() + 1, names.size());
  // Volumes are those of the mesh.
  std::map<std::string, std::map<std::string, double>> volumes;
  for (const auto& row : figures.at("ledger")) volumes[row.at("of")][row.at("material")] = row.at("volume");
  for (const auto& [material, volume] : volumes.at("mesh"))
    EXPECT_NEAR(volumes.at("cut mesh").at(material), volume, 1e-9);
  // The saved hierarchy leads to the same mesh, without the figures that need the input.
  run_well({"select", "h.h5", "--cut-mesh", "s.exo", "--json", "s.json"});
  const auto selected = read_json("s.json").at("cut_mesh");
  EXPECT_TRUE(selected.at("to_input").is_null());
  EXPECT_GT(selected.at("dihedral_min"), 5);
  EXPECT_EQ(read("s.exo").substr(0, 3), "CDF");
}

/// The tetrahedra of a mesh and the number of points, as VTK reads them.
struct ReadMesh {
  std::vector<std::array<vtkIdType, 4>> tetrahedra;
  std::vector<double> material, body;
  vtkIdType points = 0;
};

ReadMesh read_mesh(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ReadMesh mesh;
  mesh.points = grid->GetNumberOfPoints();
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    auto& corners = mesh.tetrahedra.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) corners[i] = grid->GetCell(c)->GetPointId(static_cast<int>(i));
    mesh.material.push_back(grid->GetCellData()->GetArray("material")->GetTuple1(c));
    mesh.body.push_back(grid->GetCellData()->GetArray("body")->GetTuple1(c));
  }
  return mesh;
}

/// For a solver that reads points by their numbers, bodies are connected by default, and separate when their
/// points are split. Open faces are those of the domain's sides, and then those between bodies too. A second
/// file lists both kinds.
TEST_F(CutMesh, BodiesShareTheirPointsUnlessTheyAreSplit) {
  const std::vector<std::string> resample{"resample", "scene.vtr", "--interface-error", "8%", "--cut-mesh"};
  const auto cut = [&](const std::string& file, const std::vector<std::string>& more) {
    auto arguments = resample;
    arguments.push_back(file);
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(arguments);
  };
  cut("shared.vtu", {"--ledger", "shared.csv"});
  cut("split.vtu", {"--ledger", "split.csv", "--split-bodies"});
  cut("shared.msh", {});
  cut("split.msh", {"--split-bodies"});
  const ReadMesh shared = read_mesh(folder() / "shared.vtu"), split = read_mesh(folder() / "split.vtu");
  EXPECT_EQ(shared.body, split.body);
  EXPECT_EQ(read("shared.csv"), read("split.csv"));
  EXPECT_EQ(section("shared.msh", "Nodes").at(0), std::to_string(shared.points));
  EXPECT_EQ(section("split.msh", "Nodes").at(0), std::to_string(split.points));
  for (const auto& [mesh, name] : {std::pair(&shared, "shared"), std::pair(&split, "split")}) {
    std::map<std::array<vtkIdType, 3>, int> faces;
    for (const auto& t : mesh->tetrahedra) {
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<vtkIdType, 3> face{t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]};
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
    const auto open = std::count_if(faces.begin(), faces.end(), [](const auto& f) { return f.second == 1; });
    const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
    const std::string beside = (folder() / (std::string(name) + "-faces.vtp")).string();
    reader->SetFileName(beside.c_str());
    reader->Update();
    vtkPolyData* surface = reader->GetOutput();
    vtkIdType sides = 0;
    for (vtkIdType f = 0; f < surface->GetNumberOfCells(); ++f)
      sides += surface->GetCellData()->GetArray("group")->GetTuple1(f) < 6 ? 1 : 0;
    EXPECT_GT(surface->GetNumberOfCells(), sides);
    EXPECT_EQ(open, mesh == &shared ? sides : surface->GetNumberOfCells()) << name;
  }
  EXPECT_EQ(run({"resample", "scene.vtr", "-o", "m.vtu", "--split-bodies"}).status, 2);
  EXPECT_EQ(run({"resample", "scene.vtr", "--cut-mesh", "c.vtu", "--interfaces-out", "c-faces.vtp"}).status,
            2);
}

TEST_F(CutMesh, ErrorsAndThreads) {
  const std::vector<std::string> resample{"resample", "scene.vtr", "--interface-error", "5%", "--cut-mesh"};
  const auto with = [&](std::vector<std::string> more) {
    auto arguments = resample;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  run_well(with({"coarse.msh", "--cut-error", "3%", "--threads", "1", "--json", "coarse.json"}));
  run_well(with({"fine.msh", "--cut-error", "1%", "--json", "fine.json"}));
  run_well(with({"again.msh", "--cut-error", "3%", "--threads", "3"}));
  EXPECT_TRUE(read("coarse.msh") == read("again.msh"));
  const auto distance = [&](const std::string& file) {
    return read_json(file).at("cut_mesh").at("to_mesh").at("interface_error").get<double>();
  };
  EXPECT_LT(distance("fine.json"), distance("coarse.json"));
  EXPECT_EQ(run({"resample", "scene.vtr", "-o", "m.vtu", "--cut-error", "1%"}).status, 2);
  EXPECT_EQ(run(with({"c.vtu", "--cut-error", "0"})).status, 2);
  EXPECT_EQ(run(with({"c.vtu", "--cut-error", "-1%"})).status, 2);
  EXPECT_EQ(run(with({"c.mesh"})).status, 2);
}

}  // namespace

}  // namespace adamas::test
