// Tests experiments: the contents of the folder, the report, and what is refused.

#include <cmath>
#include <fstream>

#include "program.h"
#include "vtk_ledger.h"

namespace adamas::test {

namespace {

class Experiment : public ProgramTest {
 protected:
  [[nodiscard]] std::set<std::string> folder_files(const std::string& name) const {
    std::set<std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / name))
      result.insert(entry.path().filename().string());
    EXPECT_EQ(result.erase(".adamas-files"), 1u);
    return result;
  }
  void expect_all_files() const;
  void expect_figures_of_the_meshes() const;
  void expect_ledger_of_the_files() const;
};

constexpr const char* kConfig = R"(# A small experiment.
title = "Three materials"
generate = "tjunction"
dimensions = "8,9,10"
interface-error = "4%"
field-error = ["smooth=1%"]
ghost = "least-squares"
show = "smooth"
plane = [
  "z=0.5",  # the first
  "x=0.25",
]
detail = "0.2,0.6,0.2,0.7"
curve = ["30%", "10%"]
density = "linear"
published-by = "somebody, 2001"
published = ["tetrahedra=100", "triangles left | upper=1"]
)";

void Experiment::expect_all_files() const {
  const std::set<std::string> expected{"input.vtr",
                                       "input-interfaces.vtp",
                                       "input-interfaces.png",
                                       "mesh-interfaces.vtp",
                                       "mesh-interfaces.html",
                                       "mesh-interfaces.png",
                                       "interface-mesh.vtu",
                                       "mesh.vtu",
                                       "cut-mesh.vtu",
                                       "cut-mesh-faces.vtp",
                                       "slice-1.png",
                                       "slice-1-detail.png",
                                       "slice-1-fields.png",
                                       "slice-1-fields-detail.png",
                                       "slice-2.png",
                                       "slice-2-fields.png",
                                       "interface-error.png",
                                       "field-error.png",
                                       "metrics.json",
                                       "report.html"};
  EXPECT_EQ(folder_files("out"), expected);
  EXPECT_EQ(read("out/metrics.json"), read("j.json"));
  const std::string report = read("out/report.html");
  for (const char* text : {"Three materials", "somebody, 2001", "Ledger", "Error against tetrahedra"})
    EXPECT_NE(report.find(text), std::string::npos) << text;
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = report.find("data:image/png", at)) != std::string::npos; ++at) ++pictures;
  EXPECT_EQ(pictures, 10u);
  // The report fetches nothing, and scripts name addresses only in their comments. (In a page within the page
  // quotes are written as entities.)
  for (const std::string quote : {"\"", "&quot;"}) {
    for (const char* attribute : {"src=", "href="})
      EXPECT_EQ(report.find(attribute + quote + "http"), std::string::npos) << attribute;
  }
  for (const char* fetched : {"url(http", "@import", "importScripts"})
    EXPECT_EQ(report.find(fetched), std::string::npos) << fetched;
  EXPECT_NE(report.find("<iframe"), std::string::npos);
}

void Experiment::expect_figures_of_the_meshes() const {
  const auto figures = read_json("out/metrics.json");
  ASSERT_EQ(figures.at("curve").size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& run = figures.at("curve")[i];
    EXPECT_LE(run.at("interface_error"), run.at("interface_error_target"));
    if (i > 0) {
      EXPECT_GT(run.at("tetrahedra"), figures.at("curve")[i - 1].at("tetrahedra"));
    }
  }
  EXPECT_EQ(figures.at("curve")[2].at("tetrahedra"), figures.at("interface_mesh").at("tetrahedra"));
  EXPECT_GT(figures.at("mesh").at("tetrahedra"), figures.at("interface_mesh").at("tetrahedra"));
  EXPECT_LE(figures.at("mesh").at("fields").at("smooth").at("reducible_max_error"),
            figures.at("mesh").at("fields").at("smooth").at("target"));
  EXPECT_EQ(figures.at("published")[0].at("here"), figures.at("interface_mesh").at("tetrahedra"));
  // The command by itself makes the same mesh.
  run_program(folder() / "out", {"resample", "input.vtr", "--interface-error", "4%", "--field-error",
                                 "smooth=1%", "--ghost", "least-squares", "-o", "again.vtu"});
  EXPECT_TRUE(read("out/again.vtu") == read("out/mesh.vtu"));
}

