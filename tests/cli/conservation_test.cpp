// Tests whether volumes are conserved: by default for volume fractions alone, and as --conserve and
// --no-conserve say. Volumes are recomputed from the files with VTK.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "program.h"
#include "vtk_ledger.h"

namespace adamas::test {

namespace {

/// Volumes of the meshes below are compared to this; the domain has the volume 1.
constexpr double kConserved = 1e-9;

class Conservation : public ProgramTest {
 protected:
  /// Resamples the scene into NAME.vtu, and its figures into NAME.json.
  RunResult resample(const std::string& name, const std::vector<std::string>& more,
                     const std::string& error = "5%") {
    std::vector<std::string> arguments{"resample",    "scene.vtr", "--interface-error", error, "-o",
                                       name + ".vtu", "--json",    name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  /// Returns the greatest difference of a material's volume in a cut mesh from that in the scene.
  [[nodiscard]] double greatest_difference(const std::string& cut) const {
    const auto input = grid_ledger(folder() / "scene.vtr", ""), mesh = cut_mesh_ledger(folder() / cut, "");
    double greatest = 0;
    for (const auto& [material, entry] : input)
      greatest = std::max(greatest, std::abs(mesh.at(material).volume - entry.volume));
    return greatest;
  }

  /// Writes a ball of one label in another one.
  void write_labels() {
    std::string labels;
    for (int i = 0; i < 12 * 12 * 12; ++i) {
      const double x = i % 12 - 5.2, y = i / 12 % 12 - 5.5, z = i / 144 - 5.9;
      labels += static_cast<char>(x * x + y * y + z * z <= 16 ? 1 : 0);
    }
    write("ball.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n" + labels);
  }
};

}  // namespace

TEST_F(Conservation, IsTheDefaultForFractions) {
  make_scene("sphere");
  const RunResult result = resample("default", {"--cut-mesh", "cut.vtu"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LE(greatest_difference("cut.vtu"), kConserved);
  EXPECT_TRUE(read_json("default.json").at("conserved").get<bool>());
  EXPECT_NE(result.out.find("bodies that have their volumes"), std::string::npos) << result.out;
  ASSERT_EQ(resample("wanted", {"--conserve"}).status, 0);
  EXPECT_EQ(read("default.vtu"), read("wanted.vtu"));
}

TEST_F(Conservation, IsSwitchedOff) {
  make_scene("sphere");
  ASSERT_EQ(resample("default", {}).status, 0);
  const RunResult result = resample("without", {"--no-conserve", "--cut-mesh", "cut.vtu"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_GT(greatest_difference("cut.vtu"), 1e-4);
  const auto without = read_json("without.json"), by_default = read_json("default.json");
  EXPECT_TRUE(without.at("conserved").is_null());
  EXPECT_EQ(result.out.find("bodies that have their volumes"), std::string::npos) << result.out;
  EXPECT_EQ(without.at("tetrahedra"), by_default.at("tetrahedra"));
  EXPECT_LE(by_default.at("interface_error"), by_default.at("interface_error_target"));
}

/// Moves of interfaces may spoil errors of fields.
TEST_F(Conservation, IsToBeAskedForWithErrorsOfFields) {
  make_scene("sphere");
  resample("default", {"--field-error", "smooth=5%"});
  resample("without", {"--field-error", "smooth=5%", "--no-conserve"});
  EXPECT_EQ(read("default.vtu"), read("without.vtu"));
  resample("with", {"--field-error", "smooth=5%", "--conserve"});
  EXPECT_TRUE(read_json("with.json").at("conserved").get<bool>());
}

TEST_F(Conservation, OfLabelsIsToBeAskedFor) {
  write_labels();
  const auto resample_labels = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"resample", "ball.nrrd", "--labels", "ball.nrrd", "--interface-error",
                                       "8%",       "-o",        name,       "--json",    name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  };
  resample_labels("default.vtu", {});
  resample_labels("without.vtu", {"--no-conserve"});
  resample_labels("with.vtu", {"--conserve"});
  EXPECT_EQ(read("default.vtu"), read("without.vtu"));
  EXPECT_NE(read("default.vtu"), read("with.vtu"));
  EXPECT_TRUE(read_json("default.vtu.json").at("conserved").is_null());
  EXPECT_TRUE(read_json("with.vtu.json").at("conserved").get<bool>());
}

TEST_F(Conservation, ThatFailsIsAnErrorWhereItWasAskedFor) {
  make_scene("random");
  const RunResult by_default = resample("default", {}, "15%"),
                  wanted = resample("wanted", {"--conserve"}, "15%");
  EXPECT_FALSE(read_json("default.json").at("conserved").get<bool>());
  EXPECT_EQ(by_default.status, 0) << by_default.err;
  EXPECT_EQ(by_default.err.find("conserved"), std::string::npos) << by_default.err;
  EXPECT_EQ(wanted.status, 3) << wanted.err;
  EXPECT_NE(wanted.err.find("volumes were not conserved: a body of "), std::string::npos) << wanted.err;
}

TEST_F(Conservation, IsNotBothWantedAndUnwanted) {
  make_scene("sphere");
  expect_wrong_usage({"resample", "scene.vtr", "--conserve", "--no-conserve", "-o", "mesh.vtu"},
                     {"--conserve and --no-conserve: expected one of them"});
}

}  // namespace adamas::test
