// Tests series of data: a mesh per step, figures over time, slices and films.

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/base/child_process.h"
#include "program.h"

namespace adamas::test {

namespace {

class Series : public ProgramTest {
 protected:
  void make_series(const std::string& steps = "4", const std::string& cells = "7,6,8",
                   const std::string& name = "s.pvd") const {
    run_well({"generate", "scene", "moving", "--dimensions", cells, "--steps", steps, "-o", name, "-q"});
  }
  static std::vector<std::string> with(std::vector<std::string> arguments,
                                       const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  /// Runs the program; notes are allowed, also about errors that were not reached.
  RunResult run_noted(const std::vector<std::string>& arguments) const {
    RunResult result = run(arguments);
    EXPECT_TRUE(result.status == 0 || result.status == 3) << result.err;
    return result;
  }
};

const std::vector<std::string> kErrors{"--interface-error", "4%", "--field-error", "smooth=5%"};

TEST_F(Series, EachMeshIsThatOfItsStepAlone) {
  make_series();
  run_noted(
      with({"resample", "s.pvd", "-o", "m.pvd", "--json", "j.json", "--curves", "c.csv", "--curves", "c.svg"},
           kErrors));
  const auto figures = read_json("j.json");
  ASSERT_EQ(figures["steps"].size(), 4u);
  std::size_t merged = 0, split = 0;
  for (int n = 0; n < 4; ++n) {
    const std::string number = "000" + std::to_string(n);
    run_noted(with({"resample", "s_" + number + ".vtr", "-o", "one.vtu", "--json", "one.json"}, kErrors));
    EXPECT_TRUE(read("one.vtu") == read("m_" + number + ".vtu")) << n;
    // The figures of a step are all those of a single run, except its duration.
    const auto one = read_json("one.json");
    const auto& step = figures["steps"][static_cast<std::size_t>(n)];
    EXPECT_EQ(step["step"], n);
    EXPECT_EQ(step["file"], "s_" + number + ".vtr");
    EXPECT_NEAR(step["time"].get<double>(), n / 3.0, 1e-12);
    for (const auto& [key, value] : one.items()) {
      if (key != "seconds" && key != "processor_seconds" && key != "peak_memory_bytes" && key != "cut_mesh") {
        EXPECT_EQ(step[key], value) << key;
      }
    }
    if (n == 0) continue;
    merged += step["adaptation"]["merged"].get<std::size_t>();
    split += step["adaptation"]["split"].get<std::size_t>();
  }
  EXPECT_GT(merged, 0u);
  // The mesh has this field exactly.
  EXPECT_NE(read("c.svg").find("without error: constant"), std::string::npos);
  EXPECT_GT(split, 0u);
  EXPECT_NE(read("m.pvd").find("timestep=\"1\" part=\"0\" file=\"m_0003.vtu\""), std::string::npos);
  // Below the heads there is a line per step, and all lines have the same number of fields.
  std::istringstream lines(read("c.csv"));
  std::size_t count = 0, commas = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto found = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (count == 0) commas = found;
    EXPECT_EQ(found, commas) << line;
  }
  EXPECT_EQ(count, 5u);
  for (const char* text :
       {"tetrahedra", "certified", "pool", "smooth", "volume, as a part of the greatest in the input"})
    EXPECT_NE(read("c.svg").find(text), std::string::npos) << text;
}

/// No list is left behind that names files which do not exist.
/// Colours that a step has are those of all later ones too, in meshes and in curves.
TEST_F(Series, AllStepsHaveTheColoursOfTheFiles) {
  for (const int step : {0, 1, 2}) {
    std::string labels;
    for (int site = 0; site < 6 * 6 * 6; ++site) labels += static_cast<char>(site % 6 > step ? 2 : 1);
    write("p_" + std::to_string(step) + ".seg.nrrd",
          std::string("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 6 6\nencoding: raw\n"
                      "Segment0_Name:=bone\nSegment0_LabelValue:=1\n"
                      "Segment1_Name:=skin\nSegment1_LabelValue:=2\n") +
              (step == 1 ? "\n" : "Segment0_Color:=0.5 0.25 0.75\n\n") + labels);
  }
  run_well({"resample", "p_0.seg.nrrd", "p_1.seg.nrrd", "p_2.seg.nrrd", "--cells", "--interface-error", "20%",
            "-o", "m_%d.vtu", "--curves", "c.svg"});
  const std::string bone = "rgb(50%,25%,75%)";
  for (const std::string mesh : {"m_0.vtu", "m_1.vtu", "m_2.vtu"}) {
    run_well({"slice", mesh, "--plane", "z=2.7", "--no-interfaces", "-o", "s.svg"});
    EXPECT_NE(read("s.svg").find(bone), std::string::npos) << mesh;
  }
  EXPECT_NE(read("c.svg").find(bone), std::string::npos);
}

TEST_F(Series, NamesThatCannotBe) {
  make_series("2");
  const std::string longest(251, 'm');
  for (const std::string& name : {longest + ".pvd", std::string(250, 'm') + "_%04d.vtu"})
    expect_failure({"resample", "s.pvd", "--interface-error", "8%", "-o", name},
                   {"expected a file name of at most 255 bytes, found one of"});
  for (const char* name : {"a\x1b.pvd", "a\xff.pvd"}) {
    expect_failure({"resample", "s.pvd", "--interface-error", "8%", "-o", name},
                   {"expected names of files of UTF-8 without control characters"});
    expect_failure({"generate", "scene", "moving", "--dimensions", "6", "--steps", "2", "-o", name},
                   {"expected names of files of UTF-8 without control characters"});
  }
  for (const char* name : {"m_%300d.vtu", "m_%2147483647d.vtu"})
    expect_wrong_usage({"resample", "s.pvd", "--interface-error", "8%", "-o", name},
                       {"expected a list of steps (.pvd) or a pattern of names"});
  for (const char* name : {"s_%300d.vtr", "s_%2147483647d.vtr"})
    expect_failure({"resample", name, "--interface-error", "8%", "-o", "m.pvd"},
                   {"expected numbers of at most 20 digits"});
}

TEST_F(Series, NumberedFiles) {
  make_series("3");
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "-o", "m.pvd"});
  run_noted({"resample", "-q", "s_0000.vtr", "s_0001.vtr", "s_0002.vtr", "--interface-error", "8%", "-o",
             "a_%d.vtu"});
  run_noted({"resample", "-q", "s_####.vtr", "--interface-error", "8%", "-o", "b_##.vtu"});
  for (const std::string number : {"0", "1", "2"}) {
    EXPECT_TRUE(read("a_" + number + ".vtu") == read("m_000" + number + ".vtu")) << number;
    EXPECT_TRUE(read("b_0" + number + ".vtu") == read("m_000" + number + ".vtu")) << number;
  }
}

