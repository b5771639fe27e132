#include <sys/stat.h>

#include <bit>
#include <cstdint>
#include <cstdlib>

#include "program.h"

namespace adamas::test {
namespace {

class Verification : public ProgramTest {
 protected:
  ~Verification() override { unsetenv("ADAMAS_REFERENCE_PROGRAM"); }

  /// Puts a shell script in the place of adamas-reference.
  void replace_program(const std::string& body) const {
    write("verifier", "#!/bin/sh\n" + body + "\n");
    chmod((folder() / "verifier").c_str(), 0755);
    setenv("ADAMAS_REFERENCE_PROGRAM", (folder() / "verifier").c_str(), 1);
  }
  /// Makes adamas-reference answer with this distance, whatever it is asked.
  void answer(double lower, double upper) const {
    std::string reply = "adamdit1" + std::string(8, '\0');
    for (const double figure : {lower, upper}) {
      const auto bits = std::bit_cast<std::uint64_t>(figure);
      for (int byte = 0; byte < 8; ++byte) reply.push_back(static_cast<char>(bits >> (8 * byte) & 0xff));
    }
    write("reply", reply);
    replace_program("cat " + (folder() / "reply").string());
  }
  [[nodiscard]] static std::vector<std::string> resample() {
    return {"resample", "scene.vtr", "--interface-error", "3%", "--verify-by", "cgal", "--json", "f.json"};
  }
};

TEST_F(Verification, StandsBesideTheCertifiedError) {
  for (const char* scene : {"sphere", "tjunction"}) {
    make_scene(scene);
    const std::string out = run_well(resample()).out;
    EXPECT_NE(out.find(" (certified), CGAL: "), std::string::npos) << out;
    const nlohmann::json figures = read_json("f.json");
    const auto& by_cgal = figures["interface_error_by_cgal"];
    const double lower = by_cgal["lower"], upper = by_cgal["upper"],
                 target = figures["interface_error_target"];
    EXPECT_LE(lower, figures["interface_error"].get<double>());
    EXPECT_GE(upper, figures["interface_error_measured"].get<double>());
    EXPECT_LE(upper - lower, 0.0101 * target);
    EXPECT_GT(by_cgal["seconds"], 0);
  }
  run_well({"resample", "scene.vtr", "--interface-error", "3%", "--json", "f.json"});
  EXPECT_FALSE(read_json("f.json").contains("interface_error_by_cgal"));
}

TEST_F(Verification, ContradictionsAreNoted) {
  make_scene("sphere");
  run_well(resample());
  const nlohmann::json figures = read_json("f.json");
  const double certified = figures["interface_error"], found = figures["interface_error_measured"];
  for (const auto& [lower, upper, contradicts] :
       {std::tuple{1.01 * certified, 1.02 * certified, true}, std::tuple{0.9 * found, 0.99 * found, true},
        std::tuple{0.9 * found, 1.1 * certified, false}}) {
    answer(lower, upper);
    const RunResult result = run(resample());
    EXPECT_EQ(result.status, contradicts ? 3 : 0);
    EXPECT_EQ(result.err.find("they contradict each other") != std::string::npos, contradicts) << result.err;
    EXPECT_EQ(read_json("f.json")["interface_error_by_cgal"]["upper"], upper);
  }
}

TEST_F(Verification, FailuresAreTold) {
  make_scene("sphere", 6);
  setenv("ADAMAS_REFERENCE_PROGRAM", "/nowhere/adamas-reference", 1);
  expect_failure(resample(), {"ADAMAS_REFERENCE_PROGRAM", "/nowhere/adamas-reference"});
  replace_program("echo oh >&2; kill -SEGV $$");
  expect_failure(resample(), {"adamas-reference was ended by signal 11", "oh"});
  expect_wrong_usage({"resample", "scene.vtr", "--verify-by", "eye", "--json", "f.json"}, {"--verify-by"});
  expect_wrong_usage({"resample", "scene.vtr", "scene.vtr", "--verify-by", "cgal", "--json", "f.json"},
                     {"--verify-by", "series"});
}

TEST_F(Verification, EndsTheProgramWhenItIsCancelled) {
  make_scene("sphere", 6);
  replace_program("echo $$ > started\nmv started pid\nexec sleep 1000");
  RunOptions options;
  options.interrupt_when = [this] { return std::filesystem::exists(folder() / "pid"); };
  EXPECT_EQ(run(resample(), options).status, 130);
  wait_until_gone(std::stoi(read("pid")));
  EXPECT_FALSE(std::filesystem::exists(folder() / "f.json"));
}

}  // namespace
}  // namespace adamas::test
