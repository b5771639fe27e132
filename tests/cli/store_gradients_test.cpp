// Tests `adamas store --gradients`, and the use of gradients by other commands.

#include "program.h"

namespace adamas::test {

namespace {

using StoreGradients = ProgramTest;

TEST_F(StoreGradients, AreStoredToldAndUsed) {
  run_well({"generate", "buckyball", "--dimensions", "40,36,33", "-o", "b.vti"});
  run_well({"store", "b.vti", "-o", "plain.adm", "--json", "plain.json"});
  run_well({"store", "b.vti", "-o", "g.adm", "--gradients", "--json", "g.json"});
  const auto plain = read_json("plain.json"), with = read_json("g.json");
  EXPECT_EQ(plain["bytes_gradients"], 0);
  EXPECT_GT(with["bytes_gradients"], 0);
  EXPECT_EQ(plain["bytes_data"], with["bytes_data"]);
  EXPECT_EQ(with["bytes_file"], read("g.adm").size());
  EXPECT_LT(with["ratio"], plain["ratio"]);
  run_well({"info", "g.adm", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json")["gradients"], true);
  EXPECT_EQ(read_json("i.json")["bytes_gradients"], with["bytes_gradients"]);
  run_well({"info", "plain.adm", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json")["gradients"], false);
  run_well({"verify", "g.adm"});
  for (const std::string name : {"plain", "g"}) {
    run_well({"isosurface", name + ".adm", "--isovalue", "120", "-o", name + ".ply"});
    run_well({"isosurface", name + ".adm", "--isovalue", "120", "--no-normals", "-o", name + "0.ply"});
    run_well({"restore", name + ".adm", "-o", name + ".raw"});
  }
  EXPECT_EQ(read("plain.raw"), read("g.raw"));
  EXPECT_EQ(read("plain0.ply"), read("g0.ply"));
  EXPECT_EQ(read("plain.ply").size(), read("g.ply").size());
  EXPECT_NE(read("plain.ply"), read("g.ply"));
  run_well({"store", "b.vti", "-o", "raw.adm", "--gradients", "--smoothing", "none"});
  EXPECT_NE(read("raw.adm"), read("g.adm"));
  run_well({"store", "b.vti", "-o", "first.adm", "--gradients", "--smoothing", "first"});
  EXPECT_NE(read("first.adm"), read("g.adm"));
  EXPECT_NE(read("first.adm"), read("raw.adm"));
  run_well({"isosurface", "raw.adm", "--isovalue", "120", "--no-normals", "-o", "raw0.ply"});
  EXPECT_EQ(read("raw0.ply"), read("g0.ply"));
  const auto wrong = run({"store", "b.vti", "-o", "none.adm", "--smoothing", "both"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--smoothing: expected with --gradients"), std::string::npos) << wrong.err;
}

TEST_F(StoreGradients, WithoutCodingTakeTwoBytesEachAndSamplesOne) {
  run_well({"generate", "buckyball", "--dimensions", "20,18,33", "-o", "b.vti"});
  const int samples = 20 * 18 * 33;
  run_well({"store", "b.vti", "-o", "p.adm", "--coding", "none", "--gradients", "--json", "f.json"});
  const auto f = read_json("f.json");
  for (const auto& [part, each] : {std::pair{"bytes_data", 1}, std::pair{"bytes_gradients", 2}}) {
    EXPECT_GE(f[part], each * samples) << part;
    // Levels with an even number of samples have one point more.
    EXPECT_LE(f[part], each * samples * 11 / 10) << part;
  }
  EXPECT_NE(run_well({"info", "p.adm"}).out.find("coding none, with gradients"), std::string::npos);
  run_well({"store", "b.vti", "-o", "c.adm", "--gradients"});
  for (const std::string name : {"p", "c"})
    run_well({"isosurface", name + ".adm", "--isovalue", "80", "--error", "0.7voxels", "-o", name + ".ply"});
  EXPECT_EQ(read("p.ply"), read("c.ply"));
}

TEST_F(StoreGradients, AreSeenInAPlane) {
  run_well({"generate", "buckyball", "--dimensions", "40,36,33", "-o", "b.vti"});
  std::vector<double> without;
  for (const std::string smoothing : {"none", "first", "both"}) {
    run_well({"store", "b.vti", "-o", "g.adm", "--gradients", "--smoothing", smoothing});
    run_well({"slice", "g.adm", "--plane", "z=16", "--gradients", "--size", "200,200", "-o",
              smoothing + ".png", "--json", "f.json"});
    EXPECT_EQ(read(smoothing + ".png").substr(1, 3), "PNG");
    without.push_back(read_json("f.json")["part_without_gradient"]);
  }
  EXPECT_GT(without[0], without[1]) << "regions are filled from their borders";
  EXPECT_GE(without[1], without[2]);
  // A legend explains the colours.
  run_well({"slice", "g.adm", "--plane", "z=16", "--gradients", "-o", "g.svg"});
  for (const std::string half : {"rgb(100%,50%,50%)", "rgb(0%,50%,50%)", "rgb(50%,100%,50%)",
                                 "rgb(50%,0%,50%)", "rgb(50%,50%,100%)", "rgb(50%,50%,0%)"})
    EXPECT_NE(read("g.svg").find(half), std::string::npos) << half;
  run_well({"store", "b.vti", "-o", "plain.adm"});
  const auto expect = [this](const std::vector<std::string>& options, int status, const std::string& part) {
    std::vector<std::string> all{"slice", "--gradients"};
    all.insert(all.end(), options.begin(), options.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.status, status);
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  };
  expect({"plain.adm", "--plane", "z=16", "-o", "p.png"}, 1, "plain.adm");
  expect({"b.vti", "--plane", "z=16", "-o", "p.png"}, 2, "--gradients: expected a store");
  expect({"g.adm", "--plane", "z=16", "-o", "p.vtp"}, 2, "--gradients: expected a picture");
  expect({"g.adm", "--plane", "z=160", "-o", "p.png"}, 1, "expected a plane that cuts");
}

}  // namespace

}  // namespace adamas::test