TEST_F(Series, TheNumberOfThreadsChangesNothing) {
  make_series("3");
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "-o", "a.pvd", "--curves", "a.csv",
             "--threads", "1"});
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "-o", "b.pvd", "--curves", "b.csv",
             "--threads", "3"});
  EXPECT_TRUE(read("a.csv") == read("b.csv"));
  for (const std::string number : {"0", "1", "2"})
    EXPECT_TRUE(read("a_000" + number + ".vtu") == read("b_000" + number + ".vtu")) << number;
}

TEST_F(Series, MassesOverTime) {
  run_well({"generate", "impact", "--dimensions", "8,8,12", "--steps", "3", "-o", "i.pvd", "-q"});
  run_noted({"resample", "i.pvd", "--interface-error", "5%", "-o", "m.pvd", "--json", "j.json"});
  const auto figures = read_json("j.json");
  for (const auto& step : figures["steps"]) {
    // The step's masses are the integrals of the density in the ledger, which has integrals of all fields.
    for (const auto& material : step["materials"]) {
      for (const std::string of : {"input", "mesh"}) {
        double mass = -1, volume = -1;
        for (const auto& row : step["ledger"]) {
          if (row["of"] != of || row["material"] != material["name"]) continue;
          mass = row["integrals"]["density"].get<double>();
          volume = row["volume"].get<double>();
        }
        EXPECT_DOUBLE_EQ(material["mass_" + of].get<double>(), mass);
        EXPECT_NEAR(material["volume_" + of].get<double>(), volume, 1e-6 * volume + 1e-9);
      }
    }
  }
  const RunResult told = run_noted({"resample", "i.pvd", "--interface-error", "5%", "--curves", "c.csv"});
  EXPECT_NE(told.out.find("mass of projectile"), std::string::npos) << told.out;
}

/// Returns the texts of an SVG picture without the time and the step.
std::string texts_of(const std::string& svg) {
  const std::size_t begin = svg.find("<desc>"), end = svg.find("</desc>");
  std::string texts = svg.substr(begin, end - begin);
  const std::size_t time = texts.find("time ");
  EXPECT_NE(time, std::string::npos) << texts;
  return texts.erase(time, texts.find(": ", time) - time);
}

