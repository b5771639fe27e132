// Tests hierarchies that are saved, and meshes that are selected from them.

#include <cmath>
#include <sstream>

#include "program.h"

namespace adamas::test {

namespace {

class Select : public ProgramTest {
 protected:
  Select() {
    make_scene("tjunction", 8);
    run_well({"resample", "scene.vtr", "--interface-error", "2%", "--field-error", "smooth=5%", "--save",
              "h.h5", "-o", "full.vtu", "--json", "full.json"});
  }
};

TEST_F(Select, WholeAndCoarserMeshes) {
  const std::size_t full = read_json("full.json").at("tetrahedra");
  // The input is no longer needed.
  std::filesystem::remove(folder() / "scene.vtr");
  run_well({"select", "h.h5", "-o", "all.vtu", "--json", "all.json"});
  const auto all = read_json("all.json");
  EXPECT_EQ(all.at("tetrahedra"), full);
  EXPECT_EQ(all.at("whole_hierarchy"), true);
  run_well({"select", "h.h5", "--interface-error", "8%", "-o", "m.vtu", "--interfaces-out", "i.vtp",
            "--cut-mesh", "c.vtu", "--ledger", "l.csv", "--picture", "p.png", "--json", "m.json"});
  const auto coarse = read_json("m.json");
  EXPECT_LT(coarse.at("tetrahedra"), full);
  for (const char* error : {"interface_error", "interface_error_per_material", "junction_error"})
    EXPECT_LE(coarse.at(error), coarse.at("interface_error_target")) << error;
  EXPECT_TRUE(coarse.at("interface_error_estimate").is_null());
  double input = 0, mesh = 0;
  for (const auto& material : coarse.at("materials"))
    input += material.at("volume_input").get<double>(), mesh += material.at("volume_mesh").get<double>();
  EXPECT_NEAR(input, 1, 1e-9);
  EXPECT_NEAR(mesh, 1, 1e-9);
  run_well({"info", "m.vtu", "--json", "info.json"});
  EXPECT_EQ(read("p.png").substr(1, 3), "PNG");
  for (const char* text : {"input,", "mesh,", "cut mesh,"})
    EXPECT_NE(read("l.csv").find(text), std::string::npos) << text;
  // Meshes are selected by the error of a field, and by a number of tetrahedra.
  run_well({"select", "h.h5", "--field-error", "smooth=20%", "--json", "f.json"});
  const auto smooth = read_json("f.json").at("fields").at("smooth");
  EXPECT_LE(smooth.at("reducible_max_error"), smooth.at("target"));
  const std::string most = std::to_string(full / 2);
  run_well({"select", "h.h5", "--max-tetrahedra", most, "--json", "n.json"});
  EXPECT_LE(read_json("n.json").at("tetrahedra"), full / 2);
  EXPECT_GE(read_json("n.json").at("tetrahedra"), 0.95 * static_cast<double>(full / 2) - 8);
}

TEST_F(Select, OtherCommandsTakeTheWholeMesh) {
  const std::vector<std::string> outputs{"h.h5", "full.vtu"};
  std::array<std::string, 2> slices, probes;
  for (std::size_t i = 0; i < 2; ++i) {
    run_well({"slice", outputs[i], "--plane", "z=0.4", "-o", "s.vtp", "--json", "s.json"});
    slices[i] = read_json("s.json").at("materials").dump();
    probes[i] = run_well({"probe", outputs[i], "--point", "0.3,0.4,0.6"}).out;
    run_well({"info", outputs[i], "--json", "i.json"});
    EXPECT_EQ(read_json("i.json").at("materials").size(), 3u);
  }
  EXPECT_EQ(slices[0], slices[1]);
  EXPECT_EQ(probes[0], probes[1]);
}

/// The example in the documentation, which knows only the format, finds the same mesh. It needs Debian's own
/// Python.
TEST_F(Select, AnotherProgramReadsTheFile) {
  const double error = 0.12;
  run_well({"select", "h.h5", "--interface-error", std::to_string(error), "--json", "m.json"});
  const std::string script = std::string(ADAMAS_SOURCE_DIR) + "/docs/examples/read_hierarchy.py";
  const std::string command = "/usr/bin/python3 '" + script + "' '" + (folder() / "h.h5").string() + "' " +
                              std::to_string(error) + " > '" + (folder() / "out.txt").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::istringstream lines(read("out.txt"));
  std::string word;
  std::size_t tetrahedra = 0;
  double volume = 0;
  lines >> word >> tetrahedra >> word >> volume;
  EXPECT_EQ(tetrahedra, read_json("m.json").at("tetrahedra"));
  EXPECT_NEAR(volume, 1, 1e-9);
}

TEST_F(Select, WrongFilesAndOptions) {
  const std::string bytes = read("h.h5");
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1}) {
    write("t.h5", bytes.substr(0, size));
    expect_failure({"select", "t.h5", "-o", "x.vtu"}, {"t.h5: expected"});
  }
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 4);
  write("t.h5", flipped);
  for (const std::vector<std::string>& command : {std::vector<std::string>{"select", "t.h5", "-o", "x.vtu"},
                                                  {"info", "t.h5"},
                                                  {"slice", "t.h5", "--plane", "z=0.5", "-o", "x.png"},
                                                  {"probe", "t.h5", "--point", "0,0,0"}})
    expect_failure(command, {"t.h5", "damaged"});
  expect_failure({"select", "full.vtu", "-o", "x.vtu"}, {"full.vtu", "adamas hierarchy"});
  expect_failure({"select", "none.h5", "-o", "x.vtu"}, {"none.h5", "expected a file"});
  expect_failure({"select", "h.h5", "--field-error", "heat=1", "-o", "x.vtu"},
                 {"h.h5", "'smooth'", "'heat'"});
  expect_failure({"select", "h.h5", "--max-tetrahedra", "3", "-o", "x.vtu"}, {"h.h5", "at least", "3"});
  expect_wrong_usage({"select", "h.h5"}, {"nothing to write"});
  expect_wrong_usage({"select", "h.h5", "--interface-error", "0", "-o", "x.vtu"}, {"--interface-error"});
  expect_wrong_usage({"select", "h.h5", "--interface-error", "9", "-o", "x.vtu"}, {"diagonal"});
  expect_wrong_usage({"select", "h.h5", "-o", "x.txt"}, {"-o", ".vtu"});
  expect_wrong_usage({"resample", "scene.vtr", "--save", "x.vtu"}, {"--save", ".h5"});
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure({"resample", "scene.vtr", "--interface-error", "20%", "--save", "x.h5"}, {"x.h5"}, full);
}

