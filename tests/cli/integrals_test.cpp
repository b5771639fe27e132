// Tests that integrals and values of the input, of the resampled mesh and of the cut mesh agree within the
// stated errors.

#include <cmath>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "tests/support/scratch.h"
#include "vtk_ledger.h"

namespace adamas::test {

namespace {

using Json = nlohmann::json;

/// A line of the samples at points.
struct Sample {
  std::string material;
  std::map<std::string, double> values;
};

class Integrals : public ProgramTest {
 protected:
  void run_quietly(std::vector<std::string> arguments) const {
    arguments.emplace_back("-q");
    const RunResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  }

  /// Returns the areas of each material's interfaces in a file of interfaces.
  [[nodiscard]] std::map<std::string, double> areas(const std::string& file) const {
    run_quietly({"probe", file, "--json", "areas.json"});
    std::map<std::string, double> result;
    const Json found = read_json("areas.json");
    for (const Json& interface : found.at("interfaces")) {
      for (const Json& material : interface.at("materials"))
        result[material.get<std::string>()] += interface.at("area").get<double>();
    }
    return result;
  }

  [[nodiscard]] std::vector<Sample> samples(const std::string& file) const {
    run_quietly({"probe", file, "--points-file", "points.csv", "-o", "samples.csv"});
    std::istringstream lines(read("samples.csv"));
    std::string line, cell;
    std::getline(lines, line);
    std::vector<std::string> names;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
    std::vector<Sample> result;
    while (std::getline(lines, line)) {
      Sample& sample = result.emplace_back();
      std::istringstream cells(line);
      for (std::size_t column = 0; std::getline(cells, cell, ','); ++column) {
        if (column == 3) sample.material = cell;
        if (column > 4 && !cell.empty()) sample.values[names.at(column)] = std::stod(cell);
      }
    }
    return result;
  }

  /// Expects |difference| <= field error * volume + greatest value * interface error * area. Where both
  /// meshes have the material, its values differ by no more than the field's error. The regions where only
  /// one of them has it lie between interfaces whose distance is at most the interfaces' error.
  void expect_agreement(const std::string& input, const std::string& field, const Json& figures,
                        double most_of_all) const;
  /// Makes all the files; `input` is the input with its options.
  void resample(const std::vector<std::string>& input, const std::vector<std::string>& options);

