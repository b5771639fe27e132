// Tests volume fractions and labels in files without a header, and in one array for all materials.

#include "program.h"

namespace adamas::test {
namespace {

class RawData : public ProgramTest {
 protected:
  /// Writes bytes on 8 x 6 x 4 cells, half of which are one material, and the same data as NRRD.
  RawData() {
    std::string bytes;
    for (int site = 0; site < 8 * 6 * 4; ++site) bytes += site % 8 < 4 ? '\xff' : '\0';
    write("w.raw", bytes);
    write("w.nrrd",
          "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 6 4\nspace: RAS\n"
          "space directions: (0.5,0,0) (0,1,0) (0,0,2)\nspace origin: (1,1,1)\n"
          "encoding: raw\n\n" +
              bytes);
    for (char& byte : bytes) byte = byte == '\0' ? '\7' : '\2';
    write("l.raw", bytes);
  }

  const std::vector<std::string> raw_{"--dimensions", "8,6,4",   "--type",   "uint8",
                                      "--spacing",    "0.5,1,2", "--origin", "1,1,1"};
  [[nodiscard]] std::vector<std::string> with_raw(std::vector<std::string> command) const {
    command.insert(command.end(), raw_.begin(), raw_.end());
    return command;
  }
};

TEST_F(RawData, FractionsAreThoseOfTheSameBytesWithAHeader) {
  const std::vector<std::string> options{"--rest", "air",   "--fraction-scale", "255", "--cells",
                                         "--json", "f.json"};
  const auto figures = [&](std::vector<std::string> command, std::vector<std::string> files) {
    command.insert(command.end(), options.begin(), options.end());
    command.insert(command.end(), files.begin(), files.end());
    run_well(command);
    nlohmann::json all = read_json("f.json");
    for (const char* of_run : {"seconds", "processor_seconds", "peak_memory_bytes"}) all.erase(of_run);
    return all;
  };
  for (const auto& command :
       {std::vector<std::string>{"reconstruct", "-o", "i.vtp"},
        std::vector<std::string>{"resample", "--interface-error", "5%", "-o", "m.vtu"}}) {
    const auto raw = figures(command, with_raw({"--fraction", "w=w.raw"}));
    EXPECT_EQ(raw, figures(command, {"--fraction", "w=w.nrrd"})) << command[0];
    EXPECT_NEAR(raw["materials"][0]["volume_input"].get<double>(), 96, 1e-9) << command[0];
  }
}

TEST_F(RawData, LabelsInEveryCommandThatTakesThem) {
  const auto named = [this](const std::string& command) {
    return with_raw({command, "--labels", "l.raw", "--cells"});
  };
  auto info = named("info");
  info.insert(info.end(), {"--json", "i.json"});
  run_well(info);
  EXPECT_EQ(read_json("i.json")["materials"][0]["name"], "2");
  EXPECT_EQ(read_json("i.json")["materials"][1]["name"], "7");
  auto slice = named("slice");
  std::replace(slice.begin(), slice.end(), std::string("--origin"), std::string("--first-sample"));
  slice.insert(slice.end(), {"--plane", "z=3", "-o", "s.png", "--json", "s.json"});
  run_well(slice);
  EXPECT_NEAR(read_json("s.json")["materials"][0]["area"].get<double>(), 12, 1e-9);
  auto probe = named("probe");
  probe.insert(probe.end(), {"--point", "1.1,2,3"});
  EXPECT_NE(run_well(probe).out.find("1.1,2,3,2,"), std::string::npos);
}

TEST_F(RawData, OptionsThatDoNotGoTogether) {
  expect_wrong_usage({"reconstruct", "--labels", "l.raw", "--type", "uint8", "-o", "i.vtp"},
                     {"--type: expected --dimensions as well"});
  expect_wrong_usage({"reconstruct", "--labels", "w.nrrd", "--spacing", "1,1,1", "-o", "i.vtp"},
                     {"--spacing: expected --dimensions as well"});
  expect_failure(with_raw({"reconstruct", "--labels", "w.nrrd", "--cells", "-o", "i.vtp"}),
                 {"w.nrrd: --dimensions: expected a raw file, found none whose name ends as no format's"});
  expect_failure({"reconstruct", "--labels", "l.raw", "-o", "i.vtp"},
                 {"l.raw: expected data on a grid", "(--dimensions, --type)"});
  expect_failure({"store", "l.raw", "-o", "l.adm"}, {"l.raw: expected a volume", "(--dimensions, --type)"});
}

TEST_F(RawData, AllMaterialsOfOneArray) {
  std::string text = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 4 2 2\nencoding: text\n\n";
  for (int site = 0; site < 16; ++site) text += site % 4 < 2 ? "100 0\n" : "25 75\n";
  write("t.nrrd", text);
  const auto materials = [this](const std::string& fractions) {
    run_well({"info", "--fractions", fractions, "--fraction-scale", "100", "--cells", "--json", "i.json"});
    std::vector<std::string> names;
    const nlohmann::json figures = read_json("i.json");
    for (const auto& material : figures["materials"]) names.push_back(material["name"]);
    return names;
  };
  EXPECT_EQ(materials("t.nrrd"), (std::vector<std::string>{"t_1", "t_2"}));
  EXPECT_EQ(materials("steel,air=t.nrrd"), (std::vector<std::string>{"steel", "air"}));
  EXPECT_NEAR(read_json("i.json")["materials"][1]["volume"].get<double>(), 6, 1e-6);
  expect_failure({"info", "--fractions", "a,b,c=t.nrrd", "--cells"},
                 {"--fractions: expected names of 2 materials, found 3"});
}

TEST_F(RawData, FieldsOfDoubleKeepAllDigits) {
  std::string bytes;
  for (int site = 0; site < 8 * 6 * 4; ++site) {
    const double value = site == 0 ? 1000000001 : 1e39;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  write("p.nrrd",
        "NRRD0004\ntype: double\ndimension: 3\nsizes: 8 6 4\nspace: RAS\n"
        "space directions: (0.5,0,0) (0,1,0) (0,0,2)\nspace origin: (1,1,1)\nendian: little\n"
        "encoding: raw\n\n" +
            bytes);
  run_well({"resample", "--fraction", "a=w.nrrd", "--fraction-scale", "255", "--rest", "b", "--field",
            "p=p.nrrd", "--cells", "-o", "m.vtu", "--json", "m.json"});
  EXPECT_TRUE(read_json("m.json")["fields"].contains("p"));
  run_well({"info", "--fraction", "a=w.nrrd", "--fraction-scale", "255", "--rest", "b", "--field", "p=p.nrrd",
            "--cells", "--json", "i.json"});
  EXPECT_EQ(read_json("i.json")["fields"][0]["min"], 1000000001.0);
  EXPECT_EQ(read_json("i.json")["fields"][0]["max"], 1e39);
}

}  // namespace
}  // namespace adamas::test
