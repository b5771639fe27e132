#include <sys/stat.h>

#include <cstdlib>

#include "program.h"

namespace adamas::test {
namespace {

class Compare : public ProgramTest {
 protected:
  Compare() { make_scene("sphere", 8); }
  ~Compare() override { unsetenv("ADAMAS_REFERENCE_PROGRAM"); }

  /// Puts a shell script in the place of the program that runs other generators. The triangulation of the
  /// box's sides is left to that program.
  void replace_mesher(const std::string& body) const {
    write("mesher",
          "#!/bin/sh\n"
          "case \"$(head -c 8 /dev/stdin)\" in\n"
          "adampla*) exec " ADAMAS_REFERENCE_PROGRAM
          " < /dev/stdin;;\n"
          "esac\n" +
              body + "\n");
    chmod((folder() / "mesher").c_str(), 0755);
    setenv("ADAMAS_REFERENCE_PROGRAM", (folder() / "mesher").c_str(), 1);
  }
  /// Returns the rows of other generators, and expects that the project's own row is in order.
  [[nodiscard]] std::vector<nlohmann::json> references(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"compare", "scene.vtr", "--interface-error", "6%", "--json", "f.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(arguments);
    std::vector<nlohmann::json> rows;
    const nlohmann::json figures = read_json("f.json");
    for (const auto& row : figures["meshes"]) {
      if (std::string(row["name"]).rfind("adamas", 0) != 0) {
        rows.push_back(row);
      } else {
        EXPECT_GT(row["tetrahedra"], 0);
        EXPECT_TRUE(row["failure"].is_null());
      }
    }
    return rows;
  }
};

TEST_F(Compare, WritesTableFiguresAndPicture) {
  const RunResult result = run_well({"compare", "scene.vtr", "--interface-error", "6%", "--interface-error",
                                     "4%", "-o", "c.svg", "--csv", "c.csv", "--json", "c.json"});
  EXPECT_NE(result.out.find("Mesh_3"), std::string::npos);
  const auto figures = read_json("c.json");
  EXPECT_TRUE(figures["finished"].get<bool>());
  const auto rows = figures["meshes"];
  ASSERT_EQ(rows.size(), 15u);
  double own = 0;
  for (const auto& row : rows) {
    ASSERT_TRUE(row["failure"].is_null()) << row.dump();
    EXPECT_GT(row["tetrahedra"], 0);
    EXPECT_GT(row["vertices"], 0);
    EXPECT_GT(row["seconds"], 0);
    EXPECT_LT(row["dihedral_min"], row["dihedral_max"]);
    EXPECT_GE(row["condition_number"], 1);
    EXPECT_LT(row["field_mean_error"], row["field_max_error"]);
    EXPECT_EQ(row["materials"].size(), 2u);
    double volume = 0;
    for (const auto& m : row["materials"]) volume += double(m["volume_mesh"]);
    const double distance = std::max(double(row["hausdorff_to_input"]), double(row["hausdorff_from_input"]));
    const std::string name = row["name"];
    // Mesh_3 approximates the box too, and not only the interfaces.
    EXPECT_NEAR(volume, 1, name.rfind("Mesh_3", 0) == 0 ? 6 * distance : 1e-6) << name;
    if (name == "adamas") own = distance;
    EXPECT_EQ(row["matched"].get<bool>(), std::abs(distance / own - 1) <= 0.05) << name;
    if (name == "TetGen (input's)") continue;
    if (row["matched"]) {
      EXPECT_LE(distance, 1.1 * double(row["interface_error_target"])) << name;
    }
    if (name == "TetGen (our interfaces)") {
      EXPECT_NEAR(distance, own, 0.02 * own);
    }
    if (name == "TetGen (simplified)") {
      EXPECT_LE(distance, 1.02 * double(row["interface_error_target"]));
      EXPECT_NE(std::string(row["note"]).find("triangles of the input's within"), std::string::npos);
    }
    if (name == "Mesh_3" && row["matched"]) {
      EXPECT_NEAR(distance, own, 0.05 * own);
    }
  }
  EXPECT_NE(read("c.svg").find("</svg>"), std::string::npos);
  const std::string csv = read("c.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 16);
}

TEST_F(Compare, SaysWhatItIsGoingToDo) {
  replace_mesher("exit 3");
  const std::string out = run_well({"compare", "scene.vtr", "--interface-error", "6%", "--interface-error",
                                    "5%", "--time-limit", "20"})
                              .out;
  EXPECT_EQ(out.rfind("Comparing at 2 interface errors", 0), 0u) << out;
  // There is one mesh of TetGen with the input's interfaces; for each error there are one with ours and one
  // with the input's after simplification, and three of Mesh_3.
  EXPECT_NE(out.find("11 meshes of other generators, at most 20 s each and 220 s in all"), std::string::npos);
}

TEST_F(Compare, GivesMesh3TheLabelsOfAnInput) {
  // The labels are a ball of ones in a cube of zeros.
  write_image("labels.nrrd", 12, [](std::size_t i) {
    const double x = static_cast<double>(i % 12) - 5.5, y = static_cast<double>(i / 12 % 12) - 5.5,
                 z = static_cast<double>(i / 144) - 5.5;
    return x * x + y * y + z * z < 16 ? 1.0f : 0.0f;
  });
  run_well({"compare", "labels.nrrd", "--labels", "labels", "--cells", "--interface-error", "10%",
            "--reference", "mesh3", "--json", "f.json"});
  std::size_t found = 0;
  const nlohmann::json figures = read_json("f.json");
  for (const auto& row : figures["meshes"]) {
    if (row["name"] != "Mesh_3 (labels)") continue;
    ++found;
    ASSERT_TRUE(row["failure"].is_null()) << row.dump();
    EXPECT_GT(row["tetrahedra"], 0);
    const double most = row["interface_error_target"];
    EXPECT_LE(row["hausdorff_to_input"], 2 * most);
    // The volume is the whole cube except what is cut off at its edges.
    double volume = 0;
    for (const auto& m : row["materials"]) volume += double(m["volume_mesh"]);
    EXPECT_NEAR(volume, 12 * 12 * 12, 0.1 * 12 * 12 * 12);
  }
  EXPECT_EQ(found, 1u);
}

TEST_F(Compare, FinishedRowsAreKeptWhenItIsCancelled) {
  // The first mesh of another generator never comes.
  replace_mesher("sleep 100");
  RunOptions options;
  options.interrupt_at = "meshing by TetGen";
  const RunResult result = run({"compare", "scene.vtr", "--interface-error", "6%", "--csv", "c.csv", "--json",
                                "c.json", "-o", "c.png", "--verbose"},
                               options);
  EXPECT_EQ(result.status, 130);
  EXPECT_NE(result.out.find("\n  adamas cut"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("stopped after 2 rows; they are in c.csv and c.json"), std::string::npos)
      << result.err;
  const auto figures = read_json("c.json");
  EXPECT_FALSE(figures["finished"].get<bool>());
  ASSERT_EQ(figures["meshes"].size(), 2u);
  EXPECT_EQ(figures["meshes"][1]["name"], "adamas cut");
  const std::string csv = read("c.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_EQ(files(), (std::set<std::string>{"c.csv", "c.json", "mesher", "scene.vtr"}));
}

TEST_F(Compare, OneLimitIsForAllTrialsOfAMesh) {
  // Each call takes almost half of the limit and fails, so that a greater size is tried.
  replace_mesher("sleep 0.5; exit 3");
  const auto rows = references({"--time-limit", "1.2", "--reference", "mesh3"});
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_LE(row["trials"].get<int>(), 3);
    ASSERT_TRUE(row["note"].is_string()) << row.dump();
    EXPECT_NE(std::string(row["note"]).find("the time limit of 1.2 s ended the search"), std::string::npos);
  }
}

TEST_F(Compare, ChoosesReferences) {
  const auto rows = references({"--reference", "mesh3"});
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) EXPECT_EQ(std::string(row["name"]).rfind("Mesh_3", 0), 0u);
}

TEST_F(Compare, FailuresAreRowsWithReasons) {
  const auto before = files();
  const std::vector<std::pair<std::string, std::string>> cases{
      {"echo oh >&2; kill -SEGV $$", "signal 11"},
      {"echo nonsense", "no answer that can be read"},
      {"exit 3", "ended with status 3"},
      {"sleep 100", "took longer than 0.2 s"}};
  for (const auto& [script, reason] : cases) {
    replace_mesher(script);
    const auto rows = references({"--time-limit", "0.2"});
    ASSERT_GE(rows.size(), 3u);
    for (const auto& row : rows) {
      EXPECT_NE(std::string(row["failure"]).find(reason), std::string::npos) << row["failure"];
      EXPECT_TRUE(row["tetrahedra"].is_null());
      EXPECT_FALSE(row["matched"].get<bool>());
    }
  }
  auto after = files();
  after.erase("mesher"), after.erase("f.json");
  EXPECT_EQ(after, before);
}

TEST_F(Compare, ProgramThatCannotTriangulateIsTold) {
  write("mesher", "#!/bin/sh\nexit 7\n");
  chmod((folder() / "mesher").c_str(), 0755);
  setenv("ADAMAS_REFERENCE_PROGRAM", (folder() / "mesher").c_str(), 1);
  for (const auto& row : references()) EXPECT_EQ(row["failure"].get<std::string>(), "ended with status 7");
}

TEST_F(Compare, HandsTheLimitsOn) {
  replace_mesher("[ \"$(ulimit -v) $(ulimit -t)\" = '131072 8' ] && exit 9");
  for (const auto& row : references({"--memory-limit", "134217728", "--time-limit", "7"}))
    EXPECT_EQ(row["failure"].get<std::string>(), "ended with status 9");
}

TEST_F(Compare, MissingProgramIsToldBeforeTheWork) {
  setenv("ADAMAS_REFERENCE_PROGRAM", "/nowhere/adamas-reference", 1);
  expect_failure({"compare", "scene.vtr"}, {"ADAMAS_REFERENCE_PROGRAM", "/nowhere/adamas-reference"});
  setenv("ADAMAS_REFERENCE_PROGRAM", folder().c_str(), 1);
  expect_failure({"compare", "scene.vtr"}, {"expected a program"});
}

TEST_F(Compare, OptionsAreChecked) {
  expect_wrong_usage({"compare", "scene.vtr", "--reference", "gmsh"}, {"--reference", "'gmsh'"});
  expect_wrong_usage({"compare", "scene.vtr", "--reference", "tetgen,tetgen"}, {"--reference"});
  expect_wrong_usage({"compare", "scene.vtr", "--reference", "mesh3,"}, {"--reference"});
  expect_wrong_usage({"compare", "scene.vtr", "--time-limit", "0"}, {"--time-limit", "positive"});
  expect_wrong_usage({"compare", "scene.vtr", "--time-limit", "soon"}, {"--time-limit", "'soon'"});
  expect_wrong_usage({"compare", "scene.vtr", "--memory-limit", "1000"}, {"--memory-limit", "67108864"});
  expect_wrong_usage({"compare", "scene.vtr", "--memory-limit", "-1"}, {"--memory-limit"});
  expect_wrong_usage({"compare", "scene.vtr", "--interface-error", "0"}, {"--interface-error"});
  expect_wrong_usage({"compare", "scene.vtr", "--interface-error", "1%", "--interface-error", "200%"},
                     {"--interface-error", "diagonal"});
  expect_wrong_usage({"compare", "scene.vtr", "--tetgen-switches", "pq"}, {"--tetgen-switches", "'pq'"});
  expect_wrong_usage({"compare", "scene.vtr", "--csv", "table.txt"}, {"--csv", ".csv"});
  expect_wrong_usage({"compare", "scene.vtr", "-o", "picture.gif"}, {"-o", ".png"});
  expect_wrong_usage({"compare"}, {"INPUT"});
  expect_failure({"compare", "none.vtr"}, {"none.vtr"});
}

}  // namespace
}  // namespace adamas::test