/// The file has version 1 of the format, and was made when that was current by generate scene tjunction
/// --dimensions 4 and resample --interface-error 4% --save.
TEST_F(Select, FilesOfVersionOneAreRead) {
  const std::string golden = std::string(ADAMAS_SOURCE_DIR) + "/tests/cli/golden/hierarchy-1.h5";
  run_well({"select", golden, "--json", "all.json"});
  EXPECT_EQ(read_json("all.json").at("tetrahedra"), 62);
  run_well({"select", golden, "--interface-error", "6%", "-o", "m.vtu", "--json", "m.json"});
  const auto figures = read_json("m.json");
  EXPECT_EQ(figures.at("tetrahedra"), 6);
  EXPECT_LE(figures.at("interface_error_estimate"), figures.at("interface_error_target"));
  EXPECT_TRUE(figures.at("interface_error").is_null());
}

/// The file was made in the same way with version 2 of the format, which has certified errors.
TEST_F(Select, FilesOfVersionTwoAreRead) {
  const std::string golden = std::string(ADAMAS_SOURCE_DIR) + "/tests/cli/golden/hierarchy-2.h5";
  run_well({"select", golden, "--json", "all.json"});
  EXPECT_EQ(read_json("all.json").at("tetrahedra"), 32);
  run_well({"select", golden, "--interface-error", "6%", "-o", "m.vtu", "--json", "m.json"});
  const auto figures = read_json("m.json");
  EXPECT_EQ(figures.at("tetrahedra"), 6);
  EXPECT_NEAR(figures.at("interface_error_per_material").get<double>(), 0.08817, 1e-5);
  EXPECT_LE(figures.at("junction_error"), figures.at("interface_error_target"));
}

TEST_F(Select, ErrorsThatAreNotReachedAreTold) {
  const std::vector<std::pair<std::vector<std::string>, std::vector<const char*>>> cases{
      {{"--interface-error", "0.01%"},
       {"the interface error wanted was not reached", "wanted for the boundary of '"}},
      {{"--field-error", "smooth=1e-9"}, {"the error wanted of the field 'smooth' was not reached"}}};
  for (const auto& [options, texts] : cases) {
    std::vector<std::string> command{"select", "h.h5", "--quiet", "--json", "m.json"};
    command.insert(command.end(), options.begin(), options.end());
    const RunResult result = run(command);
    EXPECT_EQ(result.status, 3);
    for (const char* text : texts) EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
    for (const std::string& line : result.err_lines())
      EXPECT_NE(line.find("the hierarchy that was saved goes no further"), std::string::npos) << line;
  }
}

TEST_F(Select, TheSameBytesOnAnyNumberOfThreads) {
  run_well({"resample", "scene.vtr", "--interface-error", "2%", "--field-error", "smooth=5%", "--save",
            "other.h5", "--threads", "1"});
  EXPECT_TRUE(read("other.h5") == read("h.h5"));
}

}  // namespace

}  // namespace adamas::test
