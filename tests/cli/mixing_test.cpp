// Tests `adamas generate mixing`, and the series of `generate scene`: what they write, and what they refuse.

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include "core/io/multi_material_reader.h"
#include "core/io/volume_reader.h"
#include "program.h"

namespace adamas::test {

using namespace io;

namespace {

class Mixing : public ProgramTest {
 protected:
  /// Returns the command with small dimensions, an early end and more options.
  static std::vector<std::string> mixing(const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate", "mixing", "--dimensions", "9,8,16", "--end-time", "2e-4"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(Mixing, ASeriesHasOneScale) {
  const std::string text = run_well(mixing({"-o", "m.pvd", "--steps", "3", "--json", "m.json"})).out;
  EXPECT_NE(text.find("Mixing in 9 x 8 x 16 samples, uint8"), std::string::npos) << text;
  EXPECT_EQ(files(), (std::set<std::string>{"m.pvd", "m_0000.vti", "m_0001.vti", "m_0002.vti", "m.json"}));
  const std::string list = read("m.pvd");
  EXPECT_NE(list.find("<DataSet timestep=\"0.0001\" part=\"0\" file=\"m_0001.vti\"/>"), std::string::npos)
      << list;
  const auto figures = read_json("m.json");
  EXPECT_EQ(figures["dimensions"], (std::vector<int>{9, 8, 16}));
  EXPECT_EQ(figures["steps"], 3);
  EXPECT_EQ(figures["seconds_per_step"], 1e-4);
  EXPECT_EQ(figures["times"], (std::vector<double>{0, 1e-4, 2e-4}));
  EXPECT_EQ(figures["type"], "uint8");
  std::size_t bytes = list.size();
  for (int step = 0; step < 3; ++step) {
    const std::string name = "m_000" + std::to_string(step) + ".vti";
    bytes += read(name).size();
    for (const auto& field : figures["fields"]) {
      VolumeOptions options;
      options.array = field["name"];
      options.keep_scale = true;
      const VolumeReader reader = open_volume(folder() / name, options);
      EXPECT_EQ(reader.grid().type, SampleType::kUint8);
      EXPECT_EQ(reader.grid().slope, field["slope"]);
      EXPECT_EQ(reader.grid().intercept, field["intercept"]);
      EXPECT_LE(field["intercept"], field["least"]);
    }
  }
  EXPECT_EQ(figures["bytes"], bytes);
  for (const auto& mass : figures["masses"]) {
    const double start = mass["start"], end = mass["end"], entered = mass["entered"];
    EXPECT_NEAR((end - entered) / start, 1, 1e-12) << mass["name"];
  }
}

TEST_F(Mixing, TheLastStepAloneAndEveryType) {
  run_well(mixing({"-o", "f.vti", "--type", "float32"}));
  for (const std::string type : {"uint8", "uint16"}) {
    run_well(mixing({"-o", "i.vti", "--type", type, "--json", "i.json"}));
    const auto figures = read_json("i.json");
    EXPECT_EQ(figures["steps"], 1);
    EXPECT_EQ(figures["times"], std::vector<double>{2e-4});
    // VTK reads both arrays, too.
    const auto image = [&](const char* name) {
      vtkNew<vtkXMLImageDataReader> reader;
      reader->SetFileName((folder() / name).c_str());
      reader->Update();
      return vtkSmartPointer<vtkImageData>(reader->GetOutput());
    };
    const auto exact = image("f.vti"), whole = image("i.vti");
    ASSERT_EQ(whole->GetPointData()->GetNumberOfArrays(), 2);
    for (const auto& field : figures["fields"]) {
      const std::string name = field["name"];
      const double slope = field["slope"], intercept = field["intercept"];
      vtkDataArray *values = exact->GetPointData()->GetArray(name.c_str()),
                   *samples = whole->GetPointData()->GetArray(name.c_str());
      ASSERT_NE(values, nullptr);
      ASSERT_NE(samples, nullptr);
      ASSERT_EQ(samples->GetNumberOfTuples(), 9 * 8 * 16);
      for (vtkIdType at = 0; at < 9 * 8 * 16; ++at)
        ASSERT_NEAR(slope * samples->GetTuple1(at) + intercept, values->GetTuple1(at), 0.51 * slope + 1e-3);
    }
  }
}

TEST_F(Mixing, StoresHaveItsValues) {
  run_well(mixing({"-o", "i.vti"}));
  run_well({"store", "i.vti", "--array", "density", "-o", "i.adm"});
  const std::string known = run_well({"info", "i.adm"}).out;
  EXPECT_NE(known.find("times the samples plus 0"), std::string::npos) << known;
}

TEST_F(Mixing, SeedsDifferAndTheNumberOfThreadsChangesNothing) {
  run_well(mixing({"-o", "a.vti", "--seed", "4", "--threads", "1"}));
  run_well(mixing({"-o", "b.vti", "--seed", "4", "--threads", "2"}));
  run_well(mixing({"-o", "c.vti", "--seed", "5"}));
  EXPECT_EQ(read("a.vti"), read("b.vti"));
  EXPECT_NE(read("a.vti"), read("c.vti"));
}

TEST_F(Mixing, WrongUsage) {
  expect_wrong_usage({"generate", "mixing"}, {"output"});
  for (const std::string dimensions : {"0", "8,8", "8,0,8", "8,8,7", "8,-1,8", "nan", "1e3", "8,8,8,8"}) {
    expect_wrong_usage({"generate", "mixing", "-o", "i.vti", "--dimensions=" + dimensions},
                       {"--dimensions", "expected", dimensions});
  }
  for (const std::string mach : {"0", "1", "-2", "10.5", "nan", "inf", "x"})
    expect_wrong_usage(mixing({"-o", "i.vti", "--mach=" + mach}), {"--mach", "expected", mach});
  for (const std::string time : {"0", "-1", "nan", "x"}) {
    expect_wrong_usage({"generate", "mixing", "-o", "i.vti", "--end-time=" + time},
                       {"--end-time", "expected", time});
  }
  for (const std::string steps : {"0", "1", "-3", "2.5", "nan", "1001"})
    expect_wrong_usage(mixing({"-o", "s.pvd", "--steps=" + steps}), {"--steps", "expected", steps});
  expect_wrong_usage(mixing({"-o", "i.vti", "--steps", "3"}), {"--steps", "expected a series", "i.vti"});
  expect_wrong_usage(mixing({"-o", "i.vti", "--seed", "-1"}), {"--seed", "expected", "-1"});
  expect_wrong_usage(mixing({"-o", "i.vti", "--type", "int16"}),
                     {"--type: expected uint8, uint16 or float32"});
  for (const std::string name : {"i.vtr", "i", "i.nrrd"})
    expect_wrong_usage(mixing({"-o", name}), {"-o", "expected", ".pvd", name});
}

TEST_F(Mixing, NothingIsLeftBehind) {
  expect_failure(mixing({"-o", "none/m.pvd"}), {"none/", "expected an existing output folder"});
  std::filesystem::create_directory(folder() / "s_0002.vti");
  expect_failure(mixing({"-o", "s.pvd", "--steps", "4"}), {"s_0002.vti", "found a folder"});
  RunOptions full;
  full.file_size_limit = 1000;
  expect_failure(mixing({"-o", "i.vti"}), {"i.vti"}, full);
  expect_failure(mixing({"-o", "t.pvd"}), {"t_000"}, full);
  expect_failure({"generate", "mixing", "-o", "i.vti", "--dimensions", "100000"},
                 {"mixing", "expected dimensions that fit in memory", "100000x100000x100000"});
}

TEST_F(Mixing, InterruptedRuns) {
  RunOptions stop;
  stop.interrupt_at = "step 2 of 40";
  const RunResult result =
      run({"generate", "mixing", "--verbose", "--steps", "40", "-o", "s.pvd", "--json", "j.json"}, stop);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(files(), std::set<std::string>());
}

class MovingSceneCommand : public ProgramTest {};

TEST_F(MovingSceneCommand, ASeriesOfFractions) {
  run_well({"generate", "scene", "moving", "--dimensions", "10", "--steps", "3", "-o", "s.pvd", "--json",
            "s.json"});
  EXPECT_EQ(files(), (std::set<std::string>{"s.pvd", "s_0000.vtr", "s_0001.vtr", "s_0002.vtr", "s.json"}));
  const auto figures = read_json("s.json");
  EXPECT_EQ(figures["steps"], 3);
  ASSERT_EQ(figures["series"].size(), 3u);
  EXPECT_EQ(figures["series"][1]["time"], 0.5);
  for (int step = 0; step < 3; ++step) {
    const MultiMaterialData data =
        read_multi_material_data(folder() / ("s_000" + std::to_string(step) + ".vtr"));
    ASSERT_EQ(data.materials.size(), 5u);
    for (MaterialId m(0); m.value < 5; ++m.value) {
      double volume = 0;
      for (std::size_t site = 0; site < 1000; ++site)
        volume += static_cast<double>(data.fraction(m, site)) / 1000;
      EXPECT_NEAR(volume, figures["series"][step]["materials"][m.value]["volume"], 1e-4);
    }
  }
  // A file of data without a series is the last step.
  run_well({"generate", "scene", "moving", "--dimensions", "10", "-o", "one.vtr"});
  EXPECT_EQ(read("one.vtr"), read("s_0002.vtr"));
}

TEST_F(MovingSceneCommand, ASeriesOfVolumes) {
  run_well({"generate", "scene", "moving", "--dimensions", "9,10,11", "--steps", "2", "--volume", "uint16",
            "-o", "v.pvd", "--json", "v.json"});
  EXPECT_EQ(files(), (std::set<std::string>{"v.pvd", "v_0000.vti", "v_0001.vti", "v.json"}));
  const auto figures = read_json("v.json");
  EXPECT_EQ(figures["type"], "uint16");
  for (const char* name : {"v_0000.vti", "v_0001.vti"}) {
    VolumeOptions options;
    options.keep_scale = true;
    const VolumeReader reader = open_volume(folder() / name, options);
    EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{9, 10, 11}));
    EXPECT_EQ(reader.grid().slope, figures["slope"]);
    EXPECT_EQ(reader.grid().intercept, figures["intercept"]);
  }
  run_well({"generate", "scene", "sphere", "--dimensions", "8", "--volume", "float32", "-o", "s.vti"});
  EXPECT_EQ(open_volume(folder() / "s.vti").grid().type, SampleType::kFloat32);
}

TEST_F(MovingSceneCommand, WrongUsage) {
  const std::vector<std::string> moving{"generate", "scene", "moving", "--dimensions", "8"};
  const auto with = [&moving](const std::vector<std::string>& more) {
    std::vector<std::string> all = moving;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_wrong_usage({"generate", "scene", "sphere", "--dimensions", "8", "-o", "s.pvd"},
                     {"-o: expected the scene moving for a series, found sphere"});
  expect_wrong_usage(with({"-o", "s.vtr", "--steps", "3"}), {"--steps", "expected a series", "s.vtr"});
  expect_wrong_usage(with({"--interfaces", "s.vtp", "--steps", "3"}), {"--steps", "expected -o F.pvd"});
  expect_wrong_usage(with({"--interfaces", "s.vtp", "--volume", "uint8"}), {"--volume", "expected -o"});
  expect_wrong_usage(with({"-o", "s.vtr", "--volume", "uint8"}), {"-o", "expected", ".vti", "s.vtr"});
  expect_wrong_usage(with({"-o", "s.vti", "--volume", "int8"}),
                     {"--volume: expected uint8, uint16 or float32"});
  for (const std::string steps : {"1", "-3", "1001"})
    expect_wrong_usage(with({"-o", "s.pvd", "--steps=" + steps}), {"--steps", "expected", steps});
}

TEST_F(MovingSceneCommand, NothingIsLeftBehind) {
  RunOptions full;
  full.file_size_limit = 1000;
  const std::vector<std::string> volume{"generate", "scene", "moving", "--dimensions", "20",
                                        "--volume", "uint8", "-o",     "v.pvd"};
  expect_failure(volume, {"v_0000.vti"}, full);
  expect_failure({"generate", "scene", "moving", "--dimensions", "20", "-o", "s.pvd"}, {"s_0000.vtr"}, full);
  expect_failure({"generate", "scene", "moving", "--dimensions", "1", "--volume", "uint8", "-o", "v.vti"},
                 {"expected at least two samples along each axis", "1 x 1 x 1"});
}

}  // namespace

}  // namespace adamas::test
