// Tests `adamas generate buckyball`: what it writes, and what it refuses.

#include "program.h"

namespace adamas::test {

namespace {

class BuckyballCommand : public ProgramTest {
 protected:
  static std::vector<std::string> ball(const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate", "buckyball", "--dimensions", "13,9,7"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(BuckyballCommand, EveryFormatHoldsTheSameSamples) {
  run_well(ball({"-o", "b.raw", "--type", "uint16"}));
  const std::string samples = read("b.raw");
  ASSERT_EQ(samples.size(), 2u * 13 * 9 * 7);
  for (const std::string name : {"c.vti", "c.nrrd", "c.mha", "d.nhdr", "e.mhd"}) {
    const std::string text = run_well(ball({"-o", name, "--type", "uint16", "--json", "f.json"})).out;
    EXPECT_NE(text.find("Buckyball of 13 x 9 x 7 samples, uint16"), std::string::npos) << text;
    const bool apart = name == "d.nhdr" || name == "e.mhd";
    EXPECT_NE((apart ? read(name.substr(0, 2) + "raw") : read(name)).find(samples), std::string::npos)
        << name;
    const auto figures = read_json("f.json");
    EXPECT_EQ(figures["dimensions"], (std::vector<int>{13, 9, 7}));
    EXPECT_EQ(figures["type"], "uint16");
    EXPECT_EQ(figures["bytes"], read(name).size() + (apart ? samples.size() : 0));
    EXPECT_EQ(figures["spacing"], (std::vector<double>{1, 1.5, 2}));
    const std::string known = run_well({"info", name}).out;
    EXPECT_NE(known.find("13 x 9 x 7 nodes"), std::string::npos) << known;
    EXPECT_NE(known.find("[0, 12] x [0, 12] x [0, 12]"), std::string::npos) << known;
    EXPECT_NE(known.find("uint16"), std::string::npos) << known;
  }
  EXPECT_EQ(files(), (std::set<std::string>{"b.raw", "c.vti", "c.nrrd", "c.mha", "d.nhdr", "d.raw", "e.mhd",
                                            "e.raw", "f.json"}));
}

TEST_F(BuckyballCommand, OneNumberForAllAxesAndBytesByDefault) {
  run_well({"generate", "buckyball", "--dimensions", "8", "-o", "b.raw"});
  EXPECT_EQ(read("b.raw").size(), 512u);
  run_well({"generate", "buckyball", "--dimensions", "1", "-o", "one.raw", "--type", "float32"});
  EXPECT_EQ(read("one.raw").size(), 4u);
}

TEST_F(BuckyballCommand, TheNumberOfThreadsChangesNothing) {
  run_well(ball({"-o", "a.vti", "--threads", "1"}));
  run_well(ball({"-o", "b.vti", "--threads", "2"}));
  EXPECT_EQ(read("a.vti"), read("b.vti"));
}

TEST_F(BuckyballCommand, HelpHasAnExample) {
  const std::string help = run_well({"generate", "buckyball", "--help"}).out;
  EXPECT_NE(help.find("Example:\n  adamas generate buckyball"), std::string::npos) << help;
  EXPECT_NE(help.find("--type uint8|uint16|float32"), std::string::npos) << help;
}

TEST_F(BuckyballCommand, WrongUsage) {
  expect_wrong_usage({"generate", "buckyball", "-o", "b.vti"}, {"--dimensions"});
  expect_wrong_usage(ball({}), {"output"});
  for (const std::string dimensions : {"0", "8,8", "8,-1,8", "nan", "1e3", "8,8,8,8"}) {
    expect_wrong_usage({"generate", "buckyball", "-o", "b.vti", "--dimensions=" + dimensions},
                       {"--dimensions", "expected", dimensions});
  }
  expect_wrong_usage(ball({"-o", "b.vti", "--type", "int64"}),
                     {"--type: expected uint8, uint16 or float32, found 'int64'"});
  for (const std::string name : {"b.vtr", "b", "b.tif"}) {
    expect_wrong_usage(ball({"-o", name}), {"-o: expected a file name that ends in .vti, .nrrd", name});
  }
}

TEST_F(BuckyballCommand, NothingIsLeftBehind) {
  expect_failure({"generate", "buckyball", "--dimensions", "65537,1,1", "-o", "b.vti"},
                 {"expected from 1 to 65536 samples", "65537 x 1 x 1"});
  expect_failure({"generate", "buckyball", "--dimensions", "65536", "-o", "b.mhd"},
                 {"b.raw: expected 281474976710656 bytes of room on the disk"});
  expect_failure(ball({"-o", "none/b.vti"}), {"none/", "expected an existing output folder"});
  expect_failure(ball({"-o", "a%d.mhd"}), {"a%d.mhd", "expected a data file whose name a header can hold"});
  RunOptions full;
  full.file_size_limit = 500;
  for (const std::string name : {"b.vti", "b.nrrd", "b.mha", "b.raw"})
    expect_failure(ball({"-o", name}), {name}, full);
  for (const std::string name : {"b.nhdr", "b.mhd"}) expect_failure(ball({"-o", name}), {"b.raw"}, full);
  std::filesystem::create_directory(folder() / "c.raw");
  expect_failure(ball({"-o", "c.nhdr"}), {"c.raw", "found a folder"});
}

TEST_F(BuckyballCommand, InterruptedRuns) {
  RunOptions stop;
  stop.interrupt_at = "writing";
  const RunResult result =
      run({"generate", "buckyball", "--dimensions", "700", "--type", "float32", "--verbose", "-o", "b.nhdr"},
          stop);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(files(), std::set<std::string>());
}

}  // namespace

}  // namespace adamas::test
