// Tests `adamas generate impact`: what it writes, and what it refuses.

#include <cmath>

#include "core/io/multi_material_reader.h"
#include "program.h"

namespace adamas::test {

using namespace io;

namespace {

class Impact : public ProgramTest {
 protected:
  /// Returns the command with small dimensions, an early end and more options.
  static std::vector<std::string> impact(const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate", "impact", "--dimensions", "8,8,13", "--end-time", "1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(Impact, TheLastDataAlone) {
  const std::string text = run_well(impact({"-o", "i.vtr", "--json", "i.json"})).out;
  EXPECT_NE(text.find("Impact on 8 x 8 x 13 cells, 1 us"), std::string::npos) << text;
  EXPECT_EQ(files(), (std::set<std::string>{"i.vtr", "i.json"}));
  const auto figures = read_json("i.json");
  EXPECT_EQ(figures["dimensions"], (std::vector<int>{8, 8, 13}));
  EXPECT_EQ(figures["bytes"], read("i.vtr").size());
  EXPECT_EQ(figures["times"], std::vector<double>{1});
  EXPECT_EQ(figures["speed"], 1.2);
  EXPECT_GT(figures["steps"], 3);
  ASSERT_EQ(figures["masses"].size(), 3u);
  for (const auto& mass : figures["masses"]) {
    const double start = mass["start"], end = mass["end"], entered = mass["entered"];
    EXPECT_NEAR((end - entered) / start, 1, 1e-12) << mass["name"];
  }
  const MultiMaterialData data = read_multi_material_data(folder() / "i.vtr");
  EXPECT_EQ(data.materials.size(), 3u);
  EXPECT_EQ(data.materials[MaterialId(0)], "projectile");
  EXPECT_EQ(data.materials[MaterialId(1)], "block");
  EXPECT_EQ(data.materials[MaterialId(2)], "empty");
  ASSERT_EQ(data.fields.size(), 3u);
  EXPECT_EQ(data.fields[0].name, "density");
  EXPECT_EQ(data.fields[0].unit, "g/cm3");
  EXPECT_TRUE(data.fields[0].per_material());
  EXPECT_EQ(data.fields[1].name, "pressure");
  EXPECT_EQ(data.fields[1].unit, "Mbar");
  EXPECT_EQ(data.fields[2].name, "velocity");
  EXPECT_EQ(data.fields[2].components, 3);
  EXPECT_EQ(data.report.renormalised, 0u);
  const std::string known = run_well({"info", "i.vtr"}).out;
  for (const char* word : {"projectile", "block", "empty", "each material", "pressure", "velocity"}) {
    EXPECT_NE(known.find(word), std::string::npos) << word;
  }
}

TEST_F(Impact, ASeries) {
  run_well(impact({"-o", "s.pvd", "--steps", "3", "--json", "s.json"}));
  EXPECT_EQ(files(), (std::set<std::string>{"s.pvd", "s_0000.vtr", "s_0001.vtr", "s_0002.vtr", "s.json"}));
  const std::string list = read("s.pvd");
  EXPECT_NE(list.find("<DataSet timestep=\"0\" part=\"0\" file=\"s_0000.vtr\"/>"), std::string::npos) << list;
  EXPECT_NE(list.find("<DataSet timestep=\"0.5\" part=\"0\" file=\"s_0001.vtr\"/>"), std::string::npos);
  EXPECT_NE(list.find("<DataSet timestep=\"1\" part=\"0\" file=\"s_0002.vtr\"/>"), std::string::npos);
  const auto figures = read_json("s.json");
  std::size_t bytes = list.size();
  for (const char* name : {"s_0000.vtr", "s_0001.vtr", "s_0002.vtr"}) bytes += read(name).size();
  EXPECT_EQ(figures["bytes"], bytes);
  EXPECT_EQ(figures["times"], (std::vector<double>{0, 0.5, 1}));
  // The first file is the start, at which the projectile has its own density everywhere in it.
  const MultiMaterialData start = read_multi_material_data(folder() / "s_0000.vtr");
  for (std::size_t site = 0; site < start.grid.site_count(); ++site) {
    if (start.fraction(MaterialId(0), site) > 0) {
      EXPECT_EQ(start.fields[0].material_values[MaterialId(0)][site], static_cast<double>(19.22f));
    }
  }
}

TEST_F(Impact, TheNumberOfThreadsChangesNothing) {
  run_well(impact({"-o", "a.vtr", "--threads", "1"}));
  run_well(impact({"-o", "b.vtr", "--threads", "2"}));
  EXPECT_EQ(read("a.vtr"), read("b.vtr"));
}

TEST_F(Impact, BoxAndImageData) {
  run_well(impact({"-o", "i.vti", "--box=-4,4,0,4,-4,4", "--speed", "0.5"}));
  const MultiMaterialData data = read_multi_material_data(folder() / "i.vti");
  EXPECT_EQ(data.grid.domain().min.x, -4);
  EXPECT_EQ(data.grid.domain().max.z, 4);
}

TEST_F(Impact, WrongUsage) {
  expect_wrong_usage({"generate", "impact"}, {"output"});
  for (const std::string dimensions : {"0", "8,8", "8,0,8", "8,-1,8", "nan", "1e3", "8,8,8,8"}) {
    expect_wrong_usage({"generate", "impact", "-o", "i.vtr", "--dimensions=" + dimensions},
                       {"--dimensions", "expected", dimensions});
  }
  for (const std::string number : {"0", "-1", "nan", "inf", "x", "1e999"}) {
    expect_wrong_usage(impact({"-o", "i.vtr", "--speed=" + number}), {"--speed", "expected", number});
    expect_wrong_usage({"generate", "impact", "-o", "i.vtr", "--end-time=" + number},
                       {"--end-time", "expected", number});
  }
  expect_wrong_usage(impact({"-o", "i.vtr", "--speed", "10.5"}),
                     {"--speed", "expected at most 10", "'10.5'"});
  for (const std::string box : {"0,1,0,1", "1,0,0,1,-1,1", "1,2,0,1,-1,1", "0,1,0,1,1,2", "0,1,-2,-1,-1,1"}) {
    expect_wrong_usage(impact({"-o", "i.vtr", "--box=" + box}), {"--box", "expected", box});
  }
  for (const std::string steps : {"0", "1", "-3", "2.5", "nan", "1001"}) {
    expect_wrong_usage(impact({"-o", "s.pvd", "--steps=" + steps}), {"--steps", "expected", steps});
  }
  expect_wrong_usage(impact({"-o", "i.vtr", "--steps", "3"}), {"--steps", "expected a series", "i.vtr"});
  for (const std::string name : {"i.vtu", "i", "i.pvtr"}) {
    expect_wrong_usage(impact({"-o", name}), {"-o", "expected", ".pvd", name});
  }
}

TEST_F(Impact, NothingIsLeftBehind) {
  expect_failure(impact({"-o", "none/i.vtr"}), {"none/", "expected an existing output folder"});
  expect_failure(impact({"-o", "none/s.pvd"}), {"none/", "expected an existing output folder"});
  std::filesystem::create_directory(folder() / "s_0002.vtr");
  expect_failure(impact({"-o", "s.pvd", "--steps", "4"}), {"s_0002.vtr", "found a folder"});
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure(impact({"-o", "i.vtr"}), {"i.vtr"}, full);
  expect_failure(impact({"-o", "t.pvd"}), {"t_000"}, full);
  expect_failure({"generate", "impact", "-o", "i.vtr", "--dimensions", "100000,100000,100000"},
                 {"impact", "expected dimensions that fit in memory", "100000x100000x100000"});
}

TEST_F(Impact, InterruptedRuns) {
  for (const int interrupts : {1, 2}) {
    RunOptions stop;
    stop.interrupt_at = "writing";
    stop.interrupts = interrupts;
    const RunResult result = run({"generate", "impact", "--dimensions", "64", "--verbose", "--steps", "40",
                                  "-o", "s.pvd", "--json", "j.json"},
                                 stop);
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_EQ(files(), std::set<std::string>());
  }
}

}  // namespace

}  // namespace adamas::test
