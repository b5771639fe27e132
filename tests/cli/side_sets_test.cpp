// Tests the side sets of an ExodusII file as commands tell and write them.

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <array>
#include <map>

#include "program.h"

namespace adamas::test {

namespace {

/// The side sets of a cut mesh are the sides of its box and the interfaces.
class SideSets : public ProgramTest {
 protected:
  SideSets() {
    make_scene("sphere", 6);
    run_well({"resample", "scene.vtr", "--interface-error", "8%", "--cut-mesh", "cut.exo"});
  }

  /// The area of the polygons of each set of a file.
  [[nodiscard]] std::map<int, double> areas_of(const std::string& name) const {
    const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
    reader->SetFileName((folder() / name).c_str());
    reader->Update();
    vtkPolyData& surfaces = *reader->GetOutput();
    vtkDataArray* const sets = surfaces.GetCellData()->GetArray("side_set");
    std::map<int, double> areas;
    for (vtkIdType c = 0; sets != nullptr && c < surfaces.GetNumberOfCells(); ++c)
      areas[static_cast<int>(sets->GetTuple1(c))] += vtkPolygon::ComputeArea(
          surfaces.GetPoints(), surfaces.GetCell(c)->GetNumberOfPoints(),
          surfaces.GetCell(c)->GetPointIds()->GetPointer(0), std::array<double, 3>{}.data());
    return areas;
  }
};

TEST_F(SideSets, AreToldAndWritten) {
  const auto told = run({"info", "cut.exo", "--json", "info.json"});
  EXPECT_EQ(told.status, 0) << told.err;
  const nlohmann::json figures = read_json("info.json");
  const nlohmann::json& sets = figures.at("sets");
  ASSERT_GT(sets.size(), 6u);
  const nlohmann::json& box = figures.at("box");
  for (std::size_t n = 0; n < 6; ++n) {
    const auto length = [&](std::size_t axis) {
      const std::size_t other = (n / 2 + axis) % 3;
      return box[2 * other + 1].get<double>() - box[2 * other].get<double>();
    };
    EXPECT_EQ(sets[n].at("of"), "sides");
    EXPECT_NEAR(sets[n].at("area").get<double>(), length(1) * length(2), 1e-5) << sets[n].at("name");
  }
  EXPECT_EQ(sets[0].at("name"), "x min");
  for (const auto& set : sets) EXPECT_NE(told.out.find(set.at("name").get<std::string>()), std::string::npos);

  const auto reconstructed = run({"reconstruct", "cut.exo", "--side-sets", "sides.vtp"});
  EXPECT_EQ(reconstructed.status, 0) << reconstructed.err;
  const auto resampled = run({"resample", "cut.exo", "--interface-error", "20%", "--side-sets", "again.vtp"});
  EXPECT_EQ(resampled.status, 0) << resampled.err;
  EXPECT_TRUE(read("sides.vtp") == read("again.vtp"));
  const std::map<int, double> areas = areas_of("sides.vtp");
  ASSERT_EQ(areas.size(), sets.size());
  for (const auto& [set, area] : areas)
    EXPECT_NEAR(area, sets[static_cast<std::size_t>(set)].at("area").get<double>(), 1e-5);
}

/// The areas that sets of an input have, by name.
std::map<std::string, double> areas_by_name(const nlohmann::json& figures) {
  std::map<std::string, double> areas;
  for (const auto& set : figures.at("sets"))
    areas[set.at("name").get<std::string>()] = set.at("area").get<double>();
  return areas;
}

/// The cut mesh of data with side sets has these as groups of faces, beside the sides of the box and the
/// interfaces, with the areas that they have in the input.
TEST_F(SideSets, AreGroupsOfFacesOfTheCutMesh) {
  EXPECT_EQ(run({"info", "cut.exo", "--json", "info.json"}).status, 0);
  const auto given = areas_by_name(read_json("info.json"));
  EXPECT_EQ(run({"resample", "cut.exo", "--interface-error", "1%", "--cut-mesh", "again.exo"}).status, 0);
  EXPECT_EQ(run({"info", "again.exo", "--json", "info.json"}).status, 0);
  const auto found = areas_by_name(read_json("info.json"));
  ASSERT_EQ(found.size(), 2 * given.size());
  for (const auto& [name, area] : given) {
    const auto input = found.find(name + " (input)");
    ASSERT_NE(input, found.end()) << name;
    EXPECT_NEAR(input->second, found.at(name), 1e-9 * area) << "here each set is a whole group";
    EXPECT_NEAR(input->second, area, 0.1 * area) << name;
  }
  // Gmsh's files have them as physical groups.
  EXPECT_EQ(run({"resample", "cut.exo", "--interface-error", "10%", "--cut-mesh", "again.msh"}).status, 0);
  EXPECT_NE(read("again.msh").find("\"x min (input)\""), std::string::npos);
}

TEST_F(SideSets, AreWantedOfFilesThatHaveThem) {
  expect_wrong_usage({"reconstruct", "scene.vtr", "--side-sets", "sides.vtp"},
                     {"--side-sets: expected an INPUT with side sets or node sets", "scene.vtr"});
  expect_wrong_usage({"reconstruct", "cut.exo", "--side-sets", "sides.stl"}, {"--side-sets", ".vtp"});
  expect_wrong_usage({"resample", "scene.vtr", "scene.vtr", "-o", "m.pvd", "--side-sets", "sides.vtp"},
                     {"--side-sets: expected one data set, found a series of 2"});
}

}  // namespace

}  // namespace adamas::test
