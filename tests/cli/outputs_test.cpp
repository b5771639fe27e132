// Tests outputs that cannot be written and runs that are stopped: they leave nothing behind.

#include <unistd.h>

#include "program.h"

namespace adamas::test {

namespace {

class Outputs : public ProgramTest {};

TEST_F(Outputs, FolderMissing) {
  make_scene("sphere", 4);
  const std::vector<std::string> parts{"none/", "expected an existing output folder"};
  expect_failure({"resample", "scene.vtr", "-o", "none/m.vtu"}, parts);
  expect_failure({"resample", "scene.vtr", "-o", "m.vtu", "--json", "none/j.json"}, parts);
  expect_failure({"reconstruct", "scene.vtr", "-o", "none/r.vtp"}, parts);
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "none/s.png"}, parts);
  expect_failure({"probe", "scene.vtr", "--point", "0.5,0.5,0.5", "-o", "none/p.csv"}, parts);
  expect_failure({"generate", "scene", "sphere", "--dimensions", "4,4,4", "-o", "none/s.vtr"}, parts);
  expect_failure({"info", "scene.vtr", "--json", "none/j.json"}, parts);
}

TEST_F(Outputs, FolderReadOnly) {
  make_scene("sphere", 4);
  // Not even the superuser can make files in /proc.
  expect_failure({"resample", "scene.vtr", "--interface-error", "5%", "-o", "/proc/adamas-test.vtu"},
                 {"/proc/adamas-test.vtu"});
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "/proc/adamas-test.png"},
                 {"/proc/adamas-test.png"});
  expect_failure({"info", "scene.vtr", "--json", "/proc/adamas-test.json"}, {"/proc/adamas-test.json"});
}

TEST_F(Outputs, FolderWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may write anywhere";
  make_scene("sphere", 4);
  std::filesystem::create_directory(folder() / "locked");
  std::filesystem::permissions(folder() / "locked", std::filesystem::perms(0555));
  expect_failure({"resample", "scene.vtr", "-o", "locked/m.vtu"},
                 {"locked/m.vtu", "expected a writable output folder", "found locked read-only"});
}

TEST_F(Outputs, NameOfAFolderOrDevice) {
  make_scene("sphere", 4);
  std::filesystem::create_directory(folder() / "m.vtu");
  expect_failure({"resample", "scene.vtr", "-o", "m.vtu"},
                 {"m.vtu", "expected an output file", "found a folder"});
  std::filesystem::create_symlink("/dev/null", folder() / "null.json");
  expect_failure({"info", "scene.vtr", "--json", "null.json"}, {"null.json", "expected", "found"});
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Outputs, NoInputIsOverwritten) {
  make_scene("sphere", 4);
  run_well({"generate", "scene", "sphere", "--interfaces", "net.vtp"});
  run_well({"generate", "scene", "sphere", "--interfaces", "net.off"});
  run_well({"resample", "scene.vtr", "--interface-error", "9%", "-o", "m.vtu"});
  write("p.csv", "0.5,0.5,0.5\n");
  write("names.txt", "0 a\n");
  write("c.json", "threads = 1\n");
  std::filesystem::create_symlink("p.csv", folder() / "alias.csv");
  std::filesystem::create_directory(folder() / "sub");
  std::filesystem::copy(folder() / "scene.vtr", folder() / "sub/scene.vtr");
  write("sub/labels.vtp", "");
  const std::vector<std::vector<std::string>> commands{
      {"resample", "net.vtp", "--interfaces-out", "./net.vtp"},
      {"resample", "scene.vtr", "--interface", "net.off=outside,inside", "--interfaces-out", "net.off"},
      {"resample", "net.arec", "--region-names", "names.txt", "--interfaces-out", "names.txt"},
      {"resample", "sub/scene.vtr", "--fraction", "a=labels.vtp", "--interfaces-out", "sub/labels.vtp"},
      {"resample", "sub/scene.vtr", "--field", "a=labels.vtp", "--interfaces-out", "sub/labels.vtp"},
      {"reconstruct", "sub/scene.vtr", "--labels", "sub/labels.vtp", "-o", "sub/labels.vtp"},
      {"slice", "m.vtu", "--plane", "x=0.5", "--original", "net.vtp", "-o", "net.vtp"},
      {"probe", "scene.vtr", "--points-file", "p.csv", "-o", "p.csv"},
      {"probe", "scene.vtr", "--points-file", "alias.csv", "-o", "p.csv"},
      {"info", "scene.vtr", "--config", "c.json", "--json", "c.json"}};
  for (const auto& command : commands) {
    const std::string before = read(command.back());
    expect_wrong_usage(command, {"expected a file that is no input", command.back()});
    EXPECT_EQ(read(command.back()), before);
  }
  expect_wrong_usage({"info", "scene.vtr", "--json", "scene.vtr"}, {"--json", "expected", ".json"});
}

