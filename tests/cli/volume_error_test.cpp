// Tests what --volume-error promises, with sums that VTK makes of the files, and the messages about errors
// that cannot be reached.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "program.h"
#include "vtk_ledger.h"

namespace adamas::test {

namespace {

class VolumeErrors : public ProgramTest {
 protected:
  /// Writes balls of radius 3, each with a label of its own: in 20 x 20 x 20 voxels eight, in one row of 20 x
  /// 10 x 10 two.
  void write_balls(int rows = 2) {
    const int side = 10 * rows;
    std::string labels;
    for (int i = 0; i < 20 * side * side; ++i) {
      const int x = i % 20, y = i / 20 % side, z = i / (20 * side);
      const double dx = x % 10 - 4.2, dy = y % 10 - 4.5, dz = z % 10 - 4.9;
      const int ball = 1 + x / 10 + 2 * (y / 10) + 4 * (z / 10);
      const int label = dx * dx + dy * dy + dz * dz <= 9 ? ball : 0;
      labels += static_cast<char>(label);
      counts_[label] += 1;
    }
    write("balls.nrrd",
          fmt::format("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 {0} {0}\nencoding: raw\n\n", side) +
              labels);
  }

  /// Returns the arguments of `resample` for the balls, and more.
  static std::vector<std::string> resample(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"resample",          "balls.nrrd", "--labels", "balls.nrrd", "--cells",
                                       "--interface-error", "6%",         "--json",   "j.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::map<int, double> counts_;  ///< voxels by label
};

}  // namespace

TEST_F(VolumeErrors, AreThoseOfTheFile) {
  write_balls();
  ASSERT_EQ(run(resample({})).status, 0);
  const auto without = read_json("j.json");
  EXPECT_TRUE(without.at("volume_error_target").is_null());
  EXPECT_GT(without.at("volume_error"), 0.05);

  const RunResult result = run(resample({"--volume-error", "1%", "--cut-mesh", "cut.vtu"}));
  ASSERT_EQ(result.status, 0) << result.err;
  const auto figures = read_json("j.json");
  EXPECT_EQ(figures.at("volume_error_target"), 0.01);
  EXPECT_LE(figures.at("volume_error"), 0.01);
  EXPECT_EQ(figures.at("volume_error_reached"), true);
  EXPECT_TRUE(figures.at("missed_volumes").empty());
  EXPECT_EQ(figures.at("lost_bodies"), 0);
  EXPECT_LE(figures.at("interface_error"), figures.at("interface_error_target"));
  EXPECT_NE(result.out.find("volume error of bodies wanted"), std::string::npos) << result.out;
  const auto ledger = cut_mesh_ledger(folder() / "cut.vtu", "");
  ASSERT_EQ(ledger.size(), 9u);
  for (const auto& material : figures.at("materials")) {
    const std::string name = material.at("name");
    SCOPED_TRACE(name);
    const double voxels = counts_.at(std::stoi(name.substr(name.find_first_of("0123456789"))));
    EXPECT_EQ(material.at("volume_input"), voxels);
    EXPECT_NEAR(ledger.at(name).volume, voxels, 0.01 * voxels);
  }
}

TEST_F(VolumeErrors, WhatCannotBeHadIsNamed) {
  write_balls();
  const RunResult result = run(resample({"--volume-error", "0.01%", "--max-tetrahedra", "3000"}));
  ASSERT_EQ(result.status, 3) << result.err;
  EXPECT_NE(result.err.find("the volume error wanted was not reached: a body of '"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("3000 tetrahedra"), std::string::npos) << result.err;
  const auto figures = read_json("j.json");
  EXPECT_LE(figures.at("tetrahedra"), 3000);
  EXPECT_EQ(figures.at("volume_error_reached"), false);
  EXPECT_GT(figures.at("volume_error"), 0.0001);
  double greatest = 0;
  for (const auto& body : figures.at("missed_volumes")) {
    EXPECT_EQ(body.at("place").size(), 3u);
    EXPECT_FALSE(body.at("reason").get<std::string>().empty());
    const double wanted = body.at("volume_input"), found = body.at("volume_mesh");
    greatest = std::max(greatest, std::abs(found - wanted) / wanted);
  }
  EXPECT_EQ(figures.at("volume_error"), greatest);
}

TEST_F(VolumeErrors, OfSeriesAndExperimentsToo) {
  write_balls(1);
  const RunResult series = run({"resample", "balls.nrrd", "balls.nrrd", "--labels", "balls.nrrd", "--cells",
                                "--interface-error", "6%", "--volume-error", "3%", "--json", "s.json"});
  ASSERT_EQ(series.status, 0) << series.err;
  const auto figures = read_json("s.json");
  for (const auto& step : figures.at("steps")) EXPECT_LE(step.at("volume_error"), 0.03);
  write("e.toml", "labels = balls.nrrd\ncells = true\ninterface-error = 6%\nvolume-error = 3%\n");
  const RunResult experiment = run({"experiment", "balls.nrrd", "-c", "e.toml", "-o", "out"});
  ASSERT_EQ(experiment.status, 0) << experiment.err;
  EXPECT_LE(read_json("out/metrics.json").at("mesh").at("volume_error"), 0.03);
}

TEST_F(VolumeErrors, AbsurdOnesAreRefused) {
  make_scene("sphere", 4);
  for (const std::string error :
       {"0%", "-1%", "nan%", "inf%", "100%", "1", "0.01", "%", "abc", "1 %", "1e999%"}) {
    expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--volume-error=" + error},
                       {"--volume-error: expected a part above 0% and below 100% as 1%", "'" + error + "'"});
  }
}

TEST_F(VolumeErrors, OpenInterfacesHaveNone) {
  write("open.off", "OFF\n3 1 0\n0.2 0.2 0.5\n0.8 0.2 0.5\n0.5 0.8 0.5\n3 0 1 2\n");
  const RunResult result = run({"resample", "--interface", "open.off=a,b", "--box", "0,1,0,1,0,1",
                                "--interface-error", "5%", "--volume-error", "1%", "-o", "m.vtu"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("open.off: --volume-error: expected interfaces that enclose volumes, found open"),
            std::string::npos)
      << result.err;
}

}  // namespace adamas::test