TEST_F(Series, SlicesHaveOneScale) {
  make_series("3");
  run_well(
      {"slice", "s.pvd", "--plane", "z=0.15", "--field", "smooth", "-o", "p_%d.svg", "--json", "j.json"});
  const auto figures = read_json("j.json");
  ASSERT_EQ(figures["steps"].size(), 3u);
  double low = 1e300, high = -1e300;
  for (int n = 0; n < 3; ++n) {
    const std::string number = std::to_string(n);
    EXPECT_EQ(texts_of(read("p_" + number + ".svg")), texts_of(read("p_0.svg"))) << n;
    EXPECT_NE(read("p_" + number + ".svg").find("step " + number), std::string::npos);
    // The common range extends from the least to the greatest value of all steps.
    run_well({"slice", "s_000" + number + ".vtr", "--plane", "z=0.15", "--field", "smooth", "-o", "one.vtp",
              "--json", "one.json"});
    run_well({"slice", "s_000" + number + ".vtr", "s_000" + number + ".vtr", "--plane", "z=0.15", "--field",
              "smooth", "-o", "twice_%d.svg", "--json", "twice.json"});
    const auto range = read_json("twice.json")["range"];
    low = std::min(low, range[0].get<double>());
    high = std::max(high, range[1].get<double>());
    EXPECT_EQ(figures["steps"][static_cast<std::size_t>(n)]["materials"], read_json("one.json")["materials"]);
  }
  EXPECT_EQ(figures["range"][0], low);
  EXPECT_EQ(figures["range"][1], high);
  run_well({"slice", "s.pvd", "--plane", "z=0.15", "--field", "smooth", "--range", "-5,5", "-o", "r_%d.svg",
            "--json", "r.json"});
  EXPECT_EQ(read_json("r.json")["range"], (std::vector<double>{-5, 5}));
  // The legend has the materials of all steps.
  run_well({"slice", "s.pvd", "--plane", "y=0.5", "-o", "q_%d.svg"});
  for (const char* number : {"1", "2"})
    EXPECT_EQ(texts_of(read(std::string("q_") + number + ".svg")), texts_of(read("q_0.svg")));
}

TEST_F(Series, SlicesOfMeshes) {
  make_series("3");
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "-o", "m.pvd"});
  run_well({"slice", "m.pvd", "--plane", "z=0.15", "--field", "smooth", "--mode", "all", "--original",
            "s.pvd", "-o", "p_%d.svg"});
  for (const char* text : {"time 0.5, step 1: input", "plain linear interpolation", "fields per material"})
    EXPECT_NE(read("p_1.svg").find(text), std::string::npos) << text;
  run_well({"slice", "m.pvd", "--plane", "z=0.15", "--field", "smooth", "-o", "l.pvd"});
  run_well({"slice", "m_0002.vtu", "--plane", "z=0.15", "--field", "smooth", "-o", "one.vtp"});
  EXPECT_TRUE(read("l_0002.vtp") == read("one.vtp"));
  EXPECT_NE(read("l.pvd").find("timestep=\"0.5\" part=\"0\" file=\"l_0001.vtp\""), std::string::npos);
  make_series("2", "7,6,8", "short.pvd");
  expect_failure({"slice", "m.pvd", "--plane", "z=0.15", "--original", "short.pvd", "-o", "x_%d.svg"},
                 {"short.pvd: expected 3 steps as m.pvd has, found 2"});
}

TEST_F(Series, Films) {
  make_series("3");
  const std::vector<std::string> slice{"slice",   "s.pvd",  "--plane", "z=0.15",
                                       "--field", "smooth", "--size",  "400,400"};
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder().c_str(), 1);
  expect_failure(with(slice, {"-o", "f.mp4"}), {"f.mp4: expected the program ffmpeg"});
  expect_failure({"resample", "-q", "s.pvd", "--film", "f.gif", "--plane", "z=0.15"},
                 {"f.gif: expected the program ffmpeg"});
  ::setenv("PATH", path.c_str(), 1);
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  run_well(with(slice, {"-o", "f.mp4", "--frame-rate", "3"}));
  run_well(with(slice, {"-o", "g.mp4", "--frame-rate", "3", "--threads", "1"}));
  EXPECT_GT(read("f.mp4").size(), 1000u);
  EXPECT_TRUE(read("f.mp4") == read("g.mp4"));
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "--film", "m.gif", "--plane", "z=0.15",
             "--show", "smooth"});
  EXPECT_EQ(read("m.gif").substr(0, 4), "GIF8");
  expect_failure({"resample", "-q", "s.pvd", "--interface-error", "8%", "--film", "n.gif", "--plane", "z=7"},
                 {"expected a plane that cuts", "z=7"});
}

