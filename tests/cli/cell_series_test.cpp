// Runs commands on simulations on meshes of cells: series, times, fields in slices, integrals.

#include <fmt/format.h>

#include "tests/cli/program.h"
#include "tests/support/foam_case.h"
#include "tests/support/hexahedra.h"

namespace adamas {

namespace {

/// A case of three times: water rises by a layer of cells from one to the next.
class CellSeries : public test::ProgramTest {
 protected:
  CellSeries() {
    const PolyhedralMesh mesh =
        test::to_mesh(test::make_hexahedra({4, 4, 6}, [](const Vec3& p) { return test::jittered(p, 0.02); }));
    test::write_foam_case(folder(), mesh);
    for (std::size_t step = 0; step < 3; ++step) {
      std::vector<double> water, pressure;
      for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
        water.push_back(c / 16 <= step ? 1 : c / 16 == step + 1 ? 0.5 : 0);
        pressure.push_back(mesh.cell_center(c).z);
      }
      test::write_foam_field(folder() / fmt::format("{:g}", 0.5 * static_cast<double>(step)), "alpha.water",
                             water);
      test::write_foam_field(folder() / fmt::format("{:g}", 0.5 * static_cast<double>(step)), "p", pressure);
      volumes_.push_back(0);
      for (std::size_t c = 0; c < mesh.cell_count(); ++c) volumes_.back() += water[c] * mesh.cell_volume(c);
    }
  }

  std::vector<double> volumes_;  // of water, per step
  const std::vector<std::string> what_{"case.foam", "--fraction", "water=alpha.water", "--rest", "air"};

  [[nodiscard]] std::vector<std::string> command(const std::string& name,
                                                 const std::vector<std::string>& options) const {
    std::vector<std::string> all{name};
    all.insert(all.end(), what_.begin(), what_.end());
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }
};

TEST_F(CellSeries, AllTimesAreResampledWhereTheOutputIsAList) {
  run_well(command("resample", {"--interface-error", "5%", "-o", "out.pvd", "--json", "run.json"}));
  EXPECT_EQ(files().count("out_0002.vtu"), 1u);
  const auto figures = read_json("run.json");
  ASSERT_EQ(figures["steps"].size(), 3u);
  for (std::size_t step = 0; step < 3; ++step) {
    EXPECT_EQ(figures["steps"][step]["time"], 0.5 * static_cast<double>(step));
    const auto& water = figures["steps"][step]["materials"][0];
    EXPECT_EQ(water["name"], "water");
    EXPECT_NEAR(water["volume_input"].get<double>(), volumes_[step], 1e-5);
    EXPECT_NEAR(water["volume_mesh"].get<double>(), volumes_[step], 0.03);
  }
}

TEST_F(CellSeries, OneTimeIsChosenByItsNumber) {
  run_well(command("resample",
                   {"--time", "0", "--interface-error", "5%", "-o", "first.vtu", "--json", "run.json"}));
  EXPECT_NEAR(read_json("run.json")["materials"][0]["volume_input"].get<double>(), volumes_[0], 1e-5);
  expect_failure(command("resample", {"--time", "3", "--interface-error", "5%", "-o", "none.vtu"}),
                 {"case.foam", "--time: expected a time from 0 to 2, found 3"});
  const auto told = run(command("info", {"--time", "1"}));
  EXPECT_EQ(told.status, 0);
  EXPECT_NE(told.out.find("3 steps, times from 0 to 1, 0.5 apart; this is number 1"), std::string::npos)
      << told.out;
}

/// Some per cent of a spray in all cells far from the water is named with its volume, and drawn where that is
/// wanted.
TEST_F(CellSeries, DispersedVolumeIsNamed) {
  std::vector<double> water(96), spray(96);
  for (std::size_t c = 0; c < water.size(); ++c) {
    water[c] = c < 16 ? 1 : 0;
    spray[c] = c < 16 ? 0 : 0.03 + 0.0002 * static_cast<double>(c);
  }
  test::write_foam_field(folder() / "1.5", "alpha.water", water);
  test::write_foam_field(folder() / "1.5", "alpha.spray", spray);
  const auto figures = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all = command(
        "reconstruct", {"--time", "3", "--fraction", "spray=alpha.spray", "-o", "s.vtp", "--json", "s.json"});
    all.insert(all.end(), options.begin(), options.end());
    const auto done = run(all);
    EXPECT_EQ(done.status, 0) << done.err;
    const nlohmann::json dispersed = read_json("s.json")["fractions"]["dispersed"];
    EXPECT_EQ(done.err.find("of 'spray' is dispersed") != std::string::npos, !dispersed.empty()) << done.err;
    return dispersed;
  };
  const nlohmann::json found = figures({});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["name"], "spray");
  EXPECT_GT(found[0]["volume"], 0.02);
  EXPECT_EQ(figures({"--keep-dispersed"}).size(), 0u);
  const auto refused = run(command("reconstruct", {"--smooth-labels", "-o", "s.vtp"}));
  EXPECT_NE(refused.err.find("--smooth-labels: expected labels on a grid as INPUT, found data on a mesh"),
            std::string::npos);
}

