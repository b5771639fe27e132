// Tests the results of commands on data whose truth is known.

#include <cmath>
#include <numbers>
#include <sstream>

#include "program.h"

namespace adamas::test {

namespace {

constexpr double kSphere = 4.0 / 3 * std::numbers::pi * 0.35 * 0.35 * 0.35;

const nlohmann::json& find(const nlohmann::json& list, const std::string& name) {
  for (const auto& item : list) {
    if (item.at("name") == name) return item;
  }
  ADD_FAILURE() << "no " << name;
  static const nlohmann::json kNone;
  return kNone;
}

double volume(const nlohmann::json& figures, const std::string& material, const std::string& key = "volume") {
  return find(figures.at("materials"), material).at(key).get<double>();
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

class Commands : public ProgramTest {
 protected:
  static nlohmann::json without_cost(nlohmann::json figures) {
    figures.erase("seconds");
    figures.erase("processor_seconds");
    figures.erase("peak_memory_bytes");
    return figures;
  }
};

TEST_F(Commands, Generate) {
  run_well({"generate", "scene", "sphere", "--dimensions", "9,10,11", "-o", "s.vtr", "--json", "j.json"});
  const auto figures = read_json("j.json");
  EXPECT_EQ(figures.at("dimensions"), nlohmann::json({9, 10, 11}));
  EXPECT_EQ(figures.at("bytes"), std::filesystem::file_size(folder() / "s.vtr"));
  EXPECT_NEAR(volume(figures, "inside"), kSphere, 1e-12);
  EXPECT_NEAR(volume(figures, "outside"), 1 - kSphere, 1e-12);
  const double stated = find(figures.at("materials"), "inside").at("integration_error").get<double>();
  EXPECT_NEAR(volume(figures, "inside", "volume_sampled"), kSphere, stated);
  run_well({"info", "s.vtr", "--json", "i.json"});
  EXPECT_NEAR(volume(read_json("i.json"), "inside"), kSphere, stated + 1e-6);
}

TEST_F(Commands, GenerateDependsOnTheSeedAlone) {
  const auto make = [this](const std::string& seed, const std::string& name, const std::string& threads) {
    run_well({"generate", "scene", "voronoi10", "--seed", seed, "--dimensions", "6,6,6", "--threads", threads,
              "-o", name});
    return read(name);
  };
  const std::string first = make("3", "a.vtr", "1");
  EXPECT_TRUE(first == make("3", "b.vtr", "2"));
  EXPECT_FALSE(first == make("4", "c.vtr", "2"));
}

TEST_F(Commands, InfoOfEveryKind) {
  run_well(
      {"generate", "scene", "tjunction", "--dimensions", "4,5,6", "-o", "s.vtr", "--interfaces", "s.vtp"});
  run_well({"generate", "scene", "tjunction", "--interfaces", "s.arec"});
  run_well({"generate", "scene", "sphere", "--interfaces", "s.stl"});
  run_well({"info", "s.vtr", "--json", "grid.json"});
  const auto grid = read_json("grid.json");
  EXPECT_EQ(grid.at("nodes"), nlohmann::json({5, 6, 7}));
  EXPECT_EQ(grid.at("cells"), 120);
  EXPECT_EQ(grid.at("box"), nlohmann::json({0.0, 1.0, 0.0, 1.0, 0.0, 1.0}));
  EXPECT_EQ(grid.at("materials").size(), 3u);
  EXPECT_EQ(find(grid.at("fields"), "constant").at("per_material"), true);
  for (const std::string name : {"s.vtp", "s.arec"}) {
    run_well({"info", name, "--json", "network.json"});
    const auto network = read_json("network.json");
    EXPECT_EQ(network.at("materials").size(), 3u);
    EXPECT_EQ(network.at("interfaces").size(), 3u);
    EXPECT_GT(network.at("junction_edges"), 0);
    EXPECT_EQ(network.at("intersections"), 0);
  }
  run_well({"info", "s.stl", "--json", "surface.json"});
  EXPECT_EQ(read_json("surface.json").at("kind"), "surface");
}

TEST_F(Commands, ReconstructKeepsVolumes) {
  make_scene("sphere", 16);
  run_well({"reconstruct", "scene.vtr", "-o", "r.vtp", "--json", "j.json", "--picture", "r.png"});
  const auto figures = read_json("j.json");
  EXPECT_NEAR(volume(figures, "inside", "volume_input"), kSphere, 1e-4);
  EXPECT_NEAR(volume(figures, "inside", "volume_reconstructed"), kSphere, 0.03 * kSphere);
  ASSERT_EQ(figures.at("interfaces").size(), 1u);
  EXPECT_EQ(figures["interfaces"][0].at("materials"), nlohmann::json({"outside", "inside"}));
  run_well({"info", "r.vtp", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json")["interfaces"][0]["triangles"], figures["interfaces"][0]["triangles"]);
  EXPECT_EQ(read("r.png").substr(1, 3), "PNG");
}

TEST_F(Commands, ResampleHasAllFigures) {
  make_scene("sphere", 12);
  run_well({"resample", "scene.vtr", "--interface-error", "2%", "--field-error", "linear=0.2", "-o", "m.vtu",
            "--interfaces-out", "i.ply", "--cut-mesh", "c.vtu", "--json", "j.json"});
  const auto figures = read_json("j.json");
  for (const char* key : {"tetrahedra", "vertices", "interface_tetrahedra", "interface_error", "fields",
                          "materials", "seconds", "processor_seconds", "peak_memory_bytes",
                          "interface_error_measured", "interface_error_target", "lost_interfaces"}) {
    EXPECT_TRUE(figures.contains(key)) << key;
  }
  const double target = figures.at("interface_error_target");
  EXPECT_NEAR(target, 0.02 * std::sqrt(3.0), 1e-12);
  EXPECT_LE(figures.at("interface_error").get<double>(), target);
  EXPECT_LE(figures.at("interface_error_measured").get<double>(),
            figures.at("interface_error").get<double>());
  const auto& linear = figures.at("fields").at("linear");
  for (const char* key : {"max_error", "mean_error", "interface_max_error", "interface_mean_error"}) {
    EXPECT_TRUE(linear.at(key).is_number()) << key;
  }
  EXPECT_LE(linear.at("max_error").get<double>(), 0.2);
  EXPECT_LE(linear.at("reducible_max_error"), linear.at("max_error"));
  const auto& elements = linear.at("elements");
  EXPECT_EQ(elements.at("pure").get<int>() + elements.at("mixed").get<int>(), 12 * 12 * 12);
  EXPECT_GT(elements.at("minority"), 0);
  EXPECT_GT(elements.at("displaced"), 0);
  EXPECT_NEAR(volume(figures, "inside", "volume_input"), kSphere, 1e-4);
  EXPECT_NEAR(volume(figures, "inside", "volume_mesh") + volume(figures, "outside", "volume_mesh"), 1, 1e-12);
  // The distance bounds the difference of volumes, which is at most the area times the distance and a little
  // more.
  EXPECT_NEAR(volume(figures, "inside", "volume_mesh"), kSphere,
              4 * std::numbers::pi * 0.35 * 0.35 * target * 1.2);
  // The same numbers are counted again from the files.
  run_well({"info", "m.vtu", "--json", "i.json"});
  const auto info = read_json("i.json");
  EXPECT_EQ(info.at("cells"), figures.at("tetrahedra"));
  EXPECT_EQ(info.at("points"), figures.at("vertices"));
  std::size_t sum = 0;
  for (const auto& level : info.at("levels")) sum += level.at("tetrahedra").get<std::size_t>();
  EXPECT_EQ(sum, figures.at("tetrahedra"));
  EXPECT_NEAR(volume(info, "inside"), volume(figures, "inside", "volume_mesh"), 1e-12);
  run_well({"info", "i.ply", "--json", "ply.json"});
  EXPECT_EQ(read_json("ply.json").at("cells"), figures.at("interface_triangles"));
  EXPECT_EQ(read_json("ply.json").at("open_border_edges"), 0);
  // The file holds a network with its materials.
  run_well({"probe", "i.ply", "--point", "0.5,0.5,0.5", "-o", "p.csv"});
  EXPECT_NE(read("p.csv").find("inside"), std::string::npos);
}

TEST_F(Commands, ResampleKeepsABudget) {
  make_scene("sphere", 8);
  const RunResult result = run(
      {"resample", "scene.vtr", "--interface-error", "0.1%", "--max-tetrahedra", "400", "--json", "j.json"});
  EXPECT_EQ(result.status, 3);
  EXPECT_LE(read_json("j.json").at("tetrahedra"), 400);
  EXPECT_NE(result.err.find("adamas: note: the interface error wanted was not reached"), std::string::npos);
  EXPECT_EQ(read_json("j.json").at("interface_error_reached"), false);
}

TEST_F(Commands, MissedFieldErrorsAreNoted) {
  make_scene("sphere", 8);
  const RunResult result =
      run({"resample", "scene.vtr", "--interface-error", "5%", "--field-error", "smooth=1e-9",
           "--field-error", "constant=0.1", "--max-tetrahedra", "600", "--json", "j.json"});
  EXPECT_EQ(result.status, 3);
  ASSERT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_EQ(result.err.rfind("adamas: note: the error wanted of the field 'smooth' was not reached", 0), 0u);
  const auto figures = read_json("j.json");
  EXPECT_EQ(figures.at("interface_error_reached"), true);
  EXPECT_EQ(figures.at("fields").at("smooth").at("reached"), false);
  EXPECT_EQ(figures.at("fields").at("constant").at("reached"), true);
  EXPECT_TRUE(figures.at("fields").at("linear").at("reached").is_null());
}

TEST_F(Commands, ResampleGivenInterfaces) {
  make_scene("tjunction", 4);
  run_well({"generate", "scene", "tjunction", "--interfaces", "t.vtp", "--json", "truth.json"});
  const auto truth = read_json("truth.json");
  run_well({"resample", "t.vtp", "--box", "0,1,0,1,0,1", "--json", "j.json"});
  for (const std::string material : {"a", "b", "c"}) {
    EXPECT_NEAR(volume(read_json("j.json"), material, "volume_mesh"), volume(truth, material), 1e-9);
  }
  EXPECT_TRUE(read_json("j.json").at("fields").empty());
}

TEST_F(Commands, GivenInterfacesTakeTheirFieldsFromAGrid) {
  // The two materials are named in both orders; one of them turns the sphere inside out.
  make_scene("sphere", 8);
  run_well({"generate", "scene", "sphere", "--resolution", "0.1", "--interfaces", "s.obj"});
  for (const std::string pair : {"outside,inside", "inside,outside"}) {
    const RunResult result = run({"resample", "scene.vtr", "--interface", "s.obj=" + pair,
                                  "--interface-error", "2%", "--json", "j.json", "-o", "m.vtu"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto figures = read_json("j.json");
    EXPECT_TRUE(figures.at("fields").contains("smooth"));
    run_well({"probe", "m.vtu", "--point", "0.5,0.5,0.5", "-o", "p.csv"});
    const auto rows = parse_csv(read("p.csv"));
    ASSERT_EQ(rows.size(), 2u);
    const bool normals_out = rows[1][3] == "inside";
    EXPECT_NEAR(volume(figures, normals_out ? "inside" : "outside", "volume_mesh"), kSphere, 0.05);
  }
}

TEST_F(Commands, AGridWithoutMaterialsGivesFieldsAlone) {
  write_image("f.nrrd", 5, [](std::size_t i) { return 0.5f + static_cast<float>(i % 5); });
  write("t.obj", "v 1 1 1\nv 3 1 1\nv 1 3 1\nv 1 1 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  run_well({"resample", "f.nrrd", "--interface", "t.obj=air,metal", "--interface-error", "2%", "-o", "m.vtu",
            "--json", "j.json"});
  EXPECT_NEAR(volume(read_json("j.json"), "metal", "volume_mesh"), 8.0 / 6, 0.2);
  run_well({"probe", "m.vtu", "--point", "1.5,1.5,1.5", "--point", "3.5,3.5,3.5", "-o", "p.csv"});
  const auto rows = parse_csv(read("p.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][3], "metal");
  EXPECT_EQ(rows[2][3], "air");
  EXPECT_NEAR(std::stod(rows[2][5]), 4.0, 0.05);
}

TEST_F(Commands, SlicesHaveTheAreasOfTheScene) {
  run_well(
      {"generate", "scene", "tjunction", "--dimensions", "8,8,8", "-o", "s.vtr", "--interfaces", "s.vtp"});
  run_well({"resample", "s.vtp", "--box", "0,1,0,1,0,1", "-o", "m.vtu"});
  run_well({"slice", "m.vtu", "--plane", "z=0.5", "-o", "s.svg", "--json", "j.json"});
  const auto figures = read_json("j.json");
  EXPECT_NEAR(figures.at("area").get<double>(), 1, 1e-12);
  // The first plane, x + y = 1, halves the section.
  EXPECT_NEAR(find(figures.at("materials"), "a").at("area").get<double>(), 0.5, 1e-9);
  for (const std::string file : {"a.png", "a.pdf", "a.vtp"}) {
    run_well({"slice", "s.vtr", "--origin", "0.5,0.5,0.5", "--normal", "1,2,-3", "--field", "linear", "-o",
              file, "--json", "a.json"});
    EXPECT_GT(std::filesystem::file_size(folder() / file), 500u);
  }
  run_well({"info", "a.vtp", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json").at("kind"), "polygons");
  EXPECT_EQ(read_json("i.json").at("cells"), read_json("a.json").at("pieces"));
}

TEST_F(Commands, ProbeKnowsMaterialsAndIntegrals) {
  make_scene("sphere", 12);
  run_well({"resample", "scene.vtr", "--interface-error", "1%", "-o", "m.vtu"});
  for (const std::string input : {"scene.vtr", "m.vtu"}) {
    const RunResult probed =
        run({"probe", input, "--line=-0.1,0.5,0.5..1.1,0.5,0.5,13", "-o", "p.csv", "--json", "j.json"});
    EXPECT_EQ(probed.err,
              "adamas: note: 2 of 13 points lie outside of the domain [0, 1] x [0, 1] x [0, 1]\n");
    EXPECT_EQ(probed.out, "");
    EXPECT_NE(run_well({"probe", input}).out.find("mean of smooth"), std::string::npos);
    const auto rows = parse_csv(read("p.csv"));
    ASSERT_EQ(rows.size(), 14u);
    EXPECT_EQ(rows[0][3], "material");
    EXPECT_EQ(rows[0][5], "constant");
    EXPECT_EQ(rows[1][3], "");
    EXPECT_EQ(rows[2][3], "outside");
    EXPECT_EQ(rows[7][3], "inside");
    EXPECT_NEAR(std::stod(rows[2][5]), 10, 1e-6);
    EXPECT_NEAR(std::stod(rows[7][5]), 20, 1e-6);
    const auto figures = read_json("j.json");
    const auto& inside = find(figures.at("materials"), "inside");
    EXPECT_NEAR(inside.at("volume").get<double>(), kSphere, 0.03);
    EXPECT_NEAR(inside.at("fields").at("constant").at("mean").get<double>(), 20, 1e-5);
  }
  const RunResult printed = run_well({"probe", "m.vtu", "--point", "0.5,0.5,0.5"});
  EXPECT_EQ(parse_csv(printed.out).size(), 2u);
  EXPECT_NE(run_well({"probe", "m.vtu"}).out.find("inside"), std::string::npos);
}

TEST_F(Commands, ThreadsChangeNoByte) {
  make_scene("reflex", 6);
  const std::vector<std::string> names{"m.vtu", "i.ply", "c.vtu", "s.png"};
  std::vector<std::string> bytes;
  std::vector<nlohmann::json> figures;
  for (const std::string n : {"1", "2"}) {
    run_well({"resample", "scene.vtr", "--interface-error", "4%", "--field-error", "smooth=10%", "--threads",
              n, "-o", "m.vtu", "--interfaces-out", "i.ply", "--cut-mesh", "c.vtu", "--json", "j.json"});
    run_well({"slice", "m.vtu", "--plane", "x=0.4", "--field", "smooth", "--threads", n, "-o", "s.png"});
    for (const std::string& name : names) bytes.push_back(read(name));
    figures.push_back(without_cost(read_json("j.json")));
  }
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_TRUE(bytes[i] == bytes[names.size() + i]) << names[i];
  EXPECT_EQ(figures[0], figures[1]);
}

TEST_F(Commands, AConfigurationSaysTheSame) {
  make_scene("sphere", 8);
  run_well({"resample", "scene.vtr", "--interface-error", "3%", "--ghost", "linear", "--field-error",
            "linear=5%", "--field-error", "smooth=0.5", "--region", "0,1,0,1,0,0.8", "--json", "a.json", "-o",
            "a.vtu"});
  write("c.toml",
        "# a comment\ninput = \"scene.vtr\"\ninterface-error = \"3%\"\nghost = \"linear\"\n"
        "field-error = [\"linear=5%\", \"smooth=0.5\"]\nregion = \"0,1,0,1,0,0.8\"\n\n"
        "[slice]\nplane = \"x=0.5\"\n");
  run_well({"resample", "--config", "c.toml", "--json", "b.json", "-o", "b.vtu"});
  EXPECT_EQ(without_cost(read_json("a.json")), without_cost(read_json("b.json")));
  EXPECT_TRUE(read("a.vtu") == read("b.vtu"));
  // Options on the command line take precedence.
  run_well({"resample", "--config", "c.toml", "--interface-error", "6%", "--json", "d.json"});
  EXPECT_NEAR(read_json("d.json").at("interface_error_target").get<double>(),
              2 * read_json("b.json").at("interface_error_target").get<double>(), 1e-12);
  write("s.toml", "[slice]\nplane = \"x=0.5\"\nsize = 300,400\n[resample]\nghost = \"linear\"\n");
  run_well({"slice", "a.vtu", "--config", "s.toml", "-o", "s.png"});
}

TEST_F(Commands, QuietAndVerbose) {
  make_scene("sphere", 6);
  EXPECT_EQ(run_well({"resample", "scene.vtr", "--quiet", "-o", "m.vtu"}).out, "");
  EXPECT_EQ(run({"probe", "scene.vtr", "--quiet", "--point", "5,5,5"}).err, "");
  const RunResult verbose = run({"resample", "scene.vtr", "--verbose", "-o", "m.vtu"});
  EXPECT_EQ(verbose.status, 0);
  EXPECT_NE(verbose.err.find("refining interfaces"), std::string::npos);
  expect_wrong_usage({"resample", "scene.vtr", "--quiet", "--verbose"}, {"--quiet and --verbose"});
}

/// Every command that reconstructs takes the option. With it a slope of labels needs fewer tetrahedra and has
/// less area.
TEST_F(Commands, SmoothedLabels) {
  std::string labels;
  for (int i = 0; i < 1000; ++i)
    labels += 2 * (i % 10) + 3 * (i / 10 % 10) + 4 * (i / 100) < 41 ? '\1' : '\2';
  write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10 10 10\nencoding: raw\n\n" + labels);
  const auto figures = [this](std::vector<std::string> words, bool smooth) {
    words.insert(words.end(), {"--labels", "a.nrrd", "--cells", "--json", "j.json"});
    if (smooth) words.push_back("--smooth-labels");
    const RunResult result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_json("j.json");
  };
  const std::vector<std::string> resample{"resample", "a.nrrd", "--interface-error", "3%", "-o", "m.vtu"};
  EXPECT_LT(2 * figures(resample, true).at("tetrahedra").get<int>(),
            figures(resample, false).at("tetrahedra").get<int>());
  const std::vector<std::string> reconstruct{"reconstruct", "a.nrrd", "-o", "o.vtp"};
  EXPECT_NEAR(volume(figures(reconstruct, true), "1", "volume_reconstructed"),
              volume(figures(reconstruct, false), "1", "volume_reconstructed"), 1e-6);
  write("e.toml", "smooth-labels = true\ncells = true\nlabels = a.nrrd\ninterface-error = 3%\nplane = z=5\n");
  run_well({"experiment", "-c", "e.toml", "-o", "e"});
  EXPECT_EQ(read_json("e/metrics.json").at("curve").back().at("tetrahedra"),
            figures(resample, true).at("tetrahedra"));
  run_well({"slice", "a.nrrd", "--labels", "a.nrrd", "--cells", "--smooth-labels", "--plane", "z=5", "-o",
            "s.png"});
  run_well({"probe", "a.nrrd", "--labels", "a.nrrd", "--cells", "--smooth-labels", "--point", "5,5,5"});
}

TEST_F(Commands, ValuesOfCellsOrPoints) {
  // The lower half is one material. With values of cells these are half of 4 x 4 x 4 cells, with values of
  // points half of 3 x 3 x 3.
  std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nspacings: 1 1 1\nencoding: raw\n";
  std::string values;
  for (std::size_t i = 0; i < 64; ++i) values += i < 32 ? '\1' : '\2';
  write("a.nrrd", nrrd + "\n" + values);
  const auto check = [this](const std::vector<std::string>& more, double expected, bool noted) {
    std::vector<std::string> all{"info", "a.nrrd", "--labels", "a.nrrd", "--json", "j.json"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(all);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NEAR(volume(read_json("j.json"), "1"), expected, 1e-12);
    EXPECT_EQ(result.err_lines().size(), noted ? 1u : 0u);
    EXPECT_EQ(result.err.find("a.nrrd: nothing says") != std::string::npos, noted) << result.err;
  };
  check({}, 32, true);
  check({"--cells"}, 32, false);
  check({"--points"}, 13.5, false);
  expect_wrong_usage({"info", "a.nrrd", "--cells", "--points"},
                     {"--cells and --points: expected one of them"});
  expect_wrong_usage({"info", "a.obj", "--points"}, {"--points: expected data on a grid as INPUT"});
  write("a.nrrd", nrrd + "centers: cell cell cell\n\n" + values);
  check({}, 32, false);
}

}  // namespace

}  // namespace adamas::test
