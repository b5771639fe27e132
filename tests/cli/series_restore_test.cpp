// Tests restore, verify and play on series: existing files, scales of samples, damaged steps.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tests/cli/series_stores.h"

namespace adamas::test {
namespace {

class SeriesRestore : public SeriesStores {
 protected:
  /// Makes a.adm, a store of 20 steps of float32 samples, `samples` along each axis, and d.adm, which is
  /// a.adm with one byte of its finest pages changed, so that some steps cannot be restored. Returns these
  /// steps, which are found by restoring each one. What was made once is kept for the other tests.
  [[nodiscard]] std::vector<int> make_damaged(const std::string& samples = "17", double place = 0.5) const {
    static std::map<std::string, Damaged> all;
    const auto [at, is_new] = all.try_emplace(samples);
    if (is_new) at->second = damaged(samples, place);
    write("a.adm", at->second.before);
    write("d.adm", at->second.after);
    return at->second.lost;
  }
  void expect_other_steps(const std::vector<int>& lost) const;

 private:
  struct Damaged {
    std::string before, after;
    std::vector<int> lost;
  };
  [[nodiscard]] Damaged damaged(const std::string& samples, double place) const;
};

SeriesRestore::Damaged SeriesRestore::damaged(const std::string& samples, double place) const {
  run_well({"generate", "mixing", "--dimensions", samples, "--steps", "20", "--type", "float32", "-o",
            "m.pvd", "-q"});
  run_well({"store", "m.pvd", "--array", "density", "-o", "a.adm", "-q"});
  Damaged result;
  result.before = result.after = read("a.adm");
  char& byte = result.after[static_cast<std::size_t>(static_cast<double>(result.after.size()) * place)];
  byte = static_cast<char>(byte ^ 1);
  write("d.adm", result.after);
  for (int step = 0; step < 20; ++step) {
    const std::string number = std::to_string(step);
    const RunResult found = run({"restore", "d.adm", "--step", number, "-o", "one.raw", "-q"});
    if (found.status == 0) continue;
    EXPECT_NE(found.err.find("damaged at step " + number), std::string::npos) << found.err;
    result.lost.push_back(step);
  }
  return result;
}

/// Expects that r.pvd and r.zarr, restored from d.adm, hold the other steps as a.adm has them, under their
/// numbers and times.
void SeriesRestore::expect_other_steps(const std::vector<int>& lost) const {
  run_well({"restore", "a.adm", "-o", "w.pvd", "-q"});
  run_well({"restore", "a.adm", "-o", "w.zarr", "-q"});
  const auto made = files();
  const auto times = read_json("w.zarr/.zattrs")["adamas"]["times"];
  std::vector<double> kept;
  for (int step = 0, at = 0; step < 20; ++step) {
    const std::string file = fmt::format("_{:04}.vti", step);
    const bool is_lost = std::count(lost.begin(), lost.end(), step) > 0;
    EXPECT_EQ(made.contains("r" + file), !is_lost) << step;
    EXPECT_EQ(read("r.pvd").find("r" + file) == std::string::npos, is_lost) << step;
    if (is_lost) continue;
    EXPECT_TRUE(read("r" + file) == read("w" + file)) << step;
    EXPECT_TRUE(read(fmt::format("r.zarr/0/{}/0/0/0", at++)) == read(fmt::format("w.zarr/0/{}/0/0/0", step)));
    kept.push_back(times[static_cast<std::size_t>(step)]);
  }
  EXPECT_EQ(read_json("r.zarr/.zattrs")["adamas"]["times"], kept);
}

TEST_F(SeriesRestore, FilesOfStepsThatAreThereStay) {
  run_well(store({"s_%d.raw"}, "a.adm"));
  write("r_0001.vti", "mine");
  expect_failure({"restore", "a.adm", "-o", "r.pvd"}, {"r.pvd", "found r_0001.vti", "--overwrite"});
  EXPECT_EQ(read("r_0001.vti"), "mine");
  run_well({"restore", "a.adm", "--steps", "2,4", "-o", "r.pvd"});
  expect_failure({"restore", "a.adm", "-o", "r.pvd"}, {"found r_0001.vti"});
  run_well({"restore", "a.adm", "-o", "r.pvd", "--overwrite"});
  EXPECT_NE(read("r_0001.vti").find(samples(1)), std::string::npos);
  expect_wrong_usage({"restore", "a.adm", "-o", "r.vti", "--overwrite"},
                     {"--overwrite", "F.pvd or F.zarr", "r.vti"});
}

/// There is one note for the whole run, which states the type that was written.
TEST_F(SeriesRestore, TheTypeThatWasWrittenIsTold) {
  run_well(
      {"generate", "mixing", "--dimensions", "12", "--steps", "3", "--type", "uint8", "-o", "m.pvd", "-q"});
  run_well({"store", "m.pvd", "--array", "density", "-o", "m.adm", "-q"});
  const std::string scaled =
      "are written as float32: samples with their scale are written to .nii and .nii.gz only";
  const RunResult series = run({"restore", "m.adm", "-o", "r.pvd", "--json", "j.json"});
  EXPECT_EQ(series.status, 0);
  ASSERT_EQ(series.err_lines().size(), 1u) << series.err;
  EXPECT_EQ(series.err.rfind("adamas: note: r.pvd: values, ", 0), 0u) << series.err;
  EXPECT_NE(series.err.find(scaled), std::string::npos) << series.err;
  EXPECT_EQ(series.out.rfind("12 x 12 x 12 samples, float32, 3 steps, ", 0), 0u) << series.out;
  EXPECT_EQ(read_json("j.json")["type"], "float32");
  EXPECT_EQ(read_json("j.json")["steps"], 3);
  const RunResult one = run({"restore", "m.adm", "--step", "1", "-o", "r.nii", "--json", "j.json"});
  EXPECT_EQ(one.err, "");
  EXPECT_EQ(one.out.rfind("12 x 12 x 12 samples, uint8, ", 0), 0u) << one.out;
  EXPECT_EQ(read_json("j.json")["type"], "uint8");
  const RunResult zarr = run({"restore", "m.adm", "-o", "r.zarr", "--json", "j.json"});
  EXPECT_NE(zarr.out.find("samples, float32, 3 steps, "), std::string::npos) << zarr.out;
  EXPECT_EQ(read_json("j.json")["type"], "float32");
}

TEST_F(SeriesRestore, DamagedStepsAreNamed) {
  const std::vector<int> lost = make_damaged();
  ASSERT_FALSE(lost.empty());
  ASSERT_LT(lost.size(), 9u);
  // The lost steps are consecutive, up to the next one that is coded by itself.
  const std::string named = lost.size() == 1
                                ? "step " + std::to_string(lost[0])
                                : "steps " + std::to_string(lost.front()) +
                                      (lost.size() == 2 ? " and " : " to ") + std::to_string(lost.back());
  for (const std::string output : {"r.pvd", "r.zarr"}) {
    const RunResult restored = run({"restore", "d.adm", "-o", output, "--json", "j.json", "-q"});
    EXPECT_EQ(restored.status, 3) << restored.err;
    ASSERT_EQ(restored.err_lines().size(), 1u) << restored.err;
    for (const std::string& part : {std::string("note: d.adm: the page of LOD 0 at "),
                                    "damaged at step " + std::to_string(lost.front()), named + " left out"})
      EXPECT_NE(restored.err.find(part), std::string::npos) << restored.err;
    EXPECT_EQ(read_json("j.json")["damaged_steps"], lost);
    EXPECT_EQ(read_json("j.json")["steps"], 20 - lost.size());
  }
  expect_other_steps(lost);
  const RunResult verified = run({"verify", "d.adm", "--json", "j.json"});
  EXPECT_EQ(verified.status, 1);
  EXPECT_EQ(read_json("j.json")["damaged_steps"], lost);
  EXPECT_EQ(read_json("j.json")["bad_pages"], lost.size());
  EXPECT_NE(verified.out.find(" is damaged at step " + std::to_string(lost.front()) + "\n"),
            std::string::npos)
      << verified.out;
  EXPECT_NE(verified.err.find("of " + named + ","), std::string::npos) << verified.err;
  if (lost.size() > 3) {
    EXPECT_NE(verified.out.find(" is predicted from a damaged one at steps " + std::to_string(lost[1]) +
                                " to " + std::to_string(lost.back()) + "\n"),
              std::string::npos)
        << verified.out;
  }
}

/// No line comes twice, and each step with damage is named.
TEST_F(SeriesRestore, VerifyTellsEachPageOnce) {
  const std::vector<int> lost = make_damaged("33", 0.02);
  const RunResult verified = run({"verify", "d.adm", "--json", "j.json"});
  std::vector<std::string> lines;
  for (std::size_t at = 0, end = 0; (end = verified.out.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(verified.out.substr(at, end - at));
  ASSERT_GT(lines.size(), 1u);
  // The last line counts the pages that have no line of their own.
  EXPECT_EQ(lines.back().rfind("and ", 0), 0u) << lines.back();
  lines.pop_back();
  for (const std::string& line : lines) {
    EXPECT_NE(line.find(" at step"), std::string::npos) << line;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1) << line;
  }
  EXPECT_EQ(read_json("j.json")["damaged_steps"], lost);
}

TEST_F(SeriesRestore, PlayGoesOnWithTheOtherSteps) {
  const std::vector<int> lost = make_damaged();
  ASSERT_FALSE(lost.empty());
  const auto play = [](const std::string& store, const std::string& json,
                       std::vector<std::string> more = {}) {
    std::vector<std::string> all{"play", store, "--isovalue", "12", "--json", json};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  run_well(play("a.adm", "whole.json"));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--motion"}, {"--ahead", "0", "--memory", "1"}}) {
    const RunResult result = run(play("d.adm", "j.json", more));
    EXPECT_EQ(result.status, 3) << result.err;
    ASSERT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_EQ(result.err.rfind("adamas: note: d.adm: ", 0), 0u) << result.err;
    EXPECT_NE(result.err.find("damaged"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("frames"), std::string::npos) << result.out;
    const auto found = read_json("j.json"), whole = read_json("whole.json");
    // A surface may not need the damaged page.
    const std::vector<int> left_out = found["damaged_steps"];
    ASSERT_FALSE(left_out.empty());
    EXPECT_TRUE(std::includes(lost.begin(), lost.end(), left_out.begin(), left_out.end()));
    EXPECT_EQ(found["frames"].size() + left_out.size(), 20u);
    for (const auto& frame : found["frames"]) {
      const std::size_t step = frame["step"];
      EXPECT_EQ(frame["triangles"], whole["frames"][step]["triangles"]) << step;
    }
  }
  const std::string first = std::to_string(lost.front());
  expect_failure(play("d.adm", "none.json", {"--steps", first + "," + first}),
                 {"d.adm", "step " + first, "damaged"});
}

TEST_F(SeriesRestore, SliceGoesOnWithTheOtherSteps) {
  const std::vector<int> lost = make_damaged();
  ASSERT_FALSE(lost.empty());
  const auto slice = [](const std::string& store, const std::string& output) {
    return std::vector<std::string>{"slice",  store,    "--plane", "x=0.05", "--range", "0,30",
                                    "--json", "j.json", "-o",      output,   "-q"};
  };
  for (const std::string ending : {"_%04d.svg", ".pvd"}) {
    if (ending == ".pvd") run_well(slice("a.adm", "w.pvd"));
    const RunResult result = run(slice("d.adm", "p" + ending));
    const std::vector<int> left_out = read_json("j.json")["damaged_steps"];
    ASSERT_GT(left_out.size(), 1u);
    EXPECT_EQ(result.status, 3) << result.err;
    ASSERT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_NE(result.err.find("; and " + std::to_string(left_out.size() - 1) + " more step"),
              std::string::npos);
    EXPECT_TRUE(std::includes(lost.begin(), lost.end(), left_out.begin(), left_out.end()));
    EXPECT_EQ(read_json("j.json")["steps"].size() + left_out.size(), 20u);
    const auto made = files();
    for (int step = 0; step < 20; ++step) {
      const std::string file = fmt::format("_{:04}", step) + (ending == ".pvd" ? ".vtp" : ".svg");
      const bool is_left_out = std::count(left_out.begin(), left_out.end(), step) > 0;
      ASSERT_EQ(made.contains("p" + file), !is_left_out) << step;
      if (!is_left_out && ending == ".pvd") {
        EXPECT_TRUE(read("p" + file) == read("w" + file)) << step;
      }
    }
    if (!left_out.empty()) {
      const std::string first = std::to_string(left_out.front());
      auto one = slice("d.adm", "q" + ending);
      one.insert(one.end(), {"--step", first});
      expect_failure(one, {"d.adm", "step " + first, "damaged"});
    }
  }
}

}  // namespace
}  // namespace adamas::test