 private:
  std::map<std::string, double> input_areas_, mesh_areas_;
};

void Integrals::resample(const std::vector<std::string>& input, const std::vector<std::string>& options) {
  const auto with_input = [&](const std::string& command, const std::vector<std::string>& rest) {
    std::vector<std::string> arguments{command};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    run_quietly(arguments);
  };
  std::vector<std::string> wanted{"-o",       "mesh.vtu", "--cut-mesh",  "cut.vtu", "--interfaces-out",
                                  "mesh.vtp", "--json",   "figures.json"};
  wanted.insert(wanted.end(), options.begin(), options.end());
  with_input("resample", wanted);
  with_input("reconstruct", {"-o", "input.vtp"});
  with_input("probe", {"--json", "input.json"});
  run_quietly({"probe", "mesh.vtu", "--json", "mesh.json"});
  input_areas_ = areas("input.vtp");
  mesh_areas_ = areas("mesh.vtp");
}

void Integrals::expect_agreement(const std::string& input, const std::string& field, const Json& figures,
                                 double most_of_all) const {
  SCOPED_TRACE(input + " " + field);
  const auto from_file = cut_mesh_ledger(folder() / "cut.vtu", field);
  const double field_error = figures.at("fields").at(field).at("max_error");
  const double interface_error = figures.at("interface_error_per_material");
  const Json in = read_json("input.json"), out = read_json("mesh.json");
  double bound_of_all = 0, given_of_all = 0;
  for (std::size_t m = 0; m < in.at("materials").size(); ++m) {
    const Json &a = in.at("materials")[m], &b = out.at("materials")[m];
    const std::string name = a.at("name");
    SCOPED_TRACE(name);
    ASSERT_EQ(b.at("name"), name);
    if (a.at("fields").at(field).at("integral").is_null()) continue;
    const double given = a.at("fields").at(field).at("integral"),
                 made = b.at("fields").at(field).at("integral");
    const double volume = std::max(a.at("volume").get<double>(), b.at("volume").get<double>());
    const double area = std::max(input_areas_.at(name), mesh_areas_.at(name));
    const double bound = field_error * volume + most_of_all * interface_error * area;
    EXPECT_LE(std::abs(made - given), bound);
    bound_of_all += bound;
    given_of_all += std::abs(given);
    EXPECT_NEAR(from_file.at(name).mass, made, bound);
    EXPECT_NEAR(from_file.at(name).volume, b.at("volume").get<double>(), 1e-5 * volume);
  }
  // Otherwise the bounds would say nothing.
  EXPECT_LT(bound_of_all, given_of_all);
}

/// The scenes' fields are little more than 10 times the material's number at most, and their slopes, per unit
/// of length, are below 3.
TEST_F(Integrals, AgreeBetweenInputMeshAndCutMesh) {
  constexpr double kSlope = 3;
  constexpr std::size_t kCells = 10, kPoints = 1000;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::string points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    points += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "\n";
  }
  write("points.csv", points);
  for (const auto& [scene, materials] : {std::pair{"sphere", 2}, std::pair{"tjunction", 3}}) {
    make_scene(scene, kCells);
    resample({"scene.vtr"},
             {"--interface-error", "1.5%", "--field-error", "smooth=0.5", "--ghost", "linear"});
    const Json figures = read_json("figures.json");
    const auto given = samples("scene.vtr"), made = samples("mesh.vtu");
    ASSERT_EQ(given.size(), kPoints);
    ASSERT_EQ(made.size(), kPoints);
    for (const char* field : {"constant", "linear", "smooth"}) {
      expect_agreement("scene.vtr", field, figures, 10.0 * materials + kSlope);
      // The distance of a point from a place where values are compared is at most half a cell's diagonal plus
      // the interfaces' error. On the way either field changes by no more than its slope allows.
      const double way =
          std::sqrt(3.0) * (0.5 / kCells + figures.at("interface_error_per_material").get<double>());
      const double bound = figures.at("fields").at(field).at("max_error").get<double>() + 2 * kSlope * way;
      EXPECT_LT(bound, 5) << "materials' values differ by 10";
      std::size_t agreed = 0;
      for (std::size_t i = 0; i < kPoints; ++i) {
        if (given[i].material != made[i].material) continue;
        ++agreed;
        EXPECT_LE(std::abs(given[i].values.at(field) - made[i].values.at(field)), bound)
            << field << " at point " << i;
      }
      EXPECT_GT(agreed, kPoints * 95 / 100);
    }
  }
}

using LongIntegrals = Integrals;

/// The integrals agree for a part of published data of an impact too.
TEST_F(LongIntegrals, OfPublishedDataAgree) {
  const auto data = shared_data("material/pyvista_misc/cth.vtr");
  ADAMAS_SKIP_WITHOUT(data);
  const std::string region = "--region=-1.3,-0.7,-0.8,-0.3,-0.2,0.1";
  // The values of a mass belong to cells, so the greatest one of the region's cells is the bound.
  run_quietly({"info", data.string(), region, "--json", "info.json"});
  resample({data.string(), region}, {"--interface-error", "1%"});
  const Json figures = read_json("figures.json"), ranges = read_json("info.json");
  double greatest = 0;
  for (const Json& field : ranges.at("fields")) {
    if (field.at("name") == "Mass") greatest = field.at("max");
  }
  ASSERT_GT(greatest, 0);
  expect_agreement(data.filename().string(), "Mass", figures, greatest);
}

}  // namespace

}  // namespace adamas::test