TEST_F(Outputs, NoFileThatAnInputRefersToIsOverwritten) {
  const std::string nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
  const std::string meta = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n";
  std::filesystem::create_directory(folder() / "sub");
  for (const char* name : {"d.adm", "d.vtp", "sub/d.adm", "d002.adm", "d03.adm"}) write(name, "12345678");
  write("one.nhdr", nrrd + "data file: d.adm\n");
  write("two.nhdr", nrrd + "datafile: ./d.vtp\n");
  write("sub/three.nhdr", nrrd + "data file: d.adm\n");
  write("list.nhdr", nrrd + "data file: LIST\nd.adm\nd.vtp\n");
  write("pattern.nhdr", nrrd + "data file: d%03d.adm 1 3 1\n");
  write("one.mhd", meta + "ElementDataFile = d.adm\n");
  write("list.mhd", meta + "ElementDataFile = LIST\nx.raw\nd.adm\n");
  write("pattern.mhd", meta + "ElementDataFile = d%02d.adm 3 9 3\n");
  const std::vector<std::vector<std::string>> commands{
      {"store", "one.nhdr", "-o", "d.adm"},
      {"store", "sub/three.nhdr", "-o", "sub/d.adm"},
      {"store", "list.nhdr", "-o", "d.adm"},
      {"store", "pattern.nhdr", "-o", "d002.adm"},
      {"store", "one.mhd", "-o", "./d.adm"},
      {"store", "list.mhd", "-o", "d.adm"},
      {"store", "pattern.mhd", "-o", "d03.adm"},
      {"slice", "two.nhdr", "--plane", "z=0.5", "-o", "d.vtp"},
      {"reconstruct", "two.nhdr", "--labels", "two.nhdr", "-o", "d.vtp"},
      {"resample", "one.nhdr", "--fraction", "a=two.nhdr", "--rest", "b", "--interfaces-out", "d.vtp"}};
  for (const auto& command : commands) {
    expect_wrong_usage(command, {"expected a file that is no input", command.back()});
    EXPECT_EQ(read(command.back().substr(command.back().starts_with("./") ? 2 : 0)), "12345678");
  }
  // A file whose name is only similar may be written.
  run_well({"store", "one.nhdr", "-o", "e.adm"});
}

TEST_F(Outputs, PatternsOfNamesThatHaveNoEnd) {
  for (const char* range :
       {"0 9223372036854775807 9223372036854775807",
        "-9223372036854775807 9223372036854775807 9223372036854775806", "0 1000000000 1"}) {
    write(
        "x.nhdr",
        std::string("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: x%d.raw ") +
            range + "\n");
    expect_failure({"store", "x.nhdr", "-o", "x.adm"}, {"x.nhdr"});
  }
}

