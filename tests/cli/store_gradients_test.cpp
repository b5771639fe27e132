// adamas store --gradients, and what other commands make of it.

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
  run_well({"store", "b.vti", "-o", "raw.adm", "--gradients", "--no-smoothing"});
  EXPECT_NE(read("raw.adm"), read("g.adm"));
  run_well({"isosurface", "raw.adm", "--isovalue", "120", "--no-normals", "-o", "raw0.ply"});
  EXPECT_EQ(read("raw0.ply"), read("g0.ply"));
  const auto wrong = run({"store", "b.vti", "-o", "none.adm", "--no-smoothing"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--no-smoothing: expected with --gradients"), std::string::npos) << wrong.err;
}

}  // namespace

}  // namespace adamas::test