void Experiment::expect_ledger_of_the_files() const {
  const auto input = grid_ledger(folder() / "out/input.vtr", "linear");
  const auto mesh = cut_mesh_ledger(folder() / "out/cut-mesh.vtu", "linear");
  const auto figures = read_json("out/metrics.json");
  ASSERT_EQ(figures.at("ledger").size(), input.size());
  for (const auto& row : figures.at("ledger")) {
    const std::string name = row.at("material");
    SCOPED_TRACE(name);
    const LedgerEntry &before = input.at(name), &after = mesh.at(name);
    EXPECT_NEAR(row.at("volume_input").get<double>(), before.volume, 1e-9);
    EXPECT_NEAR(row.at("volume_mesh").get<double>(), after.volume, 1e-9);
    EXPECT_NEAR(row.at("mass_input").get<double>(), before.mass, 1e-7 * before.mass);
    // Snapping moves a little of each material.
    EXPECT_NEAR(row.at("mass_mesh").get<double>(), after.mass, 1e-3 * after.mass);
  }
}

TEST_F(Experiment, WritesAllThatItPromises) {
  write("e.toml", kConfig);
  const RunResult result = run({"experiment", "-c", "e.toml", "-o", "out", "--json", "j.json"});
  // Where cells hold several materials the field cannot be approximated that closely.
  ASSERT_EQ(result.status, 3) << result.err;
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_EQ(result.err.rfind("adamas: note: with fields: the error wanted of the field 'smooth'", 0), 0u);
  expect_all_files();
  expect_figures_of_the_meshes();
  expect_ledger_of_the_files();
}

TEST_F(Experiment, IsTheSameOnAnyNumberOfThreads) {
  write("e.toml", kConfig);
  for (const auto& [name, threads] : {std::pair{"one", "1"}, {"three", "3"}}) {
    ASSERT_EQ(run({"experiment", "-c", "e.toml", "--dimensions", "5,5,6", "--interface-error", "8%",
                   "--field-error", "smooth=5%", "-o", name, "--threads", threads})
                  .status,
              0);
  }
  ASSERT_EQ(folder_files("one"), folder_files("three"));
  for (const std::string& name : folder_files("one")) {
    // These files state seconds.
    if (name == "metrics.json" || name == "report.html") continue;
    EXPECT_TRUE(read("one/" + name) == read("three/" + name)) << name;
  }
}

TEST_F(Experiment, TakesDataOfOthers) {
  make_scene("sphere", 8);
  ASSERT_EQ(run({"experiment", "scene.vtr", "--interface-error", "4%", "-o", "out/"}).status, 0);
  const auto files = folder_files("out");
  EXPECT_TRUE(files.contains("report.html"));
  EXPECT_FALSE(files.contains("input.vtr"));
  EXPECT_FALSE(files.contains("interface-mesh.vtu"));
  EXPECT_FALSE(files.contains("slice-1.png"));
}

/// The terminal, the report and the figures say which error was not reached and why, also with --quiet.
TEST_F(Experiment, ErrorsThatAreNotReachedAreTold) {
  make_scene("tjunction", 8);
  const RunResult result = run({"experiment", "scene.vtr", "--interface-error", "3%", "--field-error",
                                "smooth=1e-9", "--max-tetrahedra", "150", "--quiet", "-o", "out"});
  EXPECT_EQ(result.status, 3);
  const auto figures = read_json("out/metrics.json").at("mesh");
  const std::string report = read("out/report.html");
  EXPECT_NE(report.find("Errors that were not reached"), std::string::npos);
  const std::string reason = figures.at("fields").at("smooth").at("shortfall").at("reason");
  for (const std::string& text : {std::string("error wanted of the field"), reason}) {
    EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
    EXPECT_NE(report.find(text), std::string::npos) << text;
  }
  for (const auto& [key, text] : {std::pair("interface_error", "the interface error wanted was not reached"),
                                  {"interface_error_per_material", "wanted for the boundary of "},
                                  {"junction_error", "wanted for the lines where three materials meet"}}) {
    EXPECT_EQ(figures.at(key + std::string("_reached")), result.err.find(text) == std::string::npos) << text;
    EXPECT_EQ(figures.at(key + std::string("_reached")), report.find(text) == std::string::npos) << text;
  }
}

