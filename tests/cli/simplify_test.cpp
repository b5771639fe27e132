// Tests reconstruct --simplify and resample --simplify.

#include <fmt/format.h>

#include <cmath>

#include "program.h"

namespace adamas::test {

namespace {

class Simplify : public ProgramTest {
 protected:
  Simplify() { make_scene("voronoi10", 8); }
};

TEST_F(Simplify, ReconstructsFewerTriangles) {
  const RunResult result =
      run_well({"reconstruct", "scene.vtr", "--simplify", "1%", "-o", "few.vtp", "--json", "few.json"});
  EXPECT_NE(result.out.find("distance certified"), std::string::npos);
  const auto figures = read_json("few.json");
  const auto& simplified = figures["simplification"];
  EXPECT_LT(4 * int(simplified["triangles"]), int(simplified["triangles_before"]));
  EXPECT_EQ(simplified["triangles"], figures["triangles"]);
  const double error = simplified["error_target"];
  EXPECT_NEAR(error, 0.01 * std::sqrt(3.0), 1e-12);
  for (const char* what : {"error", "error_per_material", "junction_error"}) {
    EXPECT_LE(simplified[what]["certified"], error);
    EXPECT_LE(simplified[what]["found"], simplified[what]["certified"]);
  }
  EXPECT_GE(simplified["smallest_angle"], simplified["smallest_angle_before"]);
  EXPECT_EQ(simplified["changed_bodies"], 0);
  // The file is a sound network. An error as a length has the same result as the corresponding part of the
  // diagonal.
  run_well({"reconstruct", "few.vtp", "--box", "0,1,0,1,0,1", "-o", "again.vtp", "--json", "again.json"});
  EXPECT_EQ(read_json("again.json")["triangles"], figures["triangles"]);
  run_well({"reconstruct", "scene.vtr", "--simplify", fmt::format("{:.17g}", error), "-o", "same.vtp"});
  EXPECT_EQ(read("same.vtp"), read("few.vtp"));
}

/// The printed areas are those of the written interfaces, both for fractions and for given interfaces.
TEST_F(Simplify, TellsTheAreasOfWhatIsWritten) {
  run_well({"reconstruct", "scene.vtr", "-o", "net.vtp"});
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{"scene.vtr"}, {"net.vtp", "--box", "0,1,0,1,0,1"}}) {
    std::vector<std::string> simplify{"reconstruct"}, again{"reconstruct", "few.vtp", "--box", "0,1,0,1,0,1"};
    simplify.insert(simplify.end(), input.begin(), input.end());
    simplify.insert(simplify.end(), {"--simplify", "1%", "-o", "few.vtp", "--json", "few.json"});
    again.insert(again.end(), {"--json", "again.json"});
    run_well(simplify);
    run_well(again);
    const auto few = read_json("few.json")["interfaces"], read_back = read_json("again.json")["interfaces"];
    ASSERT_EQ(few.size(), read_back.size());
    for (std::size_t i = 0; i < few.size(); ++i) {
      EXPECT_EQ(few[i]["materials"], read_back[i]["materials"]);
      EXPECT_EQ(few[i]["triangles"], read_back[i]["triangles"]);
      EXPECT_NEAR(few[i]["area"], double(read_back[i]["area"]), 1e-9);
    }
  }
}

TEST_F(Simplify, IsTheSameOnAnyNumberOfThreads) {
  for (const char* threads : {"1", "2"}) {
    run_well({"reconstruct", "scene.vtr", "--simplify", "1%", "--smooth", "--threads", threads, "-o",
              std::string("t") + threads + ".arec"});
  }
  EXPECT_EQ(read("t1.arec"), read("t2.arec"));
}

TEST_F(Simplify, TakesGivenInterfaces) {
  run_well({"reconstruct", "scene.vtr", "-o", "net.vtp"});
  run_well({"reconstruct", "net.vtp", "--box", "0,1,0,1,0,1", "--simplify", "1%", "-o", "few.vtp", "--json",
            "few.json"});
  const auto simplified = read_json("few.json")["simplification"];
  EXPECT_LT(4 * int(simplified["triangles"]), int(simplified["triangles_before"]));
}

TEST_F(Simplify, ResamplesOnTopOfTheInterfaceError) {
  const RunResult result = run({"resample", "scene.vtr", "--interface-error", "4%", "--interfaces-out",
                                "few.vtp", "--simplify", "1%", "--json", "few.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("the simplified interfaces are within"), std::string::npos) << result.err;
  const auto figures = read_json("few.json");
  const auto& simplified = figures["simplification"];
  EXPECT_LT(simplified["triangles"], simplified["triangles_before"]);
  EXPECT_LE(simplified["error"]["certified"], simplified["error_target"]);
  run_well({"reconstruct", "few.vtp", "--box", "0,1,0,1,0,1", "-o", "again.vtp"});
}

TEST_F(Simplify, RefusesNonsense) {
  expect_wrong_usage({"reconstruct", "scene.vtr", "-o", "a.vtp", "--smooth"},
                     {"--smooth: expected --simplify beside it, found none"});
  expect_wrong_usage({"reconstruct", "scene.vtr", "-o", "a.vtp", "--simplify", "none"},
                     {"--simplify: expected a positive error as 0.15", "found 'none'"});
  expect_wrong_usage({"reconstruct", "scene.vtr", "-o", "a.vtp", "--simplify", "-1%"}, {"--simplify"});
  expect_wrong_usage({"reconstruct", "scene.vtr", "-o", "a.vtp", "--simplify", "2"},
                     {"--simplify: expected less than the domain's diagonal", "found 2"});
  expect_wrong_usage({"resample", "scene.vtr", "-o", "a.vtu", "--simplify", "1%"},
                     {"--simplify: expected --interfaces-out or --picture beside it, found none"});
}

}  // namespace

}  // namespace adamas::test
