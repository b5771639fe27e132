// Tests the ledger of `resample`, and what --conserve promises; both are recomputed from the files with VTK.

#include <cmath>
#include <sstream>
#include <string>

#include "program.h"
#include "vtk_ledger.h"

namespace adamas::test {

namespace {

class Ledgers : public ProgramTest {
 protected:
  void resample_scene(const std::vector<std::string>& more) {
    ASSERT_EQ(run({"generate", "scene", "voronoi10", "--dimensions", "10,10,10", "-o", "scene.vtr"}).status,
              0);
    std::vector<std::string> arguments{"resample",    "scene.vtr", "--interface-error", "3%",
                                       "-o",          "mesh.vtu",  "--cut-mesh",        "cut.vtu",
                                       "--cut-error", "0.5%",      "--ledger",          "ledger.csv",
                                       "--json",      "j.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  }
};

}  // namespace

TEST_F(Ledgers, AreThoseOfTheFiles) {
  resample_scene({});
  const auto input = grid_ledger(folder() / "scene.vtr", "linear");
  const auto cut = cut_mesh_ledger(folder() / "cut.vtu", "linear");
  const auto rows = read_json("j.json").at("ledger");
  ASSERT_EQ(rows.size(), 3 * input.size());
  for (const auto& row : rows) {
    const std::string of = row.at("of"), material = row.at("material");
    SCOPED_TRACE(of + " " + material);
    // The mesh with whole cells has the volumes of the cut mesh, and almost its masses, since snapping moves
    // a little of each material.
    const LedgerEntry& expected = of == "input" ? input.at(material) : cut.at(material);
    EXPECT_NEAR(row.at("volume").get<double>(), expected.volume, 1e-9);
    EXPECT_NEAR(row.at("integrals").at("linear").get<double>(), expected.mass,
                (of == "mesh" ? 1e-3 : 1e-7) * std::abs(expected.mass));
  }
  std::istringstream lines(read("ledger.csv"));
  std::string line;
  std::size_t count = 0;
  while (std::getline(lines, line)) ++count;
  EXPECT_EQ(count, 1 + rows.size());
}

TEST_F(Ledgers, AgreeWhereVolumesAreConserved) {
  resample_scene({"--conserve"});
  const auto input = grid_ledger(folder() / "scene.vtr", "linear");
  const auto cut = cut_mesh_ledger(folder() / "cut.vtu", "linear");
  for (const auto& [material, entry] : input)
    EXPECT_NEAR(cut.at(material).volume, entry.volume, 1e-9) << material;
  const auto figures = read_json("j.json");
  EXPECT_TRUE(figures.at("conserved").get<bool>());
  EXPECT_LE(figures.at("interface_error_per_material"), figures.at("interface_error_target"));
  for (const char* count : {"lost_bodies", "lost_materials", "changed_bodies", "contacts"})
    EXPECT_EQ(figures.at(count), 0) << count;
}

TEST_F(Ledgers, OpenInterfacesCannotBeConserved) {
  write("open.off", "OFF\n3 1 0\n0.2 0.2 0.5\n0.8 0.2 0.5\n0.5 0.8 0.5\n3 0 1 2\n");
  const RunResult result = run({"resample", "--interface", "open.off=a,b", "--box", "0,1,0,1,0,1",
                                "--interface-error", "5%", "--conserve", "-o", "m.vtu"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("open.off: --conserve: expected interfaces that enclose volumes"),
            std::string::npos)
      << result.err;
}

}  // namespace adamas::test
