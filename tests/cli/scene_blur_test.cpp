// Tests `adamas generate scene --blur --noise`: what it writes, and what it refuses.

#include <array>

#include "core/io/multi_material_reader.h"
#include "program.h"

namespace adamas::test {

using namespace io;

namespace {

class SceneBlur : public ProgramTest {
 protected:
  static std::vector<std::string> scene(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate", "scene", name};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  MultiMaterialData data(const std::string& name) { return read_multi_material_data(folder() / name); }
};

TEST_F(SceneBlur, FractionsChangeAndTheTruthRemains) {
  const std::vector<std::string> sharp{"--dimensions", "12", "-o", "s.vtr", "--json", "s.json"};
  const std::vector<std::string> blurred{"--dimensions", "12", "--blur", "1",      "--noise",
                                         "2%",           "-o", "b.vtr",  "--json", "b.json"};
  run_well(scene("sphere", sharp));
  run_well(scene("sphere", blurred));
  EXPECT_NE(data("b.vtr").fractions, data("s.vtr").fractions);
  auto figures = read_json("b.json");
  EXPECT_EQ(figures["materials"], read_json("s.json")["materials"]);
  EXPECT_EQ(figures["blur"], 1);
  EXPECT_EQ(figures["noise"], 0.02);
  EXPECT_EQ(read_json("s.json")["blur"], 0);
}

TEST_F(SceneBlur, NoiseIsAPartOrAPercentage) {
  const auto write_noisy = [&](const std::string& noise, const std::string& file) {
    run_well(scene("reflex", {"--dimensions", "6", "--noise", noise, "-o", file}));
    return read(file);
  };
  const std::string one = write_noisy("2%", "a.vtr");
  EXPECT_EQ(write_noisy("0.02", "b.vtr"), one);
  EXPECT_NE(write_noisy("3%", "c.vtr"), one);
}

TEST_F(SceneBlur, TheSeedChoosesTheNoiseAndThreadsDoNot) {
  const auto write_noisy = [&](const std::string& seed, const std::string& threads, const std::string& file) {
    run_well(scene("sphere", {"--dimensions", "20", "--blur", "0.7", "--noise", "1%", "--seed", seed,
                              "--threads", threads, "-o", file}));
    return read(file);
  };
  const std::string one = write_noisy("1", "1", "a.vtr");
  EXPECT_EQ(write_noisy("1", "2", "b.vtr"), one);
  EXPECT_NE(write_noisy("2", "1", "c.vtr"), one);
}

TEST_F(SceneBlur, EachStepOfASeriesHasNoiseOfItsOwn) {
  const std::vector<std::string> noisy{"--dimensions", "10", "--blur", "0.5", "--noise", "5%"};
  const auto with = [&noisy](std::vector<std::string> more) {
    more.insert(more.begin(), noisy.begin(), noisy.end());
    return more;
  };
  run_well(scene("moving", with({"--steps", "3", "-o", "s.pvd"})));
  run_well(scene("moving", with({"-o", "last.vtr"})));
  EXPECT_EQ(read("last.vtr"), read("s_0002.vtr"));
  run_well(scene("moving", {"--dimensions", "10", "--blur", "0.5", "--steps", "3", "-o", "b.pvd"}));
  const std::array steps{data("s_0000.vtr"), data("s_0002.vtr")},
      without{data("b_0000.vtr"), data("b_0002.vtr")};
  const auto noise = [&](std::size_t step, std::size_t site) {
    return steps[step].fraction(MaterialId(0), site) - without[step].fraction(MaterialId(0), site);
  };
  std::size_t both = 0;
  for (std::size_t site = 0; site < 1000; site += 7) {
    const float first = noise(0, site), last = noise(1, site);
    if (first == 0 || last == 0) continue;
    ++both;
    EXPECT_NE(first, last);
  }
  EXPECT_GT(both, 5u);
}

TEST_F(SceneBlur, WrongUsage) {
  for (const std::string value : {"-1", "16.5", "nan", "inf", "1e999", "two", "1 ", "2%"}) {
    expect_wrong_usage(scene("sphere", {"--dimensions", "4", "-o", "s.vtr", "--blur=" + value}),
                       {"--blur: expected a number from 0 to 16, found '" + value + "'"});
  }
  for (const std::string value : {"-1", "-1%", "1.5", "101%", "nan", "nan%", "inf%", "two", "%", "2 %"}) {
    expect_wrong_usage(scene("sphere", {"--dimensions", "4", "-o", "s.vtr", "--noise=" + value}),
                       {"--noise: expected a part from 0 to 1, or from 0% to 100%, found '" + value + "'"});
  }
  expect_wrong_usage(scene("sphere", {"--interfaces", "s.vtp", "--blur", "1"}), {"--blur: expected -o"});
  for (const std::string option : {"--blur", "--noise"}) {
    expect_wrong_usage(
        scene("moving", {"--dimensions", "4", "--volume", "uint8", "-o", "s.vti", option, "1"}),
        {option + ": expected volume fractions, found --volume uint8"});
  }
}

}  // namespace

}  // namespace adamas::test
