// Tests what `info` prints of series.

#include "program.h"

namespace adamas::test {
namespace {

class SeriesInfo : public ProgramTest {
 protected:
  SeriesInfo() { run_well({"generate", "mixing", "--dimensions", "8", "--steps", "3", "-o", "m.pvd", "-q"}); }

  /// Returns the figures of an input, and keeps what was printed.
  [[nodiscard]] nlohmann::json figures(const std::string& input) {
    text_ = run_well({"info", input, "--json", "f.json"}).out;
    return read_json("f.json");
  }
  void expect_text(const std::string& part) const {
    EXPECT_NE(text_.find(part), std::string::npos) << part << "\n" << text_;
  }

  std::string text_;
};

TEST_F(SeriesInfo, StepsTimesAndTheFirstStep) {
  const auto one = figures("m_0000.vti");
  const auto list = figures("m.pvd");
  expect_text("m.pvd: series of 3 steps, times from 0 to 0.001, 0.0005 apart");
  expect_text("density");
  EXPECT_EQ(list["kind"], "series");
  EXPECT_EQ(list["steps"], 3);
  EXPECT_EQ(list["times"], (std::vector<double>{0, 0.0005, 0.001}));
  EXPECT_EQ(list["first_step"], one);
  const auto pattern = figures("m_%04d.vti");
  expect_text("m_%04d.vti: series of 3 steps, times from 0 to 2, 1 apart");
  EXPECT_EQ(pattern["first_step"], one);
  std::filesystem::remove(folder() / "m_0001.vti");
  expect_failure({"info", "m.pvd"}, {"m_0001.vti: expected the file of a step of m.pvd, found none"});
}

TEST_F(SeriesInfo, TimesThatAreNotEvenlySpaced) {
  const auto list = [this](const std::vector<std::string>& times) {
    std::string text = "<VTKFile type=\"Collection\"><Collection>";
    for (const std::string& time : times) text += "<DataSet timestep=\"" + time + "\" file=\"m_0000.vti\"/>";
    write("l.pvd", text + "</Collection></VTKFile>");
    return figures("l.pvd")["steps"];
  };
  EXPECT_EQ(list({"0", "1", "4"}), 3);
  expect_text("3 steps, times from 0 to 4, not evenly spaced: 0, 1, 4\n");
  EXPECT_EQ(list({"0", "1", "2", "3", "4", "5", "6", "7", "9"}), 9);
  expect_text("9 steps, times from 0 to 9, not evenly spaced: 0, 1, 2, 3, ..., 7, 9\n");
  EXPECT_EQ(list({"-2"}), 1);
  expect_text("1 step, time -2\n");
}

TEST_F(SeriesInfo, PagesOfAStepAndOfAll) {
  run_well({"store", "m.pvd", "--array", "density", "-o", "m.adm", "-q"});
  run_well({"verify", "m.adm", "--json", "v.json", "-q"});
  const auto of_store = figures("m.adm");
  EXPECT_EQ(of_store["pages"], 1);
  EXPECT_EQ(read_json("v.json")["pages"], 3);
  expect_text("1 page a step, 3 in all");
  expect_text("3 steps, times from 0 to 0.001, 0.0005 apart; in 1 block\n");
}

}  // namespace
}  // namespace adamas::test
