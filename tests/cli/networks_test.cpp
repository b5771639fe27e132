// Tests interfaces as INPUT of commands, and the options that describe them.

#include <array>
#include <cmath>
#include <numbers>

#include "program.h"

namespace adamas::test {

namespace {

constexpr double kRadius = 0.35;
constexpr double kSphere = 4.0 / 3 * std::numbers::pi * kRadius * kRadius * kRadius;

class Networks : public ProgramTest {
 protected:
  Networks() {
    run_well({"generate", "scene", "sphere", "--dimensions", "8", "-o", "scene.vtr", "--interfaces",
              "net.vtp", "--resolution", "0.02"});
  }
  [[nodiscard]] double volume(const nlohmann::json& figures, const std::string& material,
                              const std::string& key) const {
    for (const auto& each : figures.at("materials")) {
      if (each.at("name") == material) return each.at(key).get<double>();
    }
    ADD_FAILURE() << "no " << material;
    return 0;
  }
};

TEST_F(Networks, ProbeTellsVolumesAndAreas) {
  const RunResult result = run_well({"probe", "net.vtp", "--box", "0,1,0,1,0,1", "--json", "j.json"});
  EXPECT_NE(result.out.find("outside | inside"), std::string::npos) << result.out;
  const auto figures = read_json("j.json");
  EXPECT_NEAR(volume(figures, "inside", "volume"), kSphere, 2e-3 * kSphere);
  EXPECT_NEAR(volume(figures, "outside", "volume") + volume(figures, "inside", "volume"), 1, 1e-9);
  const double area = 4 * std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(figures.at("interfaces")[0].at("area").get<double>(), area, 2e-3 * area);
  // Open interfaces enclose no volumes, and a note says so.
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  const RunResult open = run({"probe", "--interface", "open.obj=air,metal", "--json", "o.json"});
  EXPECT_EQ(open.status, 0) << open.err;
  EXPECT_NE(open.err.find("not closed"), std::string::npos) << open.err;
  EXPECT_TRUE(read_json("o.json").at("materials")[0].at("volume").is_null());
}

/// Interfaces that end at opposite faces of their own box fill it; others get a margin.
TEST_F(Networks, DomainIsTheBoxThatInterfacesFill) {
  const auto domain = [&](const std::string& file) {
    run_well({"probe", file, "--json", "j.json"});
    const auto figures = read_json("j.json");
    double sum = 0;
    for (const auto& material : figures.at("materials")) sum += material.at("volume").get<double>();
    return sum;
  };
  run_well({"generate", "scene", "voronoi10", "--dimensions", "8", "-o", "v.vtr", "--interfaces", "v.vtp"});
  EXPECT_NEAR(domain("v.vtp"), 1, 1e-9);
  EXPECT_NEAR(domain("net.vtp"), std::pow(1.1 * 2 * kRadius, 3), 1e-3);
}

TEST_F(Networks, ReconstructChecksAndWritesThemAnew) {
  run_well({"reconstruct", "net.vtp", "--box", "0,1,0,1,0,1", "-o", "again.vtp", "--picture", "p.png",
            "--json", "j.json"});
  EXPECT_NEAR(volume(read_json("j.json"), "inside", "volume_reconstructed"), kSphere, 2e-3 * kSphere);
  run_well({"info", "net.vtp", "--json", "before.json"});
  run_well({"info", "again.vtp", "--json", "after.json"});
  EXPECT_EQ(read_json("before.json").at("interfaces"), read_json("after.json").at("interfaces"));
  expect_wrong_usage({"reconstruct", "scene.vtr", "--tolerant", "-o", "r.vtp"}, {"--tolerant"});
}

TEST_F(Networks, SlicesHaveTheAreasOfTheirMaterials) {
  std::array<double, 3> areas{};
  const std::array<const char*, 3> planes{"z=0.3", "z=0.5", "z=0.7"};
  for (std::size_t i = 0; i < 3; ++i) {
    run_well({"slice", "net.vtp", "--box", "0,1,0,1,0,1", "--plane", planes[i], "-o", "s.png", "--json",
              "j.json"});
    const auto figures = read_json("j.json");
    areas[i] = volume(figures, "inside", "area");
    EXPECT_NEAR(figures.at("area").get<double>(), 1, 1e-9);
  }
  // The section of a ball with the centre c has the area pi (r^2 - (z - c)^2).
  const double bend = areas[0] - 2 * areas[1] + areas[2], slope = 0.5 * (areas[2] - areas[0]);
  EXPECT_NEAR(bend, -2 * std::numbers::pi * 0.04, 2e-3);
  EXPECT_NEAR(areas[1] - 0.5 * slope * slope / bend, std::numbers::pi * kRadius * kRadius, 1e-3);
  run_well({"slice", "net.vtp", "--plane", "z=0.6", "-o", "s.vtp"});
  expect_failure({"slice", "net.vtp", "--plane", "z=0.6", "--field", "heat", "-o", "t.png"},
                 {"net.vtp", "'heat'"});
  expect_failure({"slice", "net.vtp", "--plane", "z=7", "-o", "t.png"}, {"net.vtp", "plane that cuts"});
  expect_wrong_usage({"slice", "scene.vtr", "--plane", "z=0.5", "--tolerant", "-o", "t.png"}, {"--tolerant"});
}

TEST_F(Networks, ResamplingStatesTheirVolumes) {
  run_well({"resample", "net.vtp", "--box", "0,1,0,1,0,1", "--interface-error", "3%", "--json", "j.json"});
  const auto figures = read_json("j.json");
  EXPECT_NEAR(volume(figures, "inside", "volume_input"), kSphere, 2e-3 * kSphere);
}

TEST_F(Networks, RefusalsNameTheOptionThatTakesThem) {
  const std::string tetrahedra =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
      "v .1 .1 .1\nv 1.1 .1 .1\nv .1 1.1 .1\nv .1 .1 1.1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
  write("crossed.obj", tetrahedra);
  for (const std::string command : {"resample", "probe", "reconstruct"}) {
    std::vector<std::string> arguments{command, "--interface", "crossed.obj=air,metal"};
    if (command == "resample")
      arguments.insert(arguments.end(), {"--interface-error", "20%", "--json", "m.json"});
    if (command == "reconstruct") arguments.insert(arguments.end(), {"-o", "m.vtp"});
    expect_failure(arguments, {"crossed.obj", "pairs that intersect", "--tolerant"});
    arguments.emplace_back("--tolerant");
    EXPECT_EQ(run(arguments).status, 0);
  }
  // An error that no option would lift does not name one.
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  const RunResult flat = run({"probe", "--interface", "flat.obj=air,metal"});
  EXPECT_EQ(flat.err.find("--tolerant"), std::string::npos) << flat.err;
}

TEST_F(Networks, ErrorsInVoxelsAreThoseOfTheGrid) {
  run_well({"resample", "scene.vtr", "--interface-error", "0.5voxels", "--json", "voxels.json"});
  run_well({"resample", "scene.vtr", "--interface-error", "0.0625", "--json", "length.json"});
  const auto voxels = read_json("voxels.json"), length = read_json("length.json");
  EXPECT_EQ(voxels.at("interface_error_target").get<double>(), 0.0625);
  EXPECT_EQ(voxels.at("tetrahedra"), length.at("tetrahedra"));
  run_well({"resample", "scene.vtr", "--interface-error", "0.5 cells", "--json", "cells.json"});
  EXPECT_EQ(read_json("cells.json").at("tetrahedra"), length.at("tetrahedra"));
  expect_wrong_usage({"resample", "net.vtp", "--interface-error", "1voxel", "--json", "n.json"},
                     {"--interface-error", "net.vtp", "no grid"});
  expect_wrong_usage({"resample", "scene.vtr", "--interface-error", "voxels", "--json", "n.json"},
                     {"'voxels'"});
  expect_wrong_usage({"resample", "scene.vtr", "--interface-error", "9999voxels", "--json", "n.json"},
                     {"--interface-error", "diagonal", "9999voxels"});
}

TEST_F(Networks, AnErrorThatIsNotReachedHasAReasonAndAPlace) {
  const RunResult result = run({"resample", "scene.vtr", "--interface-error", "0.5%", "--field-error",
                                "smooth=0.01%", "--max-tetrahedra", "300", "--json", "j.json"});
  EXPECT_EQ(result.status, 3) << result.err;
  const auto lines = result.err_lines();
  ASSERT_EQ(lines.size(), 2u) << result.err;
  for (const std::string& line : lines) EXPECT_NE(line.find(", at ("), std::string::npos) << line;
  EXPECT_NE(lines[0].find("no more than 300 tetrahedra"), std::string::npos) << lines[0];
  const auto figures = read_json("j.json");
  const auto& shortfall = figures.at("interface_error_shortfall");
  ASSERT_EQ(shortfall.at("place").size(), 3u);
  // The place is near the sphere.
  double squared = 0;
  for (const auto& c : shortfall.at("place")) squared += std::pow(c.get<double>() - 0.5, 2);
  EXPECT_NEAR(std::sqrt(squared), kRadius, 0.1);
  EXPECT_FALSE(figures.at("fields").at("smooth").at("shortfall").is_null());
  EXPECT_TRUE(figures.at("fields").at("linear").at("shortfall").is_null());
}

TEST_F(Networks, FractionsFromFilesNeedNoInput) {
  const auto inside = [](std::size_t i) { return i % 6 < 3 ? 1.0f : 0.0f; };
  write_image("a.nrrd", 6, inside);
  write_image("b.nrrd", 6, [&](std::size_t i) { return 1 - inside(i); });
  write_image("f.nrrd", 6, [](std::size_t i) { return static_cast<float>(i); });
  const std::vector<std::string> named{"--fraction", "one=a.nrrd", "--fraction",
                                       "two=b.nrrd", "--field",    "heat=f.nrrd"};
  const auto with = [&named](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), named.begin(), named.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const auto status = [this](const std::vector<std::string>& arguments) {
    const RunResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
  };
  status(with({"resample"}, {"--interface-error", "4%", "--json", "without.json", "-o", "without.vtu"}));
  status(with({"resample", "a.nrrd"}, {"--interface-error", "4%", "--json", "with.json", "-o", "with.vtu"}));
  auto without = read_json("without.json"), given = read_json("with.json");
  for (auto* figures : {&without, &given}) {
    for (const char* cost : {"seconds", "processor_seconds", "peak_memory_bytes"}) figures->erase(cost);
  }
  EXPECT_EQ(without, given);
  EXPECT_EQ(read("without.vtu"), read("with.vtu"));
  ASSERT_EQ(without.at("fields").size(), 1u);
  status(with({"reconstruct"}, {"-o", "r.vtp"}));
  status(with({"probe"}, {"--json", "p.json"}));
  status(with({"slice"}, {"--plane", "z=2", "-o", "s.png"}));
  status(with({"experiment"}, {"--interface-error", "6%", "-o", "out"}));
  expect_wrong_usage({"resample", "--json", "n.json"}, {"INPUT", "--fraction"});
  expect_wrong_usage({"probe"}, {"INPUT"});
  expect_wrong_usage({"slice", "--plane", "z=2", "-o", "n.png"}, {"INPUT"});
  expect_wrong_usage({"reconstruct", "-o", "n.vtp"}, {"INPUT"});
  // An output that would overwrite one of the inputs is refused.
  expect_wrong_usage({"reconstruct", "--fraction", "one=r.vtp", "--rest", "two", "-o", "r.vtp"},
                     {"-o", "no input"});
}

}  // namespace
}  // namespace adamas::test
