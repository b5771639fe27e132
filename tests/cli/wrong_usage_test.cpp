// Command lines that make no sense: status 2, one line and a hint.

#include "program.h"

namespace adamas::test {

namespace {

class WrongUsage : public ProgramTest {};

TEST_F(WrongUsage, Commands) {
  expect_wrong_usage({}, {"expected one of generate, info, reconstruct", "found none"});
  expect_wrong_usage({"nonsense"}, {"expected one of generate", "found 'nonsense'"});
  expect_wrong_usage({"resample", "x.vtr", "--nonsense"}, {"--nonsense"});
  expect_wrong_usage({"generate"}, {"expected one of scene", "found none"});
  expect_wrong_usage({"generate", "soup"}, {"expected one of scene", "found 'soup'"});
  expect_wrong_usage({"reconstruct", "x.vtr"}, {"output"});
  expect_wrong_usage({"resample", "-o", "m.vtu"}, {"expected an INPUT or --interface", "found neither"});
}

TEST_F(WrongUsage, AbsurdErrors) {
  make_scene("sphere", 4);
  for (const std::string error :
       {"0", "-1", "nan", "inf", "-inf", "1e999", "abc", "1x", "%", "0%", "-3%", "nan%", "1 %"}) {
    expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--interface-error=" + error},
                       {"--interface-error", "expected a positive error", "'" + error + "'"});
    expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--field-error", "smooth=" + error},
                       {"--field-error smooth", "expected a positive error", "'" + error + "'"});
  }
  expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--field-error", "smooth"}, {"--field-error"});
  expect_wrong_usage({"resample", "scene.vtr", "--field-error", "smooth=1", "--field-error", "smooth=2"},
                     {"--field-error", "'smooth' twice"});
}

TEST_F(WrongUsage, AbsurdCounts) {
  make_scene("sphere", 4);
  for (const std::string count : {"0", "-5", "1.5", "nan", "abc", "99999999999999999999999", "1e6"}) {
    expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--max-tetrahedra", count},
                       {"--max-tetrahedra", "expected a whole number", "'" + count + "'"});
    expect_wrong_usage({"info", "scene.vtr", "--threads", count},
                       {"--threads", "expected", "'" + count + "'"});
    expect_wrong_usage({"generate", "scene", "sphere", "--dimensions", "4,4," + count, "-o", "s.vtr"},
                       {"--dimensions", "expected", count});
  }
  // A sound number, but too small to hold the domain.
  expect_failure({"resample", "scene.vtr", "-o", "m.vtu", "--max-tetrahedra", "1"},
                 {"scene.vtr", "expected room for at least 6", "1"});
  expect_wrong_usage({"info", "scene.vtr", "--threads", "1000000"}, {"--threads", "expected at most"});
}

TEST_F(WrongUsage, Scenes) {
  expect_wrong_usage({"generate", "scene", "nonsense", "--dimensions", "4,4,4", "-o", "s.vtr"},
                     {"nonsense", "tjunction"});
  expect_wrong_usage({"generate", "scene", "sphere", "-o", "s.vtr"}, {"--dimensions"});
  expect_wrong_usage({"generate", "scene", "sphere"}, {"expected -o or --interfaces"});
  for (const std::string box : {"0,0,0,1,0,1", "1,0,0,1,0,1", "0,1,0,1", "0,1,0,1,0,inf"}) {
    expect_wrong_usage({"generate", "scene", "sphere", "--dimensions", "4,4,4", "--box", box, "-o", "s.vtr"},
                       {"--box", "expected", box});
  }
  for (const std::string size : {"0", "-1", "nan", "x"}) {
    expect_wrong_usage({"generate", "scene", "sphere", "--resolution", size, "--interfaces", "s.vtp"},
                       {"--resolution", "expected a positive number", size});
  }
}

TEST_F(WrongUsage, DataThatNeedMoreMemoryThanThereIs) {
  expect_failure({"generate", "scene", "sphere", "--dimensions", "100000,100000,100000", "-o", "s.vtr"},
                 {"expected", "memory"});
}

TEST_F(WrongUsage, Slices) {
  make_scene("sphere", 4);
  const std::vector<std::string> slice{"slice", "scene.vtr", "-o", "s.png"};
  const auto with = [&slice](const std::vector<std::string>& more) {
    auto all = slice;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_wrong_usage(slice, {"expected --plane, or --origin and --normal"});
  expect_wrong_usage(with({"--plane", "x=nan"}), {"--plane"});
  expect_wrong_usage(with({"--plane", "w=1"}), {"--plane"});
  expect_wrong_usage(with({"--origin", "0,0,0"}), {"--normal"});
  expect_wrong_usage(with({"--origin", "0,0,0", "--normal", "0,0,0"}), {"--normal", "expected"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--range", "2,1"}), {"--range", "expected", "2,1"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--size", "10,10"}), {"--size", "expected", "10,10"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--mode", "plain"}), {"--mode", "expected a resampled mesh"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--colour-map", "rainbow"}), {"rainbow", "sequential"});
}

TEST_F(WrongUsage, Probes) {
  make_scene("sphere", 4);
  for (const std::string line :
       {"0,0,0", "0,0,0..1,1,1", "0,0..1,1,1,5", "0,0,0..1,1,1,1", "0,0,0..1,1,nan,4"}) {
    expect_wrong_usage({"probe", "scene.vtr", "--line=" + line}, {"--line", "expected"});
  }
  expect_wrong_usage({"probe", "scene.vtr", "--point", "1,2"}, {"--point", "expected", "1,2"});
}

TEST_F(WrongUsage, OutputNames) {
  make_scene("sphere", 4);
  expect_wrong_usage({"resample", "scene.vtr", "-o", "m.stl"}, {"-o", "expected", ".vtu", "m.stl"});
  expect_wrong_usage({"reconstruct", "scene.vtr", "-o", "m"}, {"-o", "expected", ".vtp", "m"});
  expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--cut-mesh", "./m.vtu"}, {"m.vtu twice"});
}

TEST_F(WrongUsage, Configurations) {
  make_scene("sphere", 4);
  expect_wrong_usage({"resample", "scene.vtr", "--config", "none.toml"}, {"none.toml"});
  write("c.toml", "nonsense = 3\n");
  expect_wrong_usage({"resample", "scene.vtr", "--config", "c.toml"}, {"expected options", "'nonsense'"});
  write("c.toml", "[nonsense]\nghost = \"linear\"\n");
  expect_wrong_usage({"resample", "scene.vtr", "--config", "c.toml"}, {"expected sections", "'nonsense'"});
}

}  // namespace

}  // namespace adamas::test
