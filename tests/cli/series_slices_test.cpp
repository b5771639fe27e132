// Tests slices of stored series.

#include <algorithm>

#include "core/base/child_process.h"
#include "program.h"

namespace adamas::test {
namespace {

/// A stored series of steps of 9^3 bytes.
class StoredSeriesSlices : public ProgramTest {
 protected:
  StoredSeriesSlices() {
    for (int step = 0; step < 5; ++step) {
      std::string bytes;
      for (int n = 0; n < 729; ++n) bytes += static_cast<char>(sample(step, n));
      write("s_" + std::to_string(step) + ".raw", bytes);
    }
    run_well({"store", "s_%d.raw", "--dimensions", "9,9,9", "--type", "uint8", "-o", "a.adm"});
  }

  static int sample(int step, int n) {
    return 20 + n % 9 * (n / 9 % 9) + (n / 81) * 3 + (step - 2) * (n & 7);
  }
  void slice(std::vector<std::string> more, const std::string& input = "a.adm") const {
    std::vector<std::string> all{"slice", input, "--plane", "z=4", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
  }
};

TEST_F(StoredSeriesSlices, PicturesHaveOneScaleOfColours) {
  slice({"-o", "p_%02d.png", "--json", "f.json"});
  int low = 255, high = 0;
  for (int step = 0; step < 5; ++step) {
    for (int n = 4 * 81; n < 5 * 81; ++n) {
      low = std::min(low, sample(step, n));
      high = std::max(high, sample(step, n));
    }
  }
  const auto figures = read_json("f.json");
  EXPECT_EQ(figures["range"], (std::vector<double>{double(low), double(high)}));
  ASSERT_EQ(figures["steps"].size(), 5u);
  for (int step = 0; step < 5; ++step) {
    const std::string number = std::to_string(step);
    EXPECT_EQ(figures["steps"][step]["step"], step);
    EXPECT_EQ(figures["steps"][step]["time"], step);
    slice({"--step", number, "--range", std::to_string(low) + "," + std::to_string(high), "-o", "one.png"});
    EXPECT_TRUE(read("one.png") == read("p_0" + number + ".png")) << number;
  }
  EXPECT_FALSE(files().contains("p_05.png"));
}

TEST_F(StoredSeriesSlices, StepsKeepTheirNumbers) {
  slice({"-o", "all.pvd"});
  slice({"-o", "some.pvd", "--steps", "1,3"});
  slice({"-o", "p_%d.vtp", "--step", "2"});
  const auto made = files();
  for (int step = 0; step < 5; ++step) {
    const std::string name = "some_000" + std::to_string(step) + ".vtp";
    ASSERT_EQ(made.contains(name), step >= 1 && step <= 3);
    if (made.contains(name)) {
      EXPECT_TRUE(read(name) == read("all" + name.substr(4)));
    }
    EXPECT_EQ(made.contains("p_" + std::to_string(step) + ".vtp"), step == 2);
  }
  EXPECT_TRUE(read("p_2.vtp") == read("all_0002.vtp"));
  EXPECT_EQ(read("some.pvd").find("timestep=\"0\""), std::string::npos);
  EXPECT_NE(read("some.pvd").find("timestep=\"3\""), std::string::npos);
}

TEST_F(StoredSeriesSlices, AreThoseOfTheFilesThatWereStored) {
  run_well({"restore", "a.adm", "-o", "back.pvd", "-q"});
  slice({"-o", "a.pvd", "--steps", "2,4"});
  slice({"-o", "b.pvd", "--array", "samples", "--steps", "2,4"}, "back.pvd");
  for (const std::string step : {"2", "3", "4"}) {
    EXPECT_TRUE(read("a_000" + step + ".vtp") == read("b_000" + step + ".vtp")) << step;
    slice({"-o", "one.vtp", "--array", "samples", "--step", step}, "back.pvd");
    EXPECT_TRUE(read("one.vtp") == read("b_000" + step + ".vtp")) << step;
  }
}

TEST_F(StoredSeriesSlices, PicturesTellStepAndTime) {
  // Both steps have the same samples, so nothing else differs.
  run_well(
      {"store", "s_0.raw", "s_0.raw", "--dimensions", "9,9,9", "--type", "uint8", "-o", "same.adm", "-q"});
  std::vector<std::string> polygons, pictures;
  for (const std::string step : {"0", "1"}) {
    slice({"-o", "p.png", "--step", step}, "same.adm");
    slice({"-o", "p.vtp", "--step", step}, "same.adm");
    pictures.push_back(read("p.png"));
    polygons.push_back(read("p.vtp"));
  }
  EXPECT_TRUE(polygons[0] == polygons[1]);
  EXPECT_FALSE(pictures[0] == pictures[1]);
}

TEST_F(StoredSeriesSlices, Films) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  slice({"-o", "f.mp4", "--frame-rate", "3", "--size", "400,400"});
  EXPECT_GT(read("f.mp4").size(), 1000u);
}

TEST_F(StoredSeriesSlices, PicturesOfSurfacesTellWhatTheyShow) {
  const auto picture = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"isosurface", "a.adm", "--step", "3", "-q", "--picture", "p.svg"});
    const RunResult result = run(more);
    EXPECT_EQ(result.status, 0) << result.err;
    return read("p.svg");
  };
  const std::string smooth = picture({"--isovalue", "50"});
  EXPECT_NE(smooth.find("a.adm, time 3, step 3, isovalue 50"), std::string::npos);
  EXPECT_EQ(smooth.find("no surface"), std::string::npos);
  EXPECT_FALSE(smooth == picture({"--isovalue", "50", "--no-normals"}));
  EXPECT_NE(picture({"--isovalue", "2000"}).find("no surface at isovalue 2000"), std::string::npos);
}

