// Tests standard output that cannot be written: there is an error, and no output file under its name.

#include "program.h"

namespace adamas::test {

namespace {

/// Returns two ways in which standard output fails: a full disk, and no stream at all.
std::vector<RunOptions> refusals() {
  std::vector<RunOptions> all(2);
  all[0].stdout_file = "/dev/full";
  all[1].no_stdout = true;
  return all;
}

class StandardOutput : public ProgramTest {
 protected:
  StandardOutput() { make_scene("sphere", 6); }
  void expect_refused(const std::vector<std::string>& arguments) const {
    for (const RunOptions& options : refusals())
      expect_failure(arguments, {"standard output: could not be written: "}, options);
  }
};

TEST_F(StandardOutput, Texts) {
  expect_refused({"info", "scene.vtr"});
  // This is more than a buffer holds, so that only the last part would be lost.
  expect_refused({"probe", "scene.vtr", "--line", "0,0,0..1,1,1,5000"});
  expect_refused({"man"});
  expect_refused({"completion", "bash"});
  expect_refused({"--version"});
  expect_refused({"--help"});
  expect_refused({"resample", "--help"});
}

TEST_F(StandardOutput, ALimitOfTheSizeOfFiles) {
  write("printed", "");
  RunOptions limited;
  limited.stdout_file = (folder() / "printed").string();
  limited.file_size_limit = 100;
  for (const std::vector<std::string>& text :
       std::vector<std::vector<std::string>>{{"man"}, {"completion", "bash"}, {"--help"}})
    expect_failure(text, {"standard output: could not be written: "}, limited);
}

TEST_F(StandardOutput, FilesGetNoName) {
  run_well({"generate", "buckyball", "--dimensions", "8", "-o", "ball.nrrd"});
  run_well({"store", "ball.nrrd", "-o", "ball.adm"});
  const std::vector<std::vector<std::string>> commands{
      {"info", "scene.vtr", "--json", "j.json"},
      {"generate", "buckyball", "--dimensions", "8", "-o", "other.nrrd"},
      {"store", "ball.nrrd", "-o", "other.adm"},
      {"restore", "ball.adm", "-o", "other.vti"},
      {"isosurface", "ball.adm", "--isovalue", "80", "-o", "s.ply"},
      {"slice", "scene.vtr", "--plane", "z=0.5", "-o", "s.png"},
      {"reconstruct", "scene.vtr", "-o", "r.ply"},
      {"resample", "scene.vtr", "--interface-error", "5%", "-o", "m.vtu"}};
  for (const auto& command : commands) expect_refused(command);
  const std::set<std::string> before = files();
  for (const RunOptions& options : refusals()) {
    const RunResult result = run({"experiment", "scene.vtr", "--interface-error", "5%", "-o", "e"}, options);
    EXPECT_EQ(result.status, 1) << result.err;
  }
  EXPECT_EQ(files(), before);
}

}  // namespace

}  // namespace adamas::test
