// Tests --blur, --fraction-error and --keep-dispersed of commands that reconstruct interfaces.

#include "program.h"

namespace adamas::test {

namespace {

class FractionOptionsOf : public ProgramTest {
 protected:
  /// Returns what `reconstruct` reports of the fractions.
  nlohmann::json findings(std::vector<std::string> options) {
    options.insert(options.begin(), {"reconstruct", "b.vtr", "-o", "b.ply", "--json", "b.json", "-q"});
    run_well(options);
    return read_json("b.json")["fractions"];
  }
};

TEST_F(FractionOptionsOf, ReconstructAreTaken) {
  run_well(
      {"generate", "scene", "sphere", "--dimensions", "14", "--blur", "1", "--noise", "2%", "-o", "b.vtr"});
  const auto found = findings({}), again = findings({"--blur", "auto", "--fraction-error", "auto"});
  EXPECT_EQ(found, again);
  EXPECT_GT(found["blur_share"], 0.9);
  EXPECT_GT(found["fraction_error"], 0.005);
  const auto sharp = findings({"--blur", "none", "--fraction-error", "0"});
  EXPECT_EQ(sharp["blur_share"], 0);
  EXPECT_EQ(sharp["fraction_error"], 0);
  EXPECT_GT(sharp["area"], 1.2 * found["area"].get<double>()) << "interfaces that hold noise are rough";
  const auto given = findings({"--blur", "0.8", "--fraction-error", "3%", "--keep-dispersed"});
  EXPECT_NEAR(given["blur_median"], std::sqrt(0.8 * 0.8 + 1.0 / 12), 0.01);
  EXPECT_EQ(given["fraction_error"], 0.03);
  EXPECT_EQ(findings({"--fraction-error", "0.03"})["fraction_error"], 0.03);
}

/// Options are checked before anything is read; the file's content would be refused.
TEST_F(FractionOptionsOf, NoSenseAreRefused) {
  write("b.vtr", "no grid");
  for (const std::string value : {"-1", "17", "sharp", "nan"}) {
    expect_wrong_usage({"reconstruct", "b.vtr", "--blur=" + value, "-o", "b.ply"},
                       {"--blur: expected a number from 0 to 4, found '" + value + "'"});
  }
  for (const std::string value : {"-1%", "60%", "0.6", "much"}) {
    expect_wrong_usage(
        {"resample", "b.vtr", "--fraction-error=" + value, "-o", "b.vtu"},
        {"--fraction-error: expected a part from 0 to 0.5, or from 0% to 50%, found '" + value + "'"});
  }
}

TEST_F(FractionOptionsOf, LabelsAreRefused) {
  std::string labels(27, '\0');
  labels[13] = 1;
  write("l.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 3\nencoding: raw\n\n" + labels);
  for (const std::string option : {"--blur=1", "--fraction-error=1%", "--keep-dispersed"}) {
    for (const std::string smooth : {"", "--smooth-labels"}) {
      std::vector<std::string> command{"reconstruct", "l.nrrd", "--labels", "l.nrrd",
                                       "--cells",     option,   "-o",       "l.ply"};
      if (!smooth.empty()) command.push_back(smooth);
      expect_wrong_usage(command,
                         {option.substr(0, option.find('=')) + ": expected volume fractions, found labels"});
    }
  }
}

}  // namespace

}  // namespace adamas::test