TEST_F(CellSeries, FieldsAreCutAndIntegrated) {
  const auto cut =
      run(command("slice", {"--plane", "x=0.5", "--field", "p", "--time", "1", "-o", "cut.png"}));
  EXPECT_EQ(cut.status, 0) << cut.err;
  const auto told = run(command("probe", {"--json", "probe.json", "--time", "2"}));
  EXPECT_EQ(told.status, 0) << told.err;
  const nlohmann::json probed = read_json("probe.json");
  const auto& water = probed["materials"][0];
  EXPECT_NEAR(water["volume"].get<double>(), volumes_[2], 1e-5);
}

/// Each picture of a series shows what that of its time alone does.
TEST_F(CellSeries, AllTimesAreCutWhereSeveralPicturesAreAsked) {
  const auto pictures = run(command("slice", {"--plane", "x=0.5", "-o", "f_%04d.png", "--json", "all.json"}));
  EXPECT_EQ(pictures.status, 0) << pictures.err;
  EXPECT_EQ(files().count("f_0000.png") + files().count("f_0001.png") + files().count("f_0002.png"), 3u);
  const auto polygons =
      run(command("slice", {"--plane", "x=0.5", "--steps", "1,2", "-o", "s.pvd", "--json", "some.json"}));
  EXPECT_EQ(polygons.status, 0) << polygons.err;
  EXPECT_EQ(files().count("s_0000.vtp"), 0u);
  EXPECT_EQ(files().count("s_0001.vtp") + files().count("s_0002.vtp"), 2u);
  const nlohmann::json all = read_json("all.json").at("steps"), some = read_json("some.json").at("steps");
  ASSERT_EQ(all.size(), 3u);
  ASSERT_EQ(some.size(), 2u);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto one = run(command(
        "slice", {"--plane", "x=0.5", "--time", std::to_string(n), "-o", "one.png", "--json", "one.json"}));
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(all[n].at("time"), 0.5 * static_cast<double>(n));
    EXPECT_EQ(all[n].at("materials"), read_json("one.json").at("materials"));
    if (n > 0) {
      EXPECT_EQ(some[n - 1].at("materials"), all[n].at("materials"));
    }
  }
  EXPECT_LT(all[0].at("materials")[0].at("area").get<double>(),
            all[2].at("materials")[0].at("area").get<double>());
}

TEST_F(CellSeries, PicturesOfOneTimeAndOfAllAreToldApart) {
  expect_wrong_usage(command("slice", {"--plane", "x=0.5", "--time", "1", "-o", "f_%04d.png"}),
                     {"--time: expected one picture as output, found f_%04d.png"});
  expect_wrong_usage(command("slice", {"--plane", "x=0.5", "--step", "1", "-o", "one.png"}),
                     {"--step: expected", "--time says which of its times"});
  expect_wrong_usage(command("slice", {"--plane", "x=0.5", "--steps", "1,3", "-o", "f_%04d.png"}),
                     {"--steps"});
}

TEST_F(CellSeries, ASeriesIsNotOneTime) {
  expect_failure({"resample", "case.foam", "--fraction", "water=alpha.water", "--rest", "air",
                  "--interface-error", "5%", "-o", "one.pvd", "--time", "1"},
                 {"case.foam", "expected several times for a series"});
  expect_wrong_usage(
      {"resample", "case.foam", "case.foam", "--time", "1", "--interface-error", "5%", "-o", "two.pvd"},
      {"--time: expected one data set, found a series of 2"});
}

TEST_F(CellSeries, PicturesAreAStackWhereThatIsAsked) {
  write_image("plane.nrrd", 3, [](std::size_t i) { return static_cast<float>(i % 2); });
  expect_wrong_usage(
      {"resample", "--stack", "plane.nrrd", "--labels", "plane", "--interface-error", "5%", "-o", "m.vtu"},
      {"--stack: expected a pattern of names in quotes", "plane.nrrd"});
  expect_wrong_usage(
      {"resample", "--stack", "a.tif", "b.tif", "--labels", "a", "--interface-error", "5%", "-o", "m.vtu"},
      {"--stack: expected one pattern in quotes, found 2 inputs"});
  // Grey pictures as text, of VTK's reader and of none: stacks are of TIFF and PNG.
  for (const char* name : {"l1.pgm", "l2.pgm"}) write(name, "P2\n2 2\n255\n0 1 1 0\n");
  expect_failure({"resample", "--stack", "l*.pgm", "--labels", "l", "--interface-error", "5%", "-o", "m.vtu"},
                 {"l1.pgm", "expected a picture, TIFF or PNG"});
}

TEST_F(CellSeries, OptionsOfMeshesAreRefusedForGrids) {
  write_image("grid.nrrd", 3, [](std::size_t i) { return static_cast<float>(i % 2); });
  expect_wrong_usage(
      {"resample", "grid.nrrd", "--labels", "grid", "--time", "1", "--interface-error", "5%", "-o", "m.vtu"},
      {"--time: expected a mesh of cells as INPUT"});
}

}  // namespace
}  // namespace adamas