TEST_F(Series, StepsThatDiffer) {
  make_series("3", "9,9,10");
  const std::vector<std::string> resample{"resample", "-q", "s.pvd", "--interface-error",
                                          "4%",       "-o", "m.pvd"};
  const std::vector<std::string> slice{"slice", "s.pvd", "--plane", "z=0.15", "-o", "p_%d.svg"};
  const std::string kept = read("s_0002.vtr");
  std::filesystem::remove(folder() / "s_0002.vtr");
  for (const auto& command : {resample, slice})
    expect_failure(command, {"s_0002.vtr: expected the file of a step of s.pvd, found none"});
  run_well({"generate", "scene", "moving", "--dimensions", "9,9,11", "-o", "s_0002.vtr", "-q"});
  for (const auto& command : {resample, slice})
    expect_failure(command,
                   {"s_0002.vtr: expected 9 x 9 x 10 cells as s_0000.vtr has, found 9 x 9 x 11 cells"});
  run_well({"generate", "scene", "moving", "--dimensions", "9,9,10", "--box", "0,1,0,1,0,2", "-o",
            "s_0002.vtr", "-q"});
  for (const auto& command : {resample, slice})
    expect_failure(command, {"s_0002.vtr: expected the box of s_0000.vtr", "found"});
  run_well({"generate", "scene", "sphere", "--dimensions", "9,9,10", "-o", "s_0002.vtr", "-q"});
  for (const auto& command : {resample, slice})
    expect_failure(command, {"s_0002.vtr: expected the materials of s_0000.vtr ('surrounding'", "found"});
  write("s_0002.vtr", "none");
  // A damaged step is left out, and the others do not change.
  for (const auto& command : {resample, slice}) {
    const RunResult result = run(command);
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_NE(result.err.find("s_0002.vtr: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("step 2 is left out"), std::string::npos) << result.err;
  }
  const auto made = files();
  for (const char* name : {"m_0000.vtu", "m_0001.vtu", "p_0.svg", "p_1.svg"})
    EXPECT_TRUE(made.contains(name));
  for (const char* name : {"m_0002.vtu", "p_2.svg"}) EXPECT_FALSE(made.contains(name)) << name;
  EXPECT_EQ(read("m.pvd").find("m_0002"), std::string::npos);
  write("s_0002.vtr", kept);
  run_noted(resample);
}

TEST_F(Series, ExperimentsGoOnWithoutDamagedSteps) {
  make_series("3");
  for (const int damaged : {1, 2}) {
    const std::string number = std::to_string(damaged), file = "s_000" + number + ".vtr",
                      out = "out" + number;
    const std::string kept = read(file);
    write(file, "none");
    const RunResult result = run({"experiment", "s.pvd", "--interface-error", "8%", "-o", out});
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_NE(result.err.find(file + ": "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("step " + number + " is left out"), std::string::npos) << result.err;
    EXPECT_NE(read(out + "/report.html").find("step " + number + " is left out"), std::string::npos);
    const auto metrics = read_json(out + "/metrics.json");
    EXPECT_EQ(metrics["damaged_steps"], std::vector<int>{damaged});
    ASSERT_EQ(metrics["steps"].size(), 2u);
    EXPECT_EQ(metrics["steps"][1]["step"], 3 - damaged);
    for (int step = 0; step < 3; ++step)
      EXPECT_EQ(std::filesystem::exists(folder() / (out + "/mesh_000" + std::to_string(step) + ".vtu")),
                step != damaged);
    write(file, kept);
  }
}

/// A step that is whole but lacks the field asked for does not count as damaged.
TEST_F(Series, AFieldThatAStepHasNotEndsTheRun) {
  make_series("2");
  std::string step = read("s_0001.vtr");
  const std::string name = "mixed smooth";
  for (std::size_t at = 0; (at = step.find(name, at)) != std::string::npos; at += name.size())
    step.replace(at, name.size(), "mixed Smooth");
  write("s_0001.vtr", step);
  expect_failure({"slice", "s.pvd", "--plane", "z=0.15", "--field", "mixed smooth", "-o", "p_%d.svg"},
                 {"s_0001.vtr", "mixed smooth"});
}

TEST_F(Series, WrongUsage) {
  make_series("2");
  expect_wrong_usage({"resample", "s.pvd", "-o", "m.vtu"}, {"-o", "m.vtu"});
  expect_wrong_usage({"resample", "s.pvd"}, {"nothing to write"});
  for (const std::string option : {"--interfaces-out", "--cut-mesh", "--ledger", "--picture", "--save"})
    expect_wrong_usage({"resample", "s.pvd", "-o", "m.pvd", option, "x"}, {option, "one data set"});
  for (const std::string option : {"--curves=x", "--film=x", "--plane=x=0", "--show=x", "--frame-rate=3"})
    expect_wrong_usage({"resample", "s_0000.vtr", "-o", "m.vtu", option},
                       {option.substr(0, option.find('=')), "a series"});
  expect_wrong_usage(
      {"resample", "s.pvd", "-o", "m.pvd", "--film", "f.mp4", "--plane", "z=0", "--frame-rate=0"},
      {"--frame-rate: expected a positive number, found '0'"});
  expect_wrong_usage({"resample", "s.pvd", "-o", "m.pvd", "--film", "f.mp4"}, {"--film", "--plane"});
  expect_wrong_usage({"resample", "s.pvd", "-o", "m.pvd", "--film", "f.avi", "--plane", "z=0"},
                     {"--film", "f.avi"});
  expect_wrong_usage({"resample", "s.pvd", "-o", "m.pvd", "--plane", "z=0"}, {"--plane", "--film"});
  expect_wrong_usage({"slice", "s.pvd", "--plane", "z=0", "-o", "one.png"}, {"-o", "one.png"});
  expect_wrong_usage({"slice", "s.pvd", "--plane", "z=0", "-o", "x_%d.jpg"}, {"-o", "x_%d.jpg"});
  expect_wrong_usage({"slice", "s.pvd", "--plane", "z=0", "-o", "x_%d.png", "--frame-rate", "3"},
                     {"--frame-rate"});
  expect_wrong_usage({"slice", "s_0000.vtr", "--plane", "z=0", "-o", "x.png", "--frame-rate", "3"},
                     {"--frame-rate"});
  expect_wrong_usage({"slice", "s.pvd", "--gradients", "--plane", "z=0", "-o", "x_%d.png"}, {"--gradients"});
  expect_wrong_usage({"experiment", "s_0000.vtr", "--plane", "z=0", "--film", "f.mp4", "-o", "out"},
                     {"--film"});
  expect_wrong_usage({"experiment", "s.pvd", "--plane", "z=0", "--film", "a/f.mp4", "-o", "out"},
                     {"--film", "a/f.mp4"});
}

TEST_F(Series, Experiments) {
  make_series("3");
  write("e.toml", R"(input = "s.pvd"
interface-error = "8%"
show = "smooth"
plane = ["z=0.15"]
curve = ["16%"]
)");
  const bool is_filmed = !find_program("ffmpeg").empty();
  run_noted(with({"experiment", "-q", "-c", "e.toml", "-o", "out", "--json", "j.json"},
                 is_filmed ? std::vector<std::string>{"--film", "f.webm"} : std::vector<std::string>{}));
  run_noted({"resample", "-q", "s.pvd", "--interface-error", "8%", "-o", "m.pvd", "--curves", "c.csv"});
  EXPECT_TRUE(read("out/series.csv") == read("c.csv"));
  for (const std::string number : {"0", "1", "2"})
    EXPECT_TRUE(read("out/mesh_000" + number + ".vtu") == read("m_000" + number + ".vtu")) << number;
  // The other parts of the report are about the last step.
  EXPECT_TRUE(read("out/mesh.vtu") == read("m_0002.vtu"));
  EXPECT_EQ(read_json("j.json")["steps"].size(), 3u);
  EXPECT_EQ(read_json("j.json")["mesh"]["tetrahedra"], read_json("j.json")["steps"][2]["tetrahedra"]);
  for (const char* curve : {"tetrahedra", "interface-error", "field-error", "volumes"}) {
    for (const char* ending : {".png", ".svg"})
      EXPECT_GT(read(std::string("out/series-") + curve + ending).size(), 1000u) << curve;
  }
  const std::string report = read("out/report.html");
  for (const char* text : {"Over time", "s.pvd, 3 steps", "Volumes of the materials over time"})
    EXPECT_NE(report.find(text), std::string::npos) << text;
  if (!is_filmed) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  EXPECT_GT(read("out/f.webm").size(), 1000u);
  EXPECT_NE(report.find("data:video/webm;base64,"), std::string::npos);
}

}  // namespace

}  // namespace adamas::test
