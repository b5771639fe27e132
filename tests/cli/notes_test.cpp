// Tests notes: there is one line for many things of a kind, and it names the input.

#include <algorithm>
#include <limits>

#include "program.h"

namespace adamas::test {

namespace {

class Notes : public ProgramTest {
 protected:
  /// Writes bytes on 16^3 cells.
  void write_bytes(const std::string& name, const std::function<int(int, int, int)>& value) const {
    std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n";
    for (int k = 0; k < 16; ++k) {
      for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) bytes += static_cast<char>(value(i, j, k));
      }
    }
    write(name, bytes);
  }
  static std::size_t count(const std::vector<std::string>& lines, const std::string& part) {
    return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find(part) != std::string::npos;
    }));
  }
};

/// Each of 64 cells is a body of its own, and so few tetrahedra cannot show them.
TEST_F(Notes, OfOneKindAreOneLineUnlessAllAreWanted) {
  write_bytes("dots.nrrd",
              [](int i, int j, int k) { return i % 4 == 2 && j % 4 == 2 && k % 4 == 2 ? 1 : 0; });
  const std::vector<std::string> command{"resample", "dots.nrrd",        "--labels", "dots",
                                         "--cells",  "--max-tetrahedra", "200",      "--interface-error",
                                         "1%",       "--volume-error",   "1%",       "-o",
                                         "m.vtu",    "--json",           "j.json"};
  const RunResult one = run(command);
  auto verbose = command;
  verbose.emplace_back("--verbose");
  const RunResult all = run(verbose);
  EXPECT_EQ(one.status, 3);
  const auto figures = read_json("j.json");
  const std::size_t wrong = figures["wrong_bodies"].size(), missed = figures["missed_volumes"].size();
  ASSERT_GT(wrong, 10u);
  ASSERT_GT(missed, 10u);
  const std::string more =
      "; and " + std::to_string(wrong - 1) + " more bodies that are lost or torn (--verbose";
  EXPECT_EQ(count(one.err_lines(), more), 1u) << one.err;
  EXPECT_EQ(count(one.err_lines(), "; and " + std::to_string(missed - 1) + " more bodies (--verbose"), 1u)
      << one.err;
  EXPECT_LE(one.err_lines().size(), 6u) << one.err;
  // Most of the body round the others is shown, so its message is not that of a lost body.
  EXPECT_EQ(figures["wrong_bodies"].size(), count(all.err_lines(), "the mesh shows nothing of a body") +
                                                count(all.err_lines(), "the mesh shows a body"))
      << all.err;
  EXPECT_EQ(count(all.err_lines(), "the volume error wanted was not reached"), missed);
  EXPECT_EQ(count(all.err_lines(), "more bodies"), 0u);
}

TEST_F(Notes, NameTheInputAndNotOneOfItsFiles) {
  const auto oil = [](int i, int j, int) { return i + j == 12 ? 100 : 0; };
  write_bytes("oil.nrrd", oil);
  write_bytes("water.nrrd", [&](int i, int j, int k) { return 240 - oil(i, j, k); });
  const RunResult result = run({"reconstruct", "--fraction", "oil=oil.nrrd", "--fraction", "water=water.nrrd",
                                "--fraction-scale", "250", "--cells", "-o", "i.vtp"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(count(result.err_lines(), "note: oil.nrrd and 1 more file: volume fractions were mended: "), 1u)
      << result.err;
  EXPECT_EQ(count(result.err_lines(), "note: oil.nrrd: "), 0u) << result.err;
}

TEST_F(Notes, OfStepsWithoutFiniteSamplesAreOneLine) {
  for (int step = 0; step < 4; ++step)
    write_image("s_" + std::to_string(step) + ".nrrd", 3, [step](std::size_t n) {
      return static_cast<int>(n) < step ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
    });
  const RunResult result = run({"store", "s_%d.nrrd", "-o", "a.adm", "--json", "j.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_EQ(count(result.err_lines(),
                  "s_3.nrrd: 3 samples are not finite: surfaces have holes there; and 2 more steps"),
            1u)
      << result.err;
  std::vector<int> found;
  const auto figures = read_json("j.json");
  for (const auto& step : figures["infinite_samples"]) found.push_back(step["samples"]);
  EXPECT_EQ(found, (std::vector<int>{1, 2, 3}));
}

/// Any of its outputs is enough for a command to run; a table goes either to the file or to stdout.
TEST_F(Notes, OutputsAreThoseAskedFor) {
  make_scene("sphere", 8);
  run_well({"reconstruct", "scene.vtr", "--picture", "p.png"});
  run_well({"reconstruct", "scene.vtr", "--json", "j.json"});
  EXPECT_EQ(files(), (std::set<std::string>{"scene.vtr", "p.png", "j.json"}));
  expect_wrong_usage({"reconstruct", "scene.vtr"},
                     {"nothing to write", "-o, --side-sets, --picture or --json"});
  const std::vector<std::string> probe{"probe", "scene.vtr", "--point", "0.5,0.5,0.5"};
  auto to_file = probe;
  to_file.insert(to_file.end(), {"-o", "p.csv"});
  EXPECT_EQ(run_well(to_file).out, "");
  EXPECT_EQ(run_well(probe).out, read("p.csv"));
}

}  // namespace

}  // namespace adamas::test
