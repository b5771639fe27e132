// Tests command lines that make no sense: they lead to status 2, one line and a hint.

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
  expect_wrong_usage({"reconstruct", "x.vtr"}, {"-o, --side-sets, --picture or --json"});
  expect_wrong_usage({"resample", "-o", "m.vtu"}, {"expected an INPUT, --interface, or files", "found none"});
  expect_wrong_usage({"resample", "x.vtr"}, {"nothing to write", "--interfaces-out", "found none"});
}

TEST_F(WrongUsage, IsToldAsExpectedAndFound) {
  expect_wrong_usage({"resample", "x.vtr", "--interface-eror", "1%"},
                     {"expected an option of 'adamas resample', found '--interface-eror'",
                      "did you mean --interface-error?"});
  expect_wrong_usage({"resampel", "x.vtr"}, {"found 'resampel' (did you mean resample?)"});
  expect_wrong_usage({"info", "a.vtr", "b.vtr"}, {"expected no more arguments, found 'b.vtr'"});
  expect_wrong_usage({"resample", "x.vtr", "--interface-error", "1%", "--interface-error", "2%"},
                     {"--interface-error: expected one value, found '1%', '2%'"});
  expect_wrong_usage({"resample", "x.vtr", "--ghost", "quadratic"},
                     {"--ghost: expected constant, linear or least-squares, found 'quadratic'"});
  expect_wrong_usage({"resample", "x.vtr", "--interface-error"},
                     {"--interface-error: expected a value E|E%|Evoxels, found none"});
  expect_wrong_usage({"slice", "x.vtr", "--draw-cells=maybe"},
                     {"--draw-cells: expected no value", "found 'maybe'"});
  expect_wrong_usage({"info"},
                     {"expected a FILE, or files in --fraction, --fractions or --labels, found neither"});
  expect_wrong_usage({"info", "x.vtr", "--config", "none.toml"}, {"--config: expected a file", "none.toml"});
}

TEST_F(WrongUsage, MissingAndRepeatedValues) {
  expect_wrong_usage({"store"}, {"expected INPUT, found none"});
  expect_wrong_usage({"store", "v.nrrd"}, {"expected -o,--output FILE, found none"});
  expect_wrong_usage({"store", "-o", "v.adm"}, {"expected INPUT, found none"});
  expect_wrong_usage({"generate", "scene"}, {"expected NAME, found none"});
  const std::string none = "--json: expected a value FILE, found none";
  expect_wrong_usage({"info", "x.vtr", "--json"}, {none});
  expect_wrong_usage({"info", "x.vtr", "--json="}, {none});
  expect_wrong_usage({"info", "x.vtr", "--json", "a.json", "--json"}, {none});
  expect_wrong_usage({"info", "x.vtr", "-c"}, {"--config: expected a value FILE, found none"});
  expect_wrong_usage({"info", "x.vtr", "-qc"}, {"--config: expected a value FILE, found none"});
  expect_wrong_usage({"slice", "x.vtr", "--field", "a", "--field"},
                     {"--field: expected a value", "found none"});
  expect_wrong_usage({"info", "x.vtr", "--json", "a.json", "-v", "--json", "b.json"},
                     {"--json: expected one value, found 'a.json', 'b.json'"});
}

TEST_F(WrongUsage, FlagsWithValues) {
  const std::string expected = "expected no value, or true or false, found ";
  expect_wrong_usage({"info", "x.vtr", "--quiet=maybe"}, {"--quiet: " + expected + "'maybe'"});
  expect_wrong_usage({"--version=maybe"}, {"--version: " + expected + "'maybe'"});
  expect_wrong_usage({"info", "x.vtr", "--quiet", "--verbose=2x"}, {"--verbose: " + expected + "'2x'"});
  write("c.toml", "quiet = perhaps\n");
  expect_wrong_usage({"info", "x.vtr", "-c", "c.toml"}, {"--quiet: " + expected + "'perhaps'"});
  make_scene("sphere", 4);
  EXPECT_EQ(run_well({"info", "scene.vtr", "--quiet=true"}).out, "");
  EXPECT_EQ(run_well({"info", "scene.vtr", "--quiet=on"}).out, "");
  EXPECT_NE(run_well({"info", "scene.vtr", "--quiet=false"}).out, "");
}

TEST_F(WrongUsage, EmptyAndSwallowedValues) {
  for (const std::string option : {"-o", "--json", "--interfaces-out", "--labels"}) {
    expect_wrong_usage({"resample", "x.vtr", option, ""}, {"expected a value, found an empty one"});
  }
  expect_wrong_usage({"slice", "x.vtr", "--plane", "x=1", "--field", "-o", "o.png"},
                     {"--field: expected a value, found the option '-o'"});
  expect_wrong_usage({"info", "x.vtr", "--labels", "--json", "o.json"}, {"--labels", "'--json'"});
}