TEST_F(StoredSeriesSlices, NotesNameTheFileOnce) {
  run_well({"generate", "mixing", "--dimensions", "8", "--steps", "2", "-o", "m.pvd", "-q"});
  const RunResult result =
      run({"slice", "m.pvd", "--array", "density", "--plane", "y=0.05", "-o", "m_%d.png"});
  EXPECT_EQ(result.status, 0);
  const auto lines = result.err_lines();
  ASSERT_EQ(lines.size(), 2u) << result.err;
  for (std::size_t step = 0; step < 2; ++step) {
    const std::string file = "m_000" + std::to_string(step) + ".vti: ";
    EXPECT_TRUE(lines[step].starts_with("adamas: note: " + file + "uint8 samples")) << lines[step];
  }
}

TEST_F(StoredSeriesSlices, WrongUsage) {
  const auto expect = [this](std::vector<std::string> options, const std::vector<std::string>& parts) {
    options.insert(options.begin(), {"slice", "--plane", "z=4"});
    expect_wrong_usage(options, parts);
  };
  expect({"a.adm", "--time", "3", "-o", "x.png"},
         {"--time: expected a file with several times", "--step says"});
  expect({"a.adm", "--step", "5", "-o", "x.png"}, {"--step", "5 steps"});
  expect({"a.adm", "--steps", "1,5", "-o", "x_%d.png"}, {"--steps", "two of the 5 steps of a.adm", "1,5"});
  expect({"a.adm", "--steps", "2", "-o", "x_%d.png"}, {"--steps", "A,B with A up to B", "2"});
  expect({"a.adm", "--steps", "1,2", "-o", "x.png"},
         {"-o: expected a list of steps (.pvd) or a pattern", "x.png"});
  expect({"a.adm", "--steps", "1,2", "--step", "1", "-o", "x_%d.png"}, {"--step and --steps"});
  run_well({"store", "s_0.raw", "--dimensions", "9,9,9", "--type", "uint8", "-o", "one.adm", "-q"});
  write_image("i.nrrd", 9, [](std::size_t i) { return float(i % 9); });
  for (const std::string input : {"one.adm", "i.nrrd"}) {
    for (const std::string output : {"x_%02d.png", "x.pvd", "x.mp4"})
      expect({input, "-o", output}, {"-o " + output + ": expected a series", input});
    expect({input, "--steps", "0,1", "-o", "x.png"}, {"--steps: expected a series", input});
  }
  expect({"i.nrrd", "--step", "0", "-o", "x.png"}, {"--step: expected a series", "i.nrrd"});
}

}  // namespace
}  // namespace adamas::test
