// Tests what the commands on stores refuse, and that nothing is left behind then.

#include "store_test.h"

namespace adamas::test {

namespace {

class StoreFailures : public StoreTest {};

TEST_F(StoreFailures, WrongUsageOfStore) {
  make_ball("10");
  expect_wrong_usage({"store"}, {"expected INPUT"});
  expect_wrong_usage({"store", "ball.nhdr"}, {"--output"});
  expect_wrong_usage({"store", "ball.nhdr", "-o", "b.txt"}, {"ends in .adm", "b.txt"});
  expect_wrong_usage({"store", "ball.nhdr", "ball.nhdr", "--stack", "-o", "b.adm"},
                     {"--stack", "one pattern", "2"});
  const auto refused = [this](const std::vector<std::string>& more, const std::vector<std::string>& parts) {
    std::vector<std::string> all{"store", "ball.raw", "-o", "b.adm"};
    all.insert(all.end(), more.begin(), more.end());
    expect_wrong_usage(all, parts);
  };
  refused({"--dimensions", "10"}, {"--dimensions", "expected --type"});
  refused({"--type", "uint8"}, {"--type", "expected --dimensions"});
  refused({"--endian", "big"}, {"--endian", "expected --dimensions"});
  refused({"--spacing", "1,1,1"}, {"--spacing", "expected --dimensions or --stack"});
  refused({"--dimensions", "0", "--type", "uint8"}, {"--dimensions", "at least 1", "'0'"});
  refused({"--dimensions", "10", "--type", "int5"}, {"--type", "uint8, int8", "'int5'"});
  refused({"--dimensions", "10", "--type", "uint8", "--spacing", "1,0,1"},
          {"--spacing", "positive", "1,0,1"});
  refused({"--dimensions", "10", "--type", "uint8", "--spacing", "1,nan,1"}, {"--spacing", "finite"});
  refused({"--dimensions", "10", "--type", "uint8", "--header-bytes=-1"}, {"--header-bytes", "'-1'"});
  refused({"--dimensions", "10", "--type", "uint8", "--stack"}, {"--stack and --dimensions"});
  refused({"--dimensions", "10", "--type", "uint8", "--array", "a"}, {"--array", "not --dimensions"});
  refused({"--coding", "zip"}, {"--coding", "interpolation, split-edge or none", "'zip'"});
  expect_wrong_usage({"store", "ball.nhdr", "--array", "a", "-o", "b.adm"}, {"--array", "ball.nhdr"});
  std::filesystem::copy(folder() / "ball.raw", folder() / "raw.adm");
  expect_wrong_usage({"store", "raw.adm", "--dimensions", "10", "--type", "uint8", "-o", "raw.adm"},
                     {"expected a file that is no input", "raw.adm"});
}

TEST_F(StoreFailures, WrongUsageOfReaders) {
  make_ball("10");
  make_store();
  expect_wrong_usage({"restore", "b.adm"}, {"--output"});
  expect_wrong_usage({"restore", "b.adm", "-o", "r.tif"}, {"ends in .vti", "r.tif"});
  expect_wrong_usage({"restore", "b.adm", "-o", "r.raw", "--level=-1"}, {"--level", "'-1'"});
  expect_wrong_usage({"restore", "b.adm", "-o", "r.raw", "--region", "3,2,0,1,0,1"}, {"--region", "x0 < x1"});
  for (const std::string memory : {"0", "-1", "x", "1X", "1e9", "99999999999G"})
    expect_wrong_usage({"verify", "b.adm", "--memory=" + memory}, {"--memory", memory});
  expect_wrong_usage({"verify", "b.adm", "--paging", "swap"}, {"--paging", "read or map", "'swap'"});
  std::filesystem::copy(folder() / "b.adm", folder() / "b.raw");
  expect_wrong_usage({"restore", "b.raw", "-o", "b.raw"}, {"expected a file that is no input", "b.raw"});
  expect_wrong_usage({"restore", "b.raw", "-o", "b.nhdr"}, {"expected a file that is no input", "b.raw"});
  expect_wrong_usage({"info", "b.adm", "--rest", "a"}, {"--rest"});
  expect_wrong_usage({"slice", "b.adm", "-o", "s.png"}, {"--plane"});
  expect_wrong_usage({"slice", "b.adm", "--plane", "x=1", "--rest", "a", "-o", "s.png"}, {"--rest", "b.adm"});
  expect_wrong_usage({"slice", "b.adm", "--plane", "x=1", "--mode", "all", "-o", "s.png"}, {"--mode all"});
  expect_wrong_usage({"slice", "b.adm", "--plane", "x=1", "--original", "ball.nhdr", "-o", "s.png"},
                     {"--original"});
}

TEST_F(StoreFailures, WrongUsageOfIsosurface) {
  make_ball("10");
  make_store();
  const auto refused = [this](const std::vector<std::string>& more, const std::vector<std::string>& parts) {
    std::vector<std::string> all{"isosurface", "b.adm"};
    all.insert(all.end(), more.begin(), more.end());
    expect_wrong_usage(all, parts);
  };
  refused({"-o", "s.ply"}, {"--isovalue"});
  refused({"--isovalue", "5"}, {"expected -o, --picture or --json"});
  refused({"--isovalue", "5", "-o", "s.png"}, {"ends in .ply", "s.png"});
  refused({"--isovalue", "5", "--picture", "s.ply"}, {"ends in .png", "s.ply"});
  for (const std::string value : {"nan", "inf", "x", "1,2", "1e999"})
    refused({"--isovalue", value, "-o", "s.ply"}, {"--isovalue", "a finite number", value});
  refused({"--isovalue", "5", "--isovalue", "5.0", "-o", "s.ply"}, {"--isovalue", "5 twice"});
  for (const std::string error : {"-1", "nan", "voxels", "%", "1 mm", "-0.5voxels", "1%voxels"})
    refused({"--isovalue", "5", "-o", "s.ply", "--error=" + error}, {"--error", "of at least 0", error});
  for (const std::string count : {"0", "-5", "1e6", "x"})
    refused({"--isovalue", "5", "-o", "s.ply", "--max-triangles=" + count}, {"--max-triangles", count});
  refused({"--isovalue", "5", "-o", "s.ply", "--region", "0,0,0,1,0,1"}, {"--region", "x0 < x1"});
  refused({"--isovalue", "5", "--picture", "s.png", "--direction", "0,0,0"}, {"--direction"});
}

TEST_F(StoreFailures, InputThatIsNone) {
  make_ball("10");
  make_store();
  run_well({"store", "ball.raw", "--dimensions", "1000,1,1", "--type", "uint8", "-o", "line.adm"});
  write("empty.adm", "");
  std::filesystem::create_directory(folder() / "folder.adm");
  for (const std::string name : {"none.adm", "empty.adm", "folder.adm", "ball.nhdr"}) {
    expect_failure({"verify", name, "--json", "f.json"}, {name, "expected", "found"});
    expect_failure({"restore", name, "-o", "r.raw"}, {name, "expected", "found"});
    expect_failure({"isosurface", name, "--isovalue", "5", "-o", "s.ply"}, {name, "expected", "found"});
    if (name == "ball.nhdr") {
      expect_failure({"verify", name}, {"adamas store makes one of a volume"});
      continue;
    }
    expect_failure({"info", name}, {name, "expected", "found"});
    expect_failure({"slice", name, "--plane", "x=1", "-o", "s.png"}, {name, "expected", "found"});
  }
  expect_failure({"store", "b.adm", "-o", "c.adm"}, {"b.adm", "expected a volume", "found '.adm'"});
  expect_failure({"store", "none.nrrd", "-o", "c.adm"}, {"none.nrrd"});
  expect_failure({"store", "*.tif", "--stack", "-o", "c.adm"}, {"*.tif", "expected", "found none"});
  expect_failure({"store", "ball.raw", "--dimensions", "11", "--type", "uint8", "-o", "c.adm"},
                 {"ball.raw", "expected 1331 bytes", "found 1000"});
  expect_failure({"slice", "b.adm", "--plane", "x=50", "-o", "s.png"}, {"b.adm", "expected a plane", "x=50"});
  expect_failure({"slice", "b.adm", "--plane", "x=5", "--field", "none", "-o", "s.png"},
                 {"b.adm", "value", "found 'none'"});
  expect_failure({"slice", "line.adm", "--plane", "x=5", "-o", "s.png"},
                 {"line.adm", "two samples", "found 1"});
  expect_failure({"isosurface", "line.adm", "--isovalue", "5", "-o", "s.ply"},
                 {"line.adm", "two samples", "found 1"});
  expect_failure({"isosurface", "b.adm", "--isovalue", "5", "--region", "20,30,0,1,0,1", "-o", "s.ply"},
                 {"b.adm", "expected a region in [0, 9]", "found [20, 30]"});
  expect_failure({"restore", "b.adm", "--region", "20,30,0,1,0,1", "-o", "r.raw"},
                 {"b.adm", "expected a region", "found none along x"});
  expect_failure({"restore", "b.adm", "--level", "2", "-o", "r.raw"}, {"b.adm", "from 0 to 1", "found 2"});
}

TEST_F(StoreFailures, MoreSamplesThanAStoreMayHave) {
  write("long.raw", std::string(262146, 'a'));
  expect_failure({"store", "long.raw", "--dimensions", "262146,1,1", "--type", "uint8", "-o", "b.adm"},
                 {"long.raw", "expected at most 262145 samples", "found 262146"});
}

TEST_F(StoreFailures, SamplesThatAreNoNumbersAreTold) {
  write_image("a.nrrd", 5, [](std::size_t i) {
    return i % 50 == 7 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i);
  });
  const RunResult result = run({"store", "a.nrrd", "-o", "a.adm"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "adamas: note: a.nrrd: 3 samples are not finite: surfaces have holes there\n");
  run_well({"restore", "a.adm", "-o", "r.raw"});
  EXPECT_EQ(read("a.nrrd").substr(read("a.nrrd").size() - 500), read("r.raw"));
}

TEST_F(StoreFailures, ConvertedSamplesAreCountedOnce) {
  std::string samples;
  for (std::int32_t i = 0; i < 1000; ++i) {
    const std::int32_t value = (1 << 24) + i;
    samples.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  write("a.raw", samples);
  // What samples show otherwise is told, but not with --quiet, since the store keeps all digits.
  for (const bool quiet : {false, true}) {
    std::vector<std::string> store{"store",  "a.raw", "--dimensions", "10",
                                   "--type", "int32", "-o",           quiet ? "q.adm" : "a.adm"};
    if (quiet) store.push_back("--quiet");
    const RunResult result = run(store);
    EXPECT_EQ(result.status, 0);
    const std::string note = "int32 samples are read as float32, 500 of them changed, by at most 1";
    EXPECT_EQ(result.err.find(note) != std::string::npos, !quiet) << result.err;
  }
}

/// Where samples of many inputs have fewer digits, only the worst one is reported.
TEST_F(StoreFailures, ChangedSamplesOfManyStepsAreOneLine) {
  for (int n = 0; n < 4; ++n) {
    std::string samples;
    for (std::int32_t i = 0; i < 8; ++i) {
      const std::int32_t value = (1 << (24 + n)) + i;
      samples.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    write("s_" + std::to_string(n) + ".raw", samples);
  }
  const RunResult result = run({"store", "s_%d.raw", "--dimensions", "2", "--type", "int32", "-o", "s.adm"});
  EXPECT_EQ(result.status, 0);
  const std::string told = "int32 samples are read as float32";
  EXPECT_EQ(result.err.find(told), result.err.rfind(told)) << result.err;
  EXPECT_NE(result.err.find("s_3.raw: int32 samples are read as float32"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("; and 3 more steps"), std::string::npos) << result.err;
}

TEST_F(StoreFailures, DiskFull) {
  make_ball("40");
  make_store();
  write("one.raw", "a");
  RunOptions full;
  full.file_size_limit = 3000;
  std::filesystem::create_directory(folder() / "scratch");
  // Except for the smallest volumes the scratch data are larger than the store.
  expect_failure({"store", "ball.nhdr", "--scratch", "scratch", "-o", "c.adm"}, {"error: scratch: ", "bytes"},
                 full);
  expect_failure({"restore", "b.adm", "-o", "r.vti"}, {"r.vti"}, full);
  expect_failure({"restore", "b.adm", "-o", "r.nhdr"}, {"r.raw"}, full);
  for (const std::string name : {"s.ply", "s.stl", "s.obj", "s.vtp", "s.glb", "s.gltf"})
    expect_failure({"isosurface", "b.adm", "--isovalue", "80", "-o", name}, {name}, full);
  expect_failure({"isosurface", "b.adm", "--isovalue", "80", "--picture", "s.png"}, {"s.png"}, full);
  expect_failure({"slice", "b.adm", "--plane", "x=9", "-o", "s.png"}, {"s.png"}, full);
  full.file_size_limit = 100;
  expect_failure({"store", "one.raw", "--dimensions", "1", "--type", "uint8", "-o", "c.adm"},
                 {"c.adm", "is the disk full?"}, full);
  expect_failure({"store", "ball.nhdr", "--scratch", "none", "-o", "c.adm"},
                 {"none", "expected a folder for temporary files that can be written"});
  expect_failure({"store", "ball.nhdr", "-o", "none/c.adm"}, {"none", "expected an existing output folder"});
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "scratch"));
}

TEST_F(StoreFailures, InterruptedRuns) {
  make_ball("120");
  make_store();
  std::filesystem::create_directory(folder() / "scratch");
  const auto before = files();
  const auto stopped = [&](const std::vector<std::string>& command, const std::string& stage,
                           int interrupts) {
    RunOptions stop;
    stop.interrupt_at = stage;
    stop.interrupts = interrupts;
    std::vector<std::string> all = command;
    all.push_back("--verbose");
    const RunResult result = run(all, stop);
    EXPECT_EQ(result.status, 130) << command[0] << " " << stage << ": " << result.err;
    EXPECT_EQ(files(), before) << command[0] << " " << stage;
  };
  const std::vector<std::string> store{"store", "ball.nhdr", "--scratch", "scratch",
                                       "-o",    "c.adm",     "--json",    "f.json"};
  for (const std::string stage : {"preprocessing", "surveying", "compressing"}) stopped(store, stage, 1);
  stopped(store, "compressing", 2);
  stopped({"verify", "b.adm", "--json", "f.json"}, "verifying", 1);
  stopped({"restore", "b.adm", "-o", "r.nhdr"}, "restoring", 1);
  stopped({"isosurface", "b.adm", "--isovalue", "80", "-o", "s.ply"}, "extracting", 1);
}

}  // namespace

}  // namespace adamas::test
