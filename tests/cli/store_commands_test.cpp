// Tests `adamas store` and the commands that use its files: info, verify, restore, isosurface, slice.

#include <cmath>
#include <cstring>

#include "core/io/volume_writer.h"
#include "store_test.h"

namespace adamas::test {

using namespace io;

namespace {

class StoreCommands : public StoreTest {};

TEST_F(StoreCommands, FiguresOfAStore) {
  make_ball();
  run_well({"store", "ball.nhdr", "-o", "b.adm", "--json", "f.json"});
  const auto f = read_json("f.json");
  EXPECT_EQ(f["samples"], 40 * 40 * 40);
  EXPECT_EQ(f["bytes_input"], 40 * 40 * 40);
  EXPECT_EQ(f["bytes_gradients"], 0);
  EXPECT_EQ(f["bytes_file"], read("b.adm").size());
  EXPECT_LT(f["bytes_data"].get<double>() + f["bytes_errors"].get<double>(), f["bytes_file"].get<double>());
  EXPECT_EQ(f["ratio_data"], 64000 / f["bytes_data"].get<double>());
  EXPECT_EQ(f["ratio"], 64000 / f["bytes_file"].get<double>());
  EXPECT_GT(f["ratio_data"].get<double>(), 3);
  EXPECT_GE(f["seconds"].get<double>(), 0);
}

TEST_F(StoreCommands, WhatInfoTells) {
  make_ball();
  make_store();
  const std::string text = run_well({"info", "b.adm", "--json", "f.json"}).out;
  for (const std::string part : {"b.adm: stored volume", "40 x 40 x 40 samples, uint8",
                                 "[0, 39] x [0, 39] x [0, 39]", "values from 0 to ", "LODs 0 to 3",
                                 "coding interpolation, without gradients", "directory and copies"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const auto f = read_json("f.json");
  EXPECT_EQ(f["kind"], "store");
  EXPECT_EQ(f["dimensions"], (std::vector<int>{40, 40, 40}));
  EXPECT_EQ(f["type"], "uint8");
  EXPECT_EQ(f["levels"], 4);
  EXPECT_EQ(f["bytes_input"], 64000);
  EXPECT_EQ(f["bytes_file"], read("b.adm").size());
  const std::string samples = read("ball.raw");
  const auto [least, greatest] = std::minmax_element(samples.begin(), samples.end(), [](char a, char b) {
    return static_cast<unsigned char>(a) < static_cast<unsigned char>(b);
  });
  EXPECT_EQ(f["min"], static_cast<unsigned char>(*least));
  EXPECT_EQ(f["max"], static_cast<unsigned char>(*greatest));
}

/// Whole numbers of a NIfTI with a scale are stored unchanged; isovalues and printed numbers are scaled
/// values.
TEST_F(StoreCommands, KeepsTheScaleOfNifti) {
  VolumeGrid grid;
  grid.dimensions = {20, 18, 16};
  grid.type = SampleType::kInt16;
  grid.space = "RAS";
  std::vector<std::int16_t> samples;
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 18; ++j)
      for (int i = 0; i < 20; ++i)
        samples.push_back(static_cast<std::int16_t>(1000 - 60 * std::hypot(i - 9.3, j - 8.1, k - 7.7)));
  const auto write_as = [&](const std::string& name) {
    VolumeWriter writer(folder() / name, grid);
    for (std::uint64_t k = 0; k < 16; ++k)
      writer.write_plane(
          std::as_bytes(std::span(samples)).subspan(k * grid.plane_bytes(), grid.plane_bytes()));
    writer.finish();
  };
  write_as("plain.nii");
  grid.slope = 0.5;
  grid.intercept = -100;
  write_as("scaled.nii");
  const std::size_t bytes = samples.size() * 2;
  EXPECT_TRUE(read("scaled.nii").substr(352) == read("plain.nii").substr(352));
  for (const std::string name : {"plain", "scaled"}) {
    run_well({"store", name + ".nii", "-o", name + ".adm", "--json", "s.json"});
    EXPECT_EQ(read_json("s.json")["type"], "int16");
    EXPECT_EQ(read_json("s.json")["bytes_input"], bytes);
  }
  const std::string told = run_well({"info", "scaled.adm", "--json", "i.json"}).out;
  EXPECT_NE(told.find("values are 0.5 times the samples plus -100"), std::string::npos) << told;
  const auto info = read_json("i.json");
  const auto [least, greatest] = std::minmax_element(samples.begin(), samples.end());
  EXPECT_EQ(info["min"], 0.5 * *least - 100);
  EXPECT_EQ(info["max"], 0.5 * *greatest - 100);

  run_well({"isosurface", "plain.adm", "--isovalue", "700", "-o", "plain.obj"});
  run_well({"isosurface", "scaled.adm", "--isovalue", "250", "-o", "scaled.obj"});
  EXPECT_TRUE(read("scaled.obj") == read("plain.obj"));
  const std::string none = run({"isosurface", "scaled.adm", "--isovalue", "900", "-o", "none.obj"}).err;
  EXPECT_NE(none.find("isovalue 900: samples are from"), std::string::npos) << none;

  run_well({"restore", "scaled.adm", "-o", "back.nii"});
  EXPECT_TRUE(read("back.nii") == read("scaled.nii"));
  const std::string note = run({"restore", "scaled.adm", "-o", "back.raw"}).err;
  EXPECT_NE(note.find("0.5 times the samples plus -100, are written as float32"), std::string::npos) << note;
  const std::string values = read("back.raw");
  ASSERT_EQ(values.size(), 2 * bytes);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    float value = 0;
    std::memcpy(&value, values.data() + 4 * n, 4);
    ASSERT_EQ(value, 0.5f * samples[n] - 100);
  }
  run_well({"slice", "scaled.adm", "--plane", "z=8", "-o", "a.vtp"});
  EXPECT_EQ(run({"slice", "scaled.nii", "--plane", "z=8", "-o", "b.vtp"}).status, 0);
  EXPECT_TRUE(read("a.vtp") == read("b.vtp"));
}

TEST_F(StoreCommands, VerifyFindsAllSound) {
  make_ball();
  make_store();
  EXPECT_NE(run_well({"verify", "b.adm", "--json", "f.json"}).out.find("pages, all sound"),
            std::string::npos);
  const auto f = read_json("f.json");
  EXPECT_GT(f["pages"], 10);
  EXPECT_EQ(f["bad_pages"], 0);
}

TEST_F(StoreCommands, RestoreGivesTheSamplesBack) {
  for (const std::string type : {"uint8", "uint16", "float32"}) {
    make_ball("20,18,33", type);
    for (const std::string coding : {"interpolation", "split-edge", "none"}) {
      make_store({"--coding", coding});
      run_well({"verify", "b.adm"});
      run_well({"restore", "b.adm", "-o", "r.raw", "--json", "f.json"});
      EXPECT_EQ(read("r.raw"), read("ball.raw")) << type << " " << coding;
      EXPECT_EQ(read_json("f.json")["samples"], 20 * 18 * 33);
    }
  }
}

TEST_F(StoreCommands, RestoreToEveryFormat) {
  make_ball("20", "uint16");
  make_store();
  const std::string samples = read("ball.raw");
  for (const std::string name : {"r.vti", "r.nrrd", "r.mha", "s.nhdr", "t.mhd"}) {
    run_well({"restore", "b.adm", "-o", name});
    const bool apart = name[0] != 'r';
    EXPECT_NE((apart ? read(name.substr(0, 2) + "raw") : read(name)).find(samples), std::string::npos)
        << name;
    EXPECT_NE(run_well({"info", name}).out.find("20 x 20 x 20 nodes"), std::string::npos) << name;
  }
}

TEST_F(StoreCommands, RestoreALevelOfARegion) {
  make_ball("40", "uint8");
  make_store();
  run_well({"restore", "b.adm", "--level", "1", "--region", "10,20,0,39,6,6.5", "-o", "r.raw", "--json",
            "f.json"});
  EXPECT_EQ(read_json("f.json")["dimensions"], (std::vector<int>{6, 20, 1}));
  const std::string all = read("ball.raw");
  std::string expected;
  for (std::size_t y = 0; y < 40; y += 2) {
    for (std::size_t x = 10; x <= 20; x += 2) expected += all[x + 40 * (y + 40 * std::size_t{6})];
  }
  EXPECT_EQ(read("r.raw"), expected);
}

TEST_F(StoreCommands, SurfacesInEveryFormat) {
  make_ball();
  make_store();
  nlohmann::json first;
  for (const std::string name : {"s.ply", "s.stl", "s.obj", "s.vtp", "s.glb", "s.gltf"}) {
    run_well({"isosurface", "b.adm", "--isovalue", "80.5", "--error", "0.7voxels", "-o", name, "--json",
              "f.json"});
    const auto f = read_json("f.json");
    if (first.is_null()) first = f;
    EXPECT_GT(f["triangles"], 1000);
    EXPECT_LT(f["vertices"], f["triangles"]);
    EXPECT_GT(f["tetrahedra"], f["diamonds"]);
    EXPECT_LE(f["isosurface_error_estimate"].get<double>(), 0.7);
    EXPECT_GT(f["isosurface_error_estimate"].get<double>(), 0);
    EXPECT_GT(f["pages_read"], 0);
    EXPECT_GT(f["bytes_read"], 0);
    EXPECT_LE(f["bytes_read"], read("b.adm").size());
    for (const std::string key : {"triangles", "vertices", "tetrahedra", "diamonds"})
      EXPECT_EQ(f[key], first[key]) << name;
    if (name == "s.stl") {
      EXPECT_EQ(read(name).size(), 84 + 50 * f["triangles"].get<std::size_t>());
    }
    if (name == "s.ply") {
      EXPECT_NE(read(name).find("element face " + std::to_string(f["triangles"].get<std::size_t>())),
                std::string::npos);
    }
    if (name != "s.glb" && name != "s.gltf") run_well({"info", name});
  }
}

TEST_F(StoreCommands, PlainAndCertifiedSurfaces) {
  make_ball();
  make_store();
  const auto figures = [this](std::vector<std::string> options) {
    std::vector<std::string> all{"isosurface", "b.adm", "--isovalue", "80.5",
                                 "-o",         "s.ply", "--json",     "f.json"};
    all.insert(all.end(), options.begin(), options.end());
    run_well(all);
    return read_json("f.json");
  };
  const auto joined = figures({}), plain = figures({"--plain"});
  EXPECT_LT(2 * joined["triangles"].get<int>(), plain["triangles"].get<int>());
  // The mesh is the lattice of all samples, which consists of whole cells.
  EXPECT_GT(joined["tetrahedra"], 0);
  EXPECT_EQ(joined["tetrahedra"].get<int>() % 6, 0);
  EXPECT_EQ(joined["diamonds"], 0);
  const auto coarse = figures({"--error", "0.2"}), coarse_plain = figures({"--error", "0.2", "--plain"});
  EXPECT_LT(2 * coarse["triangles"].get<int>(), coarse_plain["triangles"].get<int>());
  EXPECT_EQ(coarse["tetrahedra"], coarse_plain["tetrahedra"]);
  EXPECT_EQ(coarse["diamonds"], coarse_plain["diamonds"]);
  EXPECT_FALSE(joined.contains("distance"));
  const auto certified = figures({"--certify", "--error", "0.4"});
  EXPECT_LE(certified["distance"]["certified"].get<double>(), 0.4);
  EXPECT_LE(certified["distance"]["found"], certified["distance"]["certified"]);
  EXPECT_EQ(certified["bodies_left_out"], 0);
  // With so few triangles the error is not reached, and the certified distance is printed.
  const RunResult few = run({"isosurface", "b.adm", "--isovalue", "80.5", "-o", "s.ply", "--max-triangles",
                             "200", "--error", "0.01", "--certify"});
  EXPECT_EQ(few.status, 0);
  EXPECT_NE(few.err.find("is certified to be within"), std::string::npos) << few.err;
}

TEST_F(StoreCommands, UnitsOfTheError) {
  make_ball();
  run_well(
      {"store", "ball.raw", "--dimensions", "40", "--type", "uint8", "--spacing", "0.5,1,2", "-o", "b.adm"});
  const auto surface = [this](const std::string& error) {
    run_well({"isosurface", "b.adm", "--isovalue", "80.5", "--error", error, "-o", "s.ply"});
    return read("s.ply");
  };
  // The least spacing is 0.5; the box is 19.5 x 39 x 78.
  const std::string absolute = surface("0.4");
  EXPECT_EQ(surface("0.8voxels"), absolute);
  EXPECT_EQ(surface("0.8 voxels"), absolute);
  EXPECT_EQ(surface(std::to_string(100 * 0.4 / std::sqrt(19.5 * 19.5 + 39 * 39 + 78 * 78)) + "%"), absolute);
  EXPECT_LT(absolute.size(), surface("0").size());
  EXPECT_EQ(surface("0%"), surface("0"));
}

TEST_F(StoreCommands, BudgetsAndRegions) {
  make_ball();
  make_store();
  run_well({"isosurface", "b.adm", "--isovalue", "80.5", "--max-triangles", "1000", "--json", "f.json"});
  const auto f = read_json("f.json");
  EXPECT_LE(f["triangles"], 1000);
  EXPECT_GT(f["triangles"], 800);
  run_well({"isosurface", "b.adm", "--isovalue", "80.5", "--region", "0,20,0,20,0,20", "-o", "part.ply",
            "--json", "f.json"});
  const auto part = read_json("f.json")["triangles"].get<double>();
  run_well({"isosurface", "b.adm", "--isovalue", "80.5", "-o", "all.ply", "--json", "f.json"});
  EXPECT_LT(part, 0.3 * read_json("f.json")["triangles"].get<double>());
  const RunResult both = run({"isosurface", "b.adm", "--isovalue", "80.5", "--max-triangles", "1000",
                              "--error", "0.5", "-o", "s.ply"});
  EXPECT_EQ(both.status, 0);
  EXPECT_NE(both.err.find("note: the error wanted was not reached with so few triangles"), std::string::npos)
      << both.err;
}

TEST_F(StoreCommands, SeveralSurfacesInOneFile) {
  make_ball();
  make_store();
  std::size_t sum = 0;
  for (const std::string value : {"40", "160.5"}) {
    run_well({"isosurface", "b.adm", "--isovalue", value, "-o", "s.ply", "--json", "f.json"});
    sum += read_json("f.json")["triangles"].get<std::size_t>();
    // Points of a single isovalue state it too, as those of several do.
    const std::string ply = read("s.ply");
    const float number = std::stof(value);
    const std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
    const std::size_t data = ply.find("end_header\n") + 11, stride = 7 * sizeof number;
    EXPECT_NE(ply.find("comment value is isovalue"), std::string::npos);
    EXPECT_NE(ply.find("property float value"), std::string::npos);
    for (std::size_t n = 1; n <= read_json("f.json")["vertices"].get<std::size_t>(); ++n)
      ASSERT_EQ(ply.substr(data + n * stride - sizeof number, sizeof number), bytes);
    run_well({"isosurface", "b.adm", "--isovalue", value, "-o", "s.vtp"});
    EXPECT_NE(read("s.vtp").find("Name=\"isovalue\""), std::string::npos);
  }
  run_well({"isosurface", "b.adm", "--isovalue", "40", "--isovalue", "160.5", "-o", "s.ply", "--picture",
            "s.png", "--json", "f.json"});
  EXPECT_EQ(read_json("f.json")["triangles"], sum);
  EXPECT_EQ(read("s.png").substr(1, 3), "PNG");
}

TEST_F(StoreCommands, EightSamples) {
  write("eight.raw", std::string("\1\2\3\4\5\6\7\x40"));
  run_well({"store", "eight.raw", "--dimensions", "2", "--type", "uint8", "-o", "b.adm"});
  run_well({"isosurface", "b.adm", "--isovalue", "20", "-o", "s.ply", "--json", "f.json"});
  EXPECT_GT(read_json("f.json")["triangles"], 0);
  run_well({"info", "b.adm", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json")["min"], 1);
  EXPECT_EQ(read_json("i.json")["max"], 64);
  const RunResult beyond = run({"isosurface", "b.adm", "--isovalue", "65", "-o", "s.ply"});
  EXPECT_EQ(beyond.err, "adamas: note: no surface at isovalue 65: samples are from 1 to 64\n");
}

TEST_F(StoreCommands, EmptySurfacesSayWhy) {
  make_ball();
  make_store();
  const auto empty = [this](const std::vector<std::string>& more, const std::string& reason) {
    std::vector<std::string> all{"isosurface", "b.adm", "-o", "s.ply"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("note: no surface at isovalue "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
    EXPECT_NE(read("s.ply").find("element face 0"), std::string::npos);
  };
  empty({"--isovalue", "1000"}, "samples are from 0 to ");
  empty({"--isovalue=-3"}, "samples are from 0 to ");
  empty({"--isovalue", "80", "--error", "500%"}, "it is smaller than the error");
  empty({"--isovalue", "80", "--region", "0,0.5,0,0.5,0,0.5"}, "nothing of it is in the region");
  for (const std::string name : {"s.stl", "s.obj", "s.vtp", "s.glb", "s.gltf"})
    EXPECT_EQ(run({"isosurface", "b.adm", "--isovalue", "1000", "-o", name}).status, 0) << name;
}

TEST_F(StoreCommands, Slices) {
  make_ball();
  make_store();
  run_well({"slice", "b.adm", "--plane", "x=19.5", "-o", "s.png", "--json", "f.json"});
  EXPECT_EQ(read("s.png").substr(1, 3), "PNG");
  EXPECT_NEAR(read_json("f.json")["area"].get<double>(), 39 * 39, 1e-9);
  EXPECT_EQ(read_json("f.json")["materials"], nlohmann::json::array());
  run_well({"slice", "b.adm", "--origin", "19,19,19", "--normal", "1,1,1", "--field", "value", "--range",
            "0,100", "-o", "s.svg"});
  run_well({"slice", "b.adm", "--plane", "z=39", "-o", "s.vtp"});
  EXPECT_NE(run_well({"info", "s.vtp"}).out.find("value"), std::string::npos);
}

TEST_F(StoreCommands, TheNumberOfThreadsChangesNothing) {
  make_ball("60");
  for (const std::string n : {"1", "2"}) {
    make_store({"--threads", n}, n + ".adm");
    run_well(
        {"isosurface", n + ".adm", "--isovalue", "80.5", "--error", "1", "--threads", n, "-o", n + ".ply"});
    run_well({"restore", n + ".adm", "--threads", n, "-o", n + ".vti"});
  }
  EXPECT_EQ(read("1.adm"), read("2.adm"));
  EXPECT_EQ(read("1.ply"), read("2.ply"));
  EXPECT_EQ(read("1.vti"), read("2.vti"));
}

TEST_F(StoreCommands, MemoryAndPagingChangeNothing) {
  make_ball("60");
  make_store();
  const auto surface = [this](const std::vector<std::string>& more) {
    std::vector<std::string> all{"isosurface", "b.adm", "--isovalue", "80.5", "-o", "s.ply"};
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
    return read("s.ply");
  };
  const std::string usual = surface({});
  EXPECT_EQ(surface({"--memory", "1"}), usual);
  EXPECT_EQ(surface({"--paging", "map"}), usual);
  run_well({"restore", "b.adm", "--memory", "1", "-o", "r.raw"});
  EXPECT_EQ(read("r.raw"), read("ball.raw"));
}

TEST_F(StoreCommands, QuietAndConfig) {
  make_ball();
  EXPECT_EQ(run_well({"store", "ball.nhdr", "-o", "b.adm", "--quiet"}).out, "");
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"info", "b.adm"},
                                             {"verify", "b.adm"},
                                             {"restore", "b.adm", "-o", "r.vti"},
                                             {"slice", "b.adm", "--plane", "x=9", "-o", "s.png"},
                                             {"isosurface", "b.adm", "--isovalue", "1000", "-o", "s.ply"}}) {
    std::vector<std::string> quiet = command;
    quiet.push_back("--quiet");
    EXPECT_EQ(run_well(quiet).out, "") << command[0];
  }
  write("c.toml",
        "quiet = true\n[isosurface]\nisovalue = [40, 160]\nerror = \"0.7voxels\"\noutput = \"c.ply\"\n"
        "[store]\ncoding = \"split-edge\"\n");
  run_well({"isosurface", "b.adm", "-c", "c.toml"});
  run_well({"isosurface", "b.adm", "--isovalue", "40", "--isovalue", "160", "--error", "0.7voxels", "-o",
            "d.ply"});
  EXPECT_EQ(read("c.ply"), read("d.ply"));
  EXPECT_EQ(run_well({"store", "ball.nhdr", "-o", "e.adm", "-c", "c.toml"}).out, "");
  EXPECT_NE(run_well({"info", "e.adm"}).out.find("coding split-edge"), std::string::npos);
}

}  // namespace

}  // namespace adamas::test