TEST_F(WrongUsage, OptionsThatWouldSayNothing) {
  make_scene("sphere", 4);
  run_well({"resample", "scene.vtr", "--interface-error", "9%", "-o", "m.vtu"});
  expect_wrong_usage({"resample", "scene.vtr", "--tolerant", "-o", "n.vtu"}, {"--tolerant: expected given"});
  expect_wrong_usage({"resample", "scene.vtr", "--box", "0,1,0,1,0,1", "-o", "n.vtu"}, {"--box: expected"});
  expect_wrong_usage({"probe", "scene.vtr", "--tolerant"}, {"--tolerant: expected given interfaces"});
  expect_wrong_usage({"reconstruct", "scene.vtr", "--smooth-labels", "-o", "n.vtp"},
                     {"--smooth-labels: expected labels, found volume fractions in scene.vtr"});
  expect_wrong_usage({"probe", "m.vtu", "--smooth-labels"}, {"--smooth-labels: expected"});
  expect_wrong_usage({"probe", "m.vtu", "--tolerant"}, {"--tolerant: expected given interfaces"});
  expect_wrong_usage({"info", "m.vtu", "--labels", "foo"}, {"--labels: expected data on a grid"});
  expect_wrong_usage({"info", "scene.vtr", "--region-names", "foo"}, {"--region-names: expected"});
  expect_wrong_usage(
      {"generate", "scene", "sphere", "--resolution", "0.1", "--dimensions", "4", "-o", "g.vtr"},
      {"--resolution: expected --interfaces"});
  const std::vector<std::vector<std::string>> options{{"--box", "0,1,0,1,0,1"},
                                                      {"--tolerant"},
                                                      {"--region-names", "names.txt"},
                                                      {"--range", "0,1"},
                                                      {"--colour-map", "grey"}};
  for (const auto& option : options) {
    std::vector<std::string> slice{"slice", "scene.vtr", "--plane", "x=0.5", "-o", "s.png"};
    slice.insert(slice.end(), option.begin(), option.end());
    expect_wrong_usage(slice, {option[0], "expected"});
  }
  expect_wrong_usage({"slice", "m.vtu", "--plane", "x=0.5", "-o", "s.png", "--mode", "plain"},
                     {"--mode plain: expected --field"});
  expect_wrong_usage({"completion", "bash", "--json", "o.json"}, {"found '--json'"});
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
  for (const std::string error : {"5", "1.7321", "100%", "500%"}) {
    expect_wrong_usage({"resample", "scene.vtr", "-o", "m.vtu", "--interface-error", error},
                       {"--interface-error: expected less than the domain's diagonal, 1.73205", "1%"});
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
  // The number is valid, but too small to hold the domain.
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
  expect_wrong_usage({"generate", "scene", "sphere", "--dimensions", "4", "--seed", "-1", "-o", "s.vtr"},
                     {"--seed", "at least 0", "'-1'"});
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
  expect_wrong_usage(with({"--plane", "w=1"}), {"error: --plane: expected x=NUMBER", "'w=1'"});
  expect_wrong_usage(with({"--origin", "0,0,0"}), {"--normal"});
  expect_wrong_usage(with({"--origin", "0,0,0", "--normal", "0,0,0"}), {"--normal", "expected"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--field", "smooth", "--range", "2,1"}),
                     {"--range", "expected", "2,1"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--size", "10,10"}), {"--size", "expected", "10,10"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--frame-rate", "0"}),
                     {"--frame-rate: expected a positive number, found '0'"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--field", "smooth", "--mode", "plain"}),
                     {"--mode", "expected a resampled mesh"});
  expect_wrong_usage(with({"--plane", "x=0.5", "--colour-map", "rainbow"}), {"rainbow", "sequential"});
}

TEST_F(WrongUsage, Probes) {
  make_scene("sphere", 4);
  for (const std::string line :
       {"0,0,0", "0,0,0..1,1,1", "0,0..1,1,1,5", "0,0,0..1,1,1,1", "0,0,0..1,1,nan,4"}) {
    expect_wrong_usage({"probe", "scene.vtr", "--line=" + line}, {"--line", "expected"});
  }
  expect_wrong_usage({"probe", "scene.vtr", "--line", "0,0,0..1,1,1"},
                     {"expected x,y,z..x,y,z,n", "found '0,0,0..1,1,1'"});
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
  for (const std::string file : {"none.toml", "."}) {
    expect_wrong_usage({"resample", "scene.vtr", "--config", file},
                       {"--config: expected a file that can be read, found '" + file + "'"});
  }
  write("a.toml", "quiet = true\n");
  expect_wrong_usage({"info", "scene.vtr", "--config", "a.toml", "--config", "none.toml"},
                     {"--config: expected one value, found 'a.toml', 'none.toml'"});
  write("c.toml", "nonsense = 3\n");
  expect_wrong_usage({"resample", "scene.vtr", "--config", "c.toml"}, {"expected options", "'nonsense'"});
  write("c.toml", "[nonsense]\nghost = \"linear\"\n");
  expect_wrong_usage({"resample", "scene.vtr", "--config", "c.toml"}, {"expected sections", "'nonsense'"});
  for (const std::string line : {"=1", " = 1", "x", "\"\" = 1", "-- = 1"}) {
    write("c.toml", "# a comment\n\n; another\nquiet = true\n" + line + "\n");
    expect_wrong_usage({"info", "scene.vtr", "--config", "c.toml"},
                       {"--config: expected lines NAME = VALUE"});
  }
}

TEST_F(WrongUsage, ConfigurationsThatCannotBeReadWhole) {
  make_scene("sphere", 4);
  const auto expect = [this](const std::string& file, const std::string& message) {
    expect_wrong_usage({"info", "scene.vtr", "--config", file}, {"--config: expected a file " + message});
  };
  expect("/proc/self/mem", "that can be read whole, found an error");
  expect("/dev/zero", "of at most 1048576 bytes, found more");
  const std::string limit = "quiet = true\n";
  write("c.toml", limit + std::string((1 << 20) - limit.size(), '\n'));
  EXPECT_EQ(run({"info", "scene.vtr", "--config", "c.toml"}).status, 0);
  write("c.toml", limit + std::string((1 << 20) + 1 - limit.size(), '\n'));
  expect("c.toml", "of at most 1048576 bytes, found more");
}

}  // namespace

}  // namespace adamas::test
