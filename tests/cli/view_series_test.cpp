// Tests `adamas view` without a window on series: times on pictures, and damaged steps.

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "store_test.h"
#include "tests/support/damaged_step.h"

namespace adamas::test {

using namespace isosurface;

namespace {

// Every eighth step is coded by itself, each other one with those before it.
constexpr int kSteps = 10, kDamaged = 7;

/// A ball that is cut off farther in from step to step.
class ViewSeries : public StoreTest {
 protected:
  void SetUp() override {
    make_ball();
    make_series(kSteps, 2);
    const RunResult tried = view({"--json", "tried.json"});
    if (tried.err.find("expected EGL") != std::string::npos ||
        tried.err.find("expected OpenGL 4.5") != std::string::npos)
      GTEST_SKIP() << tried.err;
    ASSERT_EQ(tried.status, 0) << tried.err;
  }
  [[nodiscard]] RunResult view(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"view",   "b.adm",   "--isovalue", "80.5", "--offscreen",
                                 "--size", "160,120", "--steps",    "0,9"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
  [[nodiscard]] std::set<std::string> names(const std::string& in) const {
    std::set<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / in))
      all.insert(entry.path().filename());
    EXPECT_EQ(all.erase(".adamas-files"), 1u);
    return all;
  }
};

TEST_F(ViewSeries, WritesTheTimeOnFramesWhereItIsAskedFor) {
  ASSERT_EQ(view({"--frames", "plain", "--plain"}).status, 0);
  ASSERT_EQ(view({"--frames", "timed", "--plain", "--show-time"}).status, 0);
  for (int n = 1; n <= kSteps; ++n) {
    const std::string name = fmt::format("/frame{:04}.png", n);
    EXPECT_FALSE(read("plain" + name) == read("timed" + name));
  }
  // A volume has no time.
  run_well({"store", "s0.raw", "--dimensions", "40", "--type", "uint8", "-o", "one.adm"});
  const auto picture = [&](std::vector<std::string> all) {
    all.insert(all.begin(), {"view", "one.adm", "--isovalue", "80.5", "--offscreen", "--size", "160,120",
                             "--camera-path", "orbit:1", "--frames", "one", "--overwrite"});
    EXPECT_EQ(run(all).status, 0);
    return read("one/frame0001.png");
  };
  EXPECT_TRUE(picture({}) == picture({"--show-time"}));
}

TEST_F(ViewSeries, LeavesOutAStepThatIsDamagedAndNamesIt) {
  ASSERT_EQ(view({"--frames", "whole"}).status, 0);
  damage_step(folder() / "b.adm", kDamaged);
  const RunResult result = view({"--frames", "frames", "--json", "f.json", "--quiet"});
  EXPECT_EQ(result.status, 3);
  ASSERT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_EQ(result.err.rfind("adamas: note: b.adm: ", 0), 0u) << result.err;
  EXPECT_NE(result.err.find("damaged"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("the frame of step 7 is left out"), std::string::npos) << result.err;
  std::set<std::string> others = names("whole");
  EXPECT_EQ(others.size(), std::size_t{kSteps});
  others.erase("frame0008.png");
  EXPECT_EQ(names("frames"), others);
  for (const std::string& name : names("frames"))
    EXPECT_TRUE(read("frames/" + name) == read("whole/" + name)) << name;
  const auto frames = read_json("f.json")["frames"];
  ASSERT_EQ(frames.size(), std::size_t{kSteps});
  for (int step = 0; step < kSteps; ++step) {
    EXPECT_EQ(frames[static_cast<std::size_t>(step)]["step"], step);
    EXPECT_EQ(frames[static_cast<std::size_t>(step)].contains("problem"), step == kDamaged);
  }
  const RunResult film = view({"--film", "film.gif"});
  if (film.err.find("expected the program ffmpeg") == std::string::npos) {
    EXPECT_EQ(film.status, 3) << film.err;
    EXPECT_EQ(read("film.gif").substr(0, 4), "GIF8");
  }
  // A folder without the first frame may be that of a flight, too.
  std::vector<std::string> later{"view", "b.adm",    "--isovalue", "80.5",   "--offscreen", "--steps",
                                 "7,9",  "--frames", "later",      "--size", "160,120",     "--overwrite"};
  EXPECT_EQ(run(later).status, 3);
  EXPECT_EQ(names("later"), (std::set<std::string>{"frame0002.png", "frame0003.png"}));
  EXPECT_EQ(run(later).status, 3);
  // A run that shows nothing at all has failed.
  expect_failure({"view", "b.adm", "--isovalue", "80.5", "--offscreen", "--steps", "7,7", "--json", "g.json"},
                 {"b.adm", "damaged"});
  expect_failure({"view", "b.adm", "--isovalue", "80.5", "--offscreen", "--step", "7", "--json", "g.json"},
                 {"b.adm", "damaged"});
  EXPECT_FALSE(std::filesystem::exists(folder() / "g.json"));
}

}  // namespace

}  // namespace adamas::test
