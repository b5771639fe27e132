// Runs commands on HDF5 whose data sets a configuration file names.

#include <fmt/format.h>

#include "tests/cli/program.h"
#include "tests/support/hdf5_file.h"
#include "tests/support/hexahedra.h"

namespace adamas {

namespace {

class Hdf5LayoutCommands : public test::ProgramTest {
 protected:
  /// Writes hexahedra that count from 1, with water that rises by a layer of cells from one of three steps to
  /// the next.
  Hdf5LayoutCommands() {
    const auto cube = test::make_hexahedra({4, 4, 6}, [](const Vec3& p) { return test::jittered(p, 0.02); });
    const PolyhedralMesh mesh = test::to_mesh(cube);
    test::Hdf5File file(folder() / "run.h5");
    std::vector<double> points;
    for (const Vec3& p : cube.points) points.insert(points.end(), {p.x, p.y, p.z});
    std::vector<std::int32_t> cells;
    for (const auto& cell : cube.cells) {
      for (const auto p : cell) cells.push_back(static_cast<std::int32_t>(p) + 1);
    }
    file.add("mesh/coordinates", {cube.points.size(), 3}, StoredType::kFloat64, points.data());
    file.add("mesh/connectivity", {cube.cells.size(), 8}, StoredType::kInt32, cells.data());
    for (std::size_t step = 0; step < 3; ++step) {
      std::vector<double> water;
      for (std::size_t c = 0; c < cube.cells.size(); ++c)
        water.push_back(c / 16 <= step ? 1 : c / 16 == step + 1 ? 0.5 : 0);
      const std::string group = fmt::format("results/step_{:04}", step);
      file.add(group + "/vof/water", {water.size()}, StoredType::kFloat64, water.data());
      file.add_numbers(group, "time", {0.5 * static_cast<double>(step)});
      volumes_.push_back(0);
      for (std::size_t c = 0; c < water.size(); ++c) volumes_.back() += water[c] * mesh.cell_volume(c);
    }
    write("run.toml",
          "hdf5 = [\"nodes=mesh/coordinates\", \"cells=mesh/connectivity\", \"base=1\", "
          "\"steps=results/step_*\"]\nfraction = [\"water=vof/water\"]\nrest = \"air\"\n");
  }

  std::vector<double> volumes_;  // of water, per step
};

TEST_F(Hdf5LayoutCommands, AConfigurationFileSaysWhatDataSetsAre) {
  run_well({"info", "run.h5", "--time", "2", "-c", "run.toml", "--json", "info.json"});
  const auto info = read_json("info.json");
  EXPECT_EQ(info["cells"], 96);
  EXPECT_EQ(info["times"], (std::vector<double>{0, 0.5, 1}));
  EXPECT_NEAR(info["materials"][0]["volume"].get<double>(), volumes_[2], 1e-6);
  run_well({"resample", "run.h5", "-c", "run.toml", "--interface-error", "5%", "-o", "out.pvd", "--json",
            "run.json"});
  const auto figures = read_json("run.json");
  ASSERT_EQ(figures["steps"].size(), 3u);
  for (std::size_t step = 0; step < 3; ++step)
    EXPECT_NEAR(figures["steps"][step]["materials"][0]["volume_input"].get<double>(), volumes_[step], 1e-5);
}

TEST_F(Hdf5LayoutCommands, WrongNamesAreAnsweredInOneLine) {
  expect_wrong_usage({"info", "run.h5", "--hdf5", "knots=mesh/coordinates"}, {"--hdf5", "knots"});
  write("b.toml", "hdf5 = [\"nodes=mesh/xyz\", \"cells=mesh/connectivity\"]\n");
  expect_failure({"info", "run.h5", "-c", "b.toml"}, {"run.h5", "--hdf5 nodes", "'mesh/coordinates'"});
}

}  // namespace
}  // namespace adamas
