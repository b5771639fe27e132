// Tests how signals end a run, and that neither files nor processes are left behind.

#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "program.h"

namespace adamas::test {

namespace {

const std::vector<std::string> kResample{
    "resample", "scene.vtr", "--interface-error", "0.02%", "--verbose", "-o", "m.vtu", "--json", "j.json"};

class Signals : public ProgramTest {
 protected:
  Signals() { make_scene("sphere", 12); }
  ~Signals() override { unsetenv("ADAMAS_REFERENCE_PROGRAM"); }

  [[nodiscard]] bool has_partial_files() const {
    const auto names = files();
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.find(".partial-") != std::string::npos; });
  }
  /// Runs the program, and calls `act` as soon as stderr has the text.
  [[nodiscard]] RunResult run_until(const std::vector<std::string>& command, const std::string& text,
                                    const std::function<void(pid_t)>& act) const {
    RunOptions options;
    options.interrupt_at = text;
    options.act = act;
    return run(command, options);
  }
  void kill_at(const std::vector<std::string>& command, const std::string& text) const {
    const RunResult result = run_until(command, text, [](pid_t program) { kill(program, SIGKILL); });
    EXPECT_EQ(result.status, 1000 + SIGKILL) << result.err;
  }
};

TEST_F(Signals, EachStopsTheRun) {
  const auto before = files();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    const RunResult result =
        run_until(kResample, "refining", [number](pid_t program) { kill(program, number); });
    EXPECT_EQ(result.status, 130) << number << result.err;
    EXPECT_EQ(result.err_lines().back(), "adamas: cancelled") << number;
    EXPECT_EQ(files(), before) << number;
  }
}

/// A signal ends the run also while the program's libraries are loaded.
TEST_F(Signals, StopTheRunFromItsStart) {
  const auto before = files();
  const std::array<int, 4> numbers{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  for (unsigned time = 0; time < 40; ++time) {
    const int number = numbers[time % numbers.size()];
    RunOptions options;
    options.interrupt_when = [] { return true; };
    options.act = [&](pid_t program) {
      wait_until_deferred(program, number);
      usleep(1500 * time);
      kill(program, number);
    };
    const RunResult result =
        run({"resample", "scene.vtr", "--interface-error", "0.02%", "-o", "m.vtu"}, options);
    EXPECT_EQ(result.status, 130) << time << result.err;
    EXPECT_EQ(result.err, "adamas: cancelled\n") << time;
    EXPECT_EQ(files(), before) << time;
  }
}

TEST_F(Signals, ASecondOneOfAnyKindEndsItAtOnce) {
  const auto before = files();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    const RunResult result = run_until(kResample, "refining", [number](pid_t program) {
      // The program is stopped, so that both signals are pending before it goes on.
      kill(program, SIGSTOP);
      wait_until_stopped(program);
      kill(program, SIGINT);
      kill(program, number == SIGINT ? SIGTERM : number);
      kill(program, SIGCONT);
    });
    EXPECT_EQ(result.status, 130) << number << result.err;
    EXPECT_EQ(result.err.find("cancelled"), std::string::npos) << number;
    EXPECT_EQ(files(), before) << number;
  }
}

/// Programs that are started by nohup ignore SIGHUP.
TEST_F(Signals, ThoseThatAreIgnoredStayIgnored) {
  RunOptions options;
  options.interrupt_at = "refining";
  options.act = [](pid_t program) { kill(program, SIGHUP); };
  options.ignored = SIGHUP;
  const RunResult result =
      run({"resample", "scene.vtr", "--interface-error", "4%", "--verbose", "-o", "m.vtu"}, options);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(files().contains("m.vtu"));
}