/// An error of an output is not blamed on the input, even where the input's name is part of a word of the
/// message.
TEST_F(Outputs, AreNamedInTheirErrors) {
  make_scene("sphere", 6);
  std::filesystem::create_directory(folder() / "out");
  write("out/notes", "not ours");
  const RunResult result = run({"experiment", "scene.vtr", "-o", "out"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err.rfind("adamas: error: out: expected", 0), 0u) << result.err;
  write("a", "no data");
  expect_failure({"resample", "a", "-o", "m.vtu"}, {"error: a: expected"});
}

TEST_F(Outputs, DiskFull) {
  make_scene("sphere", 8);
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure({"generate", "scene", "sphere", "--dimensions", "12,12,12", "-o", "big.vtr"}, {"big.vtr"},
                 full);
  expect_failure({"resample", "scene.vtr", "--interface-error", "3%", "-o", "m.vtu"}, {"m.vtu"}, full);
  expect_failure({"reconstruct", "scene.vtr", "-o", "r.vtp"}, {"r.vtp"}, full);
  expect_failure({"reconstruct", "scene.vtr", "-o", "r.arec"}, {"r.arec"}, full);
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "s.png"}, {"s.png"}, full);
  expect_failure({"probe", "scene.vtr", "--line", "0,0,0..1,1,1,1000", "-o", "p.csv"}, {"p.csv"}, full);
}

TEST_F(Outputs, NoneOfSeveralUnlessAll) {
  make_scene("sphere", 8);
  // Either the mesh is below the limit and the interfaces after it are not, or the other way round.
  RunOptions full;
  full.file_size_limit = 20000;
  const auto before = files();
  const RunResult result = run({"resample", "scene.vtr", "--interface-error", "2%", "--interfaces-out",
                                "i.stl", "-o", "m.vtu", "--cut-mesh", "c.vtu", "--json", "j.json"},
                               full);
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(files(), before);
  run_well({"resample", "scene.vtr", "--interface-error", "2%", "--interfaces-out", "i.stl", "-o", "m.vtu",
            "--cut-mesh", "c.vtu", "--json", "j.json"});
  std::size_t fit = 0;
  for (const char* name : {"i.stl", "m.vtu", "c.vtu", "j.json"}) {
    if (std::filesystem::file_size(folder() / name) <= 20000) ++fit;
  }
  EXPECT_GE(fit, 1u);
  EXPECT_LT(fit, 4u);
}

TEST_F(Outputs, AnOldFileOutlivesAFailure) {
  make_scene("sphere", 8);
  write("m.vtu", "precious");
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure({"resample", "scene.vtr", "--interface-error", "3%", "-o", "m.vtu"}, {"m.vtu"}, full);
  EXPECT_EQ(read("m.vtu"), "precious");
}

TEST_F(Outputs, InterruptedRuns) {
  make_scene("voronoi10", 20);
  const auto before = files();
  for (const std::string stage : {"read", "reconstructing", "refining"}) {
    RunOptions stop;
    stop.interrupt_at = stage;
    const RunResult result = run({"resample", "scene.vtr", "--interface-error", "0.02%", "--verbose", "-o",
                                  "m.vtu", "--json", "j.json"},
                                 stop);
    EXPECT_EQ(result.status, 130) << stage << ": " << result.err;
    ASSERT_FALSE(result.err_lines().empty());
    EXPECT_EQ(result.err_lines().back(), "adamas: cancelled");
    EXPECT_EQ(result.err.find("error"), std::string::npos) << result.err;
    EXPECT_EQ(files(), before);
  }
}

TEST_F(Outputs, TheSecondInterruptEndsAtOnce) {
  make_scene("voronoi10", 20);
  const auto before = files();
  RunOptions stop;
  stop.interrupt_at = "reconstructing";
  stop.interrupts = 2;
  const RunResult result = run(
      {"resample", "scene.vtr", "--interface-error", "0.02%", "--verbose", "-o", "m.vtu", "--json", "j.json"},
      stop);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(files(), before);
}

TEST_F(Outputs, ClosedPipe) {
  make_scene("sphere", 6);
  RunOptions closed;
  closed.close_stdout = true;
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info", "scene.vtr"},
           {"--help"},
           {"probe", "scene.vtr", "--line", "0,0,0..1,1,1,5000"},
           {"resample", "scene.vtr", "-o", "m.vtu", "--interface-error", "5%"}}) {
    const RunResult result = run(command, closed);
    EXPECT_EQ(result.status, 0) << command[0] << ": " << result.err;
    EXPECT_EQ(result.err, "");
  }
  EXPECT_TRUE(files().contains("m.vtu"));
}

}  // namespace

}  // namespace adamas::test