TEST_F(Experiment, SlicesMaterialsWithoutAField) {
  make_scene("tjunction", 6);
  const RunResult result = run({"experiment", "scene.vtr", "--interface-error", "10%", "--plane", "x=0.5",
                                "--show-interface", "b", "--direction", "1,0,-0.2", "-o", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(folder_files("out").contains("slice-1.png"));
  EXPECT_NE(read("out/report.html").find("x=0.5: the input; the mesh that holds"), std::string::npos);
  // These data have no field.
  std::string labels;
  for (int i = 0; i < 512; ++i) labels += static_cast<char>(i % 8 < 4 ? 0 : 1);
  write("labels.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + labels);
  const RunResult bare = run({"experiment", "labels.nrrd", "--labels", "labels.nrrd", "--plane", "z=3", "-o",
                              "bare", "--interface-error", "10%"});
  ASSERT_EQ(bare.status, 0) << bare.err;
  EXPECT_TRUE(folder_files("bare").contains("slice-1.png"));
}

TEST_F(Experiment, FoldersThatExist) {
  const std::vector<std::string> small{"experiment", "--generate",        "sphere", "--dimensions",
                                       "6",          "--interface-error", "10%"};
  const auto with = [&small](std::vector<std::string> more) {
    more.insert(more.begin(), small.begin(), small.end());
    return more;
  };
  std::filesystem::create_directory(folder() / "empty");
  ASSERT_EQ(run(with({"-o", "empty"})).status, 0);
  expect_failure(with({"-o", "empty"}), {"empty", "expected a new or an empty folder", "--overwrite"});
  ASSERT_EQ(run(with({"-o", "empty", "--overwrite"})).status, 0);
  std::filesystem::create_directory(folder() / "mine");
  write("mine/letter.txt", "dear");
  expect_failure(with({"-o", "mine"}), {"mine", "expected a new or an empty folder"});
  expect_failure(with({"-o", "mine", "--overwrite"}), {"mine", "earlier run", ".adamas-files"});
  EXPECT_EQ(read("mine/letter.txt"), "dear");
  write("file", "x");
  expect_failure(with({"-o", "file"}), {"file", "expected an output folder, found a file"});
  expect_failure(with({"-o", "none/out"}), {"none/out", "expected an existing folder above"});
  expect_failure(with({"-o", "/proc/adamas-test"}), {"/proc/adamas-test", "expected a writable folder"});
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure(with({"-o", "out"}), {"out"}, full);
}

TEST_F(Experiment, ReplacesWhatItWroteAndNothingElse) {
  const std::vector<std::string> again{"experiment", "--generate",        "sphere", "--dimensions", "6", "-o",
                                       "run",        "--interface-error", "10%",    "--overwrite"};
  ASSERT_EQ(run(again).status, 0);
  const std::string metrics = read("run/metrics.json");
  expect_wrong_usage({"experiment", "run/input.vtr", "-o", "run", "--interface-error", "10%", "--overwrite"},
                     {"expected a folder without the input, found run/input.vtr"});
  // An experiment does not overwrite the folder of another command.
  run_well({"generate", "buckyball", "--dimensions", "4", "-o", "b.nrrd", "-q"});
  run_well({"store", "b.nrrd", "-o", "b.adm", "-q"});
  run_well({"restore", "b.adm", "-o", "b.zarr", "-q"});
  auto over = again;
  over[6] = "b.zarr";
  expect_failure(
      over, {"b.zarr: expected the folder of an experiment to replace, found that of an OME-Zarr image"});
  const auto refuses = [&](const std::string& found) {
    expect_failure(again,
                   {"run: expected an earlier run's folder as it was written", "found '" + found + "'"});
  };
  std::filesystem::create_directory(folder() / "run/sub");
  refuses("sub");
  write("run/sub/thesis.txt", "dear");
  refuses("sub/thesis.txt");
  EXPECT_EQ(read("run/sub/thesis.txt"), "dear");
  std::filesystem::remove_all(folder() / "run/sub");
  write("run/metrics.json", metrics + " ");
  refuses("metrics.json");
  write("run/metrics.json", metrics);
  std::filesystem::create_symlink("/dev/null", folder() / "run/link");
  refuses("link");
  std::filesystem::remove(folder() / "run/link");
  std::filesystem::rename(folder() / "run", folder() / "elsewhere");
  std::filesystem::create_symlink("elsewhere", folder() / "run");
  std::filesystem::remove(folder() / "elsewhere/report.html");
  ASSERT_EQ(run(again).status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder() / "run"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "elsewhere/report.html"));
}

TEST_F(Experiment, CanBeStopped) {
  RunOptions stop;
  stop.interrupt_at = "refining";
  const auto before = files();
  for (const int times : {1, 2}) {
    stop.interrupts = times;
    const RunResult result = run({"experiment", "--generate", "voronoi10", "--dimensions", "12", "-o", "out",
                                  "--interface-error", "0.2%", "--verbose"},
                                 stop);
    EXPECT_EQ(result.status, 130);
    EXPECT_EQ(files(), before);
  }
}

TEST_F(Experiment, WrongUsage) {
  make_scene("sphere", 4);
  const auto config = [this](const std::string& line) {
    write("e.toml", line + "\n");
    return std::vector<std::string>{"experiment", "scene.vtr", "-c", "e.toml", "-o", "out"};
  };
  expect_wrong_usage(config("colour = \"red\""), {"expected options of adamas experiment", "'colour'"});
  expect_wrong_usage(config("[slices]\nshow = \"smooth\""),
                     {"expected sections named as commands", "'slices'"});
  expect_wrong_usage(config("plane = [\"x=0.5\","), {"expected ']'"});
  expect_wrong_usage(config("interface-error = \"0\""), {"--interface-error"});
  expect_wrong_usage({"experiment", "-o", "out"}, {"expected an INPUT or --generate, found neither"});
  expect_wrong_usage({"experiment", "scene.vtr", "--generate", "sphere", "-o", "out"}, {"found both"});
  expect_wrong_usage({"experiment", "--generate", "cube", "-o", "out"}, {"--generate", "sphere"});
  expect_wrong_usage({"experiment", "--generate", "sphere", "-o", "out"}, {"--dimensions"});
  expect_wrong_usage({"experiment", "--generate", "impact", "--seed", "3", "-o", "out"}, {"--seed"});
  expect_wrong_usage({"experiment", "scene.vtr", "--seed", "3", "-o", "out"}, {"--seed", "--generate"});
  expect_wrong_usage({"experiment", "scene.vtr", "--show", "smooth", "-o", "out"}, {"--show", "--plane"});
  expect_wrong_usage({"experiment", "scene.vtr", "--show-interface", "a|a", "-o", "out"},
                     {"--show-interface", "two materials"});
  expect_wrong_usage({"experiment", "scene.vtr", "--show", "smooth", "--plane", "w=1", "-o", "out"},
                     {"--plane: expected x=NUMBER"});
  expect_wrong_usage({"experiment", "scene.vtr", "--detail", "0,1,0,1", "-o", "out"},
                     {"--detail", "--plane"});
  expect_wrong_usage(
      {"experiment", "scene.vtr", "--show", "smooth", "--plane", "x=0.5", "--detail", "1,0,0,1", "-o", "out"},
      {"--detail: expected a0 < a1"});
  expect_wrong_usage({"experiment", "scene.vtr", "--curve", "nan", "-o", "out"}, {"--curve"});
  expect_wrong_usage({"experiment", "scene.vtr", "--curve", "500", "-o", "out"}, {"--curve", "diagonal"});
  expect_wrong_usage({"experiment", "scene.vtr", "--published", "tetrahedra=4", "-o", "out"},
                     {"--published and --published-by"});
  expect_wrong_usage(
      {"experiment", "scene.vtr", "--published", "speed=4", "--published-by", "me", "-o", "out"},
      {"--published: expected one of", "'speed'"});
  expect_wrong_usage(
      {"experiment", "scene.vtr", "--published", "tetrahedra=-4", "--published-by", "me", "-o", "out"},
      {"--published tetrahedra"});
}

TEST_F(Experiment, OptionsThatDoNotFitTheInput) {
  make_scene("sphere", 4);
  expect_failure({"experiment", "scene.vtr", "--show", "heat", "--plane", "x=0.5", "-o", "out"},
                 {"scene.vtr", "heat"});
  expect_failure({"experiment", "scene.vtr", "--show", "smooth", "--plane", "x=7", "-o", "out"},
                 {"scene.vtr", "--plane", "x=7"});
  expect_failure({"experiment", "scene.vtr", "--density", "weight", "-o", "out"},
                 {"scene.vtr", "--density", "weight"});
  expect_failure({"experiment", "none.vtr", "-o", "out"}, {"none.vtr"});
}

}  // namespace

}  // namespace adamas::test