TEST_F(Signals, TheNextRunRemovesWhatAKilledOneLeft) {
  const auto before = files();
  write(".partial-notes", "not ours");
  write(".partial-abcdef", "of six letters, but not empty");
  write(".partial-abcdef-1.vtu", "and so not ours either");
  kill_at(kResample, "refining");
  EXPECT_TRUE(has_partial_files());
  EXPECT_GT(files().size(), before.size() + 3);
  run_well({"resample", "scene.vtr", "--interface-error", "4%", "-o", "m.vtu"});
  auto wanted = before;
  wanted.insert({"m.vtu", ".partial-notes", ".partial-abcdef", ".partial-abcdef-1.vtu"});
  EXPECT_EQ(files(), wanted);
}

TEST_F(Signals, TheNextRunRemovesTheFolderOfAKilledExperiment) {
  const auto before = files();
  const std::vector<std::string> experiment{
      "experiment",        "--generate", "sphere",    "--dimensions", "8",
      "--interface-error", "4%",         "--verbose", "-o",           "e"};
  kill_at(experiment, "writing mesh-interfaces");
  EXPECT_TRUE(has_partial_files());
  EXPECT_FALSE(files().contains("e"));
  EXPECT_EQ(run(experiment).status, 0);
  EXPECT_TRUE(files().contains("e/report.html"));
  EXPECT_FALSE(has_partial_files());
  std::filesystem::remove_all(folder() / "e");
  const RunResult stopped = run_until(experiment, "writing mesh-interfaces", [](pid_t program) {
    kill(program, SIGSTOP);
    wait_until_stopped(program);
    for (const int number : {SIGINT, SIGTERM, SIGCONT}) kill(program, number);
  });
  EXPECT_EQ(stopped.status, 130);
  EXPECT_EQ(files(), before);
}

TEST_F(Signals, RunsAtTheSameTimeLeaveEachOtherAlone) {
  const RunResult first =
      run_until({"resample", "scene.vtr", "--interface-error", "2%", "--verbose", "-o", "m.vtu"}, "refining",
                [this](pid_t program) {
                  kill(program, SIGSTOP);
                  wait_until_stopped(program);
                  EXPECT_TRUE(has_partial_files());
                  const auto before = files();
                  run_well({"resample", "scene.vtr", "--interface-error", "4%", "-o", "other.vtu"});
                  auto wanted = before;
                  wanted.insert("other.vtu");
                  EXPECT_EQ(files(), wanted);
                  kill(program, SIGCONT);
                });
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_TRUE(files().contains("m.vtu"));
  EXPECT_FALSE(has_partial_files());
}

#ifdef ADAMAS_REFERENCE_PROGRAM
/// Processes that another mesher has started end with it, also where the run ends at once.
TEST_F(Signals, ComparisonsLeaveNoProcesses) {
  make_scene("sphere", 6);
  write("mesher", "#!/bin/sh\nsleep 1000 &\necho $! > started\nmv started pid\nwait\n");
  chmod((folder() / "mesher").c_str(), 0755);
  setenv("ADAMAS_REFERENCE_PROGRAM", (folder() / "mesher").c_str(), 1);
  for (const bool at_once : {false, true}) {
    std::filesystem::remove(folder() / "pid");
    RunOptions options;
    options.interrupt_when = [this] { return std::filesystem::exists(folder() / "pid"); };
    options.act = [at_once](pid_t program) {
      kill(program, SIGSTOP);
      wait_until_stopped(program);
      kill(program, SIGINT);
      if (at_once) kill(program, SIGTERM);
      kill(program, SIGCONT);
    };
    const RunResult result =
        run({"compare", "scene.vtr", "--interface-error", "15%", "--json", "f.json"}, options);
    EXPECT_EQ(result.status, 130) << result.err;
    const int started = std::stoi(read("pid"));
    wait_until_gone(started);
    EXPECT_FALSE(is_running(started));
  }
  // Where nothing can be printed the run ends before it starts a mesher.
  std::filesystem::remove(folder() / "pid");
  RunOptions full;
  full.stdout_file = "/dev/full";
  const RunResult result = run({"compare", "scene.vtr", "--interface-error", "15%"}, full);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "pid"));
  EXPECT_FALSE(has_partial_files());
}
#endif

}  // namespace

}  // namespace adamas::test
