#include <fmt/format.h>

#include <algorithm>

#include "tests/cli/program.h"

namespace adamas::test {
namespace {

/// A store of a small series, m.adm.
class PlayCommand : public ProgramTest {
 protected:
  PlayCommand() {
    run_well({"generate", "mixing", "--dimensions", "24", "--steps", "12", "-o", "m.pvd", "-q"});
    run_well({"store", "m.pvd", "--array", "density", "-o", "m.adm", "-q"});
  }
  nlohmann::json played(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"play", "m.adm", "--isovalue", "12", "--json", "p.json", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
    return read_json("p.json");
  }
  static std::vector<int> of_frames(const nlohmann::json& played, const char* key) {
    std::vector<int> values;
    for (const auto& frame : played["frames"]) values.push_back(frame[key].get<int>());
    return values;
  }
};

TEST_F(PlayCommand, ShowsTheSameSurfacesInAnyOrderAndMemory) {
  const nlohmann::json forward = played({"--error", "0.7voxels"});
  const std::vector<int> steps = of_frames(forward, "step"), triangles = of_frames(forward, "triangles");
  EXPECT_EQ(steps, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_GT(triangles.back(), 100);
  for (const char* key : {"splits", "merges", "page_faults", "bytes_read"})
    EXPECT_EQ(of_frames(forward, key).size(), steps.size());
  EXPECT_GT(forward["page_faults"], 0);
  const std::vector<std::vector<std::string>> others{{"--order", "backward"},
                                                     {"--order", "random", "--times", "2", "--seed", "3"},
                                                     {"--order", "there-and-back", "--ahead", "0"},
                                                     {"--memory", "1", "--read-steps", "1"},
                                                     {"--paging", "map", "--ahead", "5"}};
  for (std::vector<std::string> more : others) {
    more.insert(more.end(), {"--error", "0.7voxels"});
    const nlohmann::json other = played(more);
    const std::vector<int> other_steps = of_frames(other, "step"),
                           other_triangles = of_frames(other, "triangles");
    for (std::size_t n = 0; n < other_steps.size(); ++n)
      EXPECT_EQ(other_triangles[n], triangles[static_cast<std::size_t>(other_steps[n])]) << more[1];
  }
}

TEST_F(PlayCommand, PlaysSomeStepsAndMovesTheCamera) {
  EXPECT_EQ(of_frames(played({"--steps", "3,5", "--order", "there-and-back"}), "step"),
            (std::vector<int>{3, 4, 5, 4}));
  const nlohmann::json seen = played({"--camera-path", "orbit:7", "--pixels", "2", "--max-triangles", "500"});
  EXPECT_EQ(seen["frames"].size(), 12u);
  for (const int triangles : of_frames(seen, "triangles")) EXPECT_LE(triangles, 500);
  EXPECT_LE(played({"--steps", "4,4"})["frames"].size(), 1u);
}

/// Without a camera the error is a length, which is at most the one asked for.
TEST_F(PlayCommand, TellsTheErrorInUnitsOfLengthOrInPixels) {
  run_well({"info", "m.adm", "--json", "info.json", "-q"});
  const double spacing = read_json("info.json")["spacing"][0];
  double greatest = 0;
  for (const double voxels : {0.7, 2.0}) {
    const nlohmann::json all = played({"--error", std::to_string(voxels) + "voxels"});
    for (const auto& frame : all["frames"]) {
      EXPECT_FALSE(frame.contains("largest_error_pixels"));
      EXPECT_LE(frame["largest_error"], voxels * spacing * (1 + 1e-5));
      greatest = std::max(greatest, frame["largest_error"].get<double>());
    }
  }
  EXPECT_GT(greatest, 0.7 * spacing);
  const nlohmann::json seen = played({"--camera-path", "orbit:7", "--pixels", "2"});
  for (const auto& frame : seen["frames"]) {
    EXPECT_FALSE(frame.contains("largest_error"));
    EXPECT_LE(frame["largest_error_pixels"], 2);
  }
}

/// Where a surface begins or ends its motion is no distance; the greatest motion is that of the other steps.
TEST_F(PlayCommand, MotionLeavesOutWhereASurfaceBeginsOrEnds) {
  const RunResult some = run_well({"play", "m.adm", "--isovalue", "12", "--motion", "--json", "p.json"});
  double greatest = 0;
  int ends = 0;
  const nlohmann::json all = read_json("p.json");
  for (const auto& frame : all["frames"]) {
    if (frame["step"] == 0) continue;
    if (frame["motion_certified"].is_null()) {
      ++ends;
    } else {
      greatest = std::max(greatest, frame["motion_certified"].get<double>());
    }
  }
  EXPECT_EQ(ends, 1);
  EXPECT_GT(greatest, 0);
  EXPECT_EQ(some.out.find("inf"), std::string::npos) << some.out;
  EXPECT_NE(some.out.find(fmt::format("{:.4g} at most", greatest)), std::string::npos) << some.out;
  EXPECT_NE(some.out.find("1 of 11 transitions begins or ends without a surface"), std::string::npos)
      << some.out;
  const RunResult none = run_well({"play", "m.adm", "--isovalue", "1e30", "--motion"});
  EXPECT_NE(none.out.find("no frame has a surface"), std::string::npos) << none.out;
}

TEST_F(PlayCommand, AnswersWrongUsage) {
  const auto wrong = [&](const std::vector<std::string>& more, const std::string& expected) {
    std::vector<std::string> all{"play", "m.adm", "--isovalue", "12"};
    all.insert(all.end(), more.begin(), more.end());
    expect_wrong_usage(all, {expected});
  };
  wrong({"--steps", "3,12"}, "--steps: expected two of the 12 steps of m.adm");
  wrong({"--steps", "5,3"}, "--steps");
  wrong({"--steps", "1.5,3"}, "--steps");
  wrong({"--error", "-1"}, "--error");
  wrong({"--error", "1", "--camera-path", "orbit:3"}, "--pixels");
  wrong({"--pixels", "1"}, "--camera-path");
  wrong({"--read-steps", "0"}, "--read-steps");
}

}  // namespace
}  // namespace adamas::test
