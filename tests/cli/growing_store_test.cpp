// Tests the appending of steps to stores: only one run at a time does it, and it reports what it does.

#include <signal.h>
#include <unistd.h>

#include "tests/cli/series_stores.h"

namespace adamas::test {
namespace {

class GrowingStores : public SeriesStores {
 protected:
  GrowingStores() { run_well(store({file(0), file(1)}, "a.adm")); }

  /// Returns the arguments of `store --append` with a number of steps.
  static std::vector<std::string> adding(std::size_t steps, const std::vector<std::string>& more = {},
                                         const std::string& to = "a.adm") {
    std::vector<std::string> inputs;
    for (std::size_t n = 0; n < steps; ++n) inputs.push_back(file(static_cast<int>((n + 2) % 5)));
    std::vector<std::string> options{"--append"};
    options.insert(options.end(), more.begin(), more.end());
    return store(inputs, to, options);
  }
  /// Returns options to call `act` as soon as a block of steps is finished in a.adm.
  [[nodiscard]] RunOptions when_a_block_is_finished(const std::function<void(pid_t)>& act) const {
    RunOptions options;
    options.interrupt_when = [this, before = read("a.adm").substr(0, 40)] {
      return read("a.adm").substr(0, 40) != before;
    };
    options.act = act;
    return options;
  }
};

TEST_F(GrowingStores, OneRunAtATimeAddsSteps) {
  const RunResult first =
      run(adding(200, {"--block-steps", "4", "-q"}), when_a_block_is_finished([&](pid_t program) {
            kill(program, SIGSTOP);
            wait_until_stopped(program);
            expect_failure(adding(1), {"a.adm", "another at work"});
            // A reader finds the steps that are finished.
            EXPECT_GT(info("a.adm")["steps"], 2);
            kill(program, SIGCONT);
          }));
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(info("a.adm")["steps"], 202);
  run_well({"verify", "a.adm", "-q"});
  for (const int step : {0, 7, 113, 201}) {
    run_well({"restore", "a.adm", "--step", std::to_string(step), "-o", "out.raw", "-q"});
    EXPECT_EQ(read("out.raw"), samples(step % 5)) << step;
  }
}

TEST_F(GrowingStores, ARunThatWasKilledIsNotInTheWay) {
  const RunResult killed = run(adding(200, {"--block-steps", "4", "-q"}),
                               when_a_block_is_finished([](pid_t program) { kill(program, SIGKILL); }));
  EXPECT_EQ(killed.status, 1000 + SIGKILL);
  const std::size_t steps = info("a.adm")["steps"];
  run_well(adding(1, {"-q"}));
  EXPECT_EQ(info("a.adm")["steps"], steps + 1);
  run_well({"verify", "a.adm", "-q"});
}

/// Two runs begin while there is no store; the store that is finished first stays.
TEST_F(GrowingStores, AStoreThatWasMadeMeanwhileStays) {
  RunOptions options;
  options.interrupt_at = "compressing";
  options.act = [&](pid_t program) {
    kill(program, SIGSTOP);
    wait_until_stopped(program);
    run_well(store({file(3)}, "new.adm", {"--append"}));
    kill(program, SIGCONT);
  };
  // The late run has much left to do when it is stopped.
  const RunResult late = run(adding(200, {"--block-steps", "4", "--verbose"}, "new.adm"), options);
  EXPECT_EQ(late.status, 1);
  EXPECT_NE(late.err.find("error: new.adm: expected no store there"), std::string::npos) << late.err;
  EXPECT_EQ(info("new.adm")["steps"], 1);
  run_well({"restore", "new.adm", "-o", "out.raw", "-q"});
  EXPECT_EQ(read("out.raw"), samples(3));
}

TEST_F(GrowingStores, ARunThatEndsEarlySaysHowManyStepsItHasAdded) {
  const auto check = [this](const RunResult& result, const std::string& before, std::size_t steps,
                            std::size_t all) {
    const std::size_t at = result.err.find(before);
    ASSERT_NE(at, std::string::npos) << result.err;
    const std::size_t added = std::stoul(result.err.substr(at + before.size()));
    EXPECT_NE(result.err.find("of " + std::to_string(all) + " steps were added"), std::string::npos)
        << result.err;
    EXPECT_GT(added, 0u);
    EXPECT_LT(added, all);
    EXPECT_EQ(info("a.adm")["steps"], steps + added);
  };
  const RunResult cancelled = run(adding(300, {"--block-steps", "4"}),
                                  when_a_block_is_finished([](pid_t program) { kill(program, SIGINT); }));
  EXPECT_EQ(cancelled.status, 130);
  check(cancelled, "adamas: cancelled; ", 2, 300);
  run_well({"verify", "a.adm", "-q"});
  write("short.raw", "123");
  const std::size_t steps = info("a.adm")["steps"];
  const RunResult failed =
      run(store({file(0), file(1), file(2), "short.raw"}, "a.adm", {"--append", "--block-steps", "1", "-q"}));
  EXPECT_EQ(failed.status, 1);
  EXPECT_EQ(failed.err_lines().size(), 1u) << failed.err;
  check(failed, "found 3; ", steps, 4);
}

/// The figures are those of the added steps, and they add up; those of the whole file are separate.
TEST_F(GrowingStores, FiguresAreThoseOfTheStepsAdded) {
  const std::size_t before = read("a.adm").size();
  const RunResult result = run(adding(3, {"--json", "j.json"}));
  EXPECT_EQ(result.status, 0) << result.err;
  const auto found = read_json("j.json");
  EXPECT_EQ(found["steps"], 3);
  EXPECT_EQ(found["steps_file"], 5);
  EXPECT_EQ(found["bytes_input"], 3 * 729);
  EXPECT_EQ(found["bytes_file"], read("a.adm").size());
  EXPECT_EQ(found["bytes_added"], read("a.adm").size() - before);
  EXPECT_DOUBLE_EQ(found["ratio"], 3 * 729.0 / static_cast<double>(read("a.adm").size() - before));
  EXPECT_NE(result.out.find("3 steps added"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("a.adm has 5 steps now"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("file "), std::string::npos) << result.out;
}

TEST_F(GrowingStores, OptionsThatContradictTheStoreAreRefused) {
  const std::string before = read("a.adm");
  expect_wrong_usage(adding(1, {"--gradients"}), {"--gradients", "a.adm has none"});
  expect_wrong_usage(adding(1, {"--group-pages", "8"}),
                     {"--group-pages: expected 1, as a.adm has", "found 8"});
  expect_wrong_usage(adding(1, {"--coding", "split-edge"}),
                     {"--coding: expected interpolation, as a.adm has", "found split-edge"});
  EXPECT_EQ(read("a.adm"), before);
  for (const std::vector<std::string>& same :
       {std::vector<std::string>{"--coding", "interpolation", "--group-pages", "1"}, {"--coding", "none"}})
    run_well(adding(1, same));
  run_well(store({file(0)}, "b.adm", {"--gradients", "--coding", "split-edge", "--group-pages", "8"}));
  run_well(store({file(1)}, "b.adm", {"--append", "--gradients", "--group-pages", "8"}));
  expect_wrong_usage(store({file(1)}, "b.adm", {"--append", "--coding", "interpolation"}),
                     {"--coding: expected split-edge, as b.adm has"});
}

/// Notes say which times are assumed for steps without any, and which steps are left out.
TEST_F(GrowingStores, TimesThatAreTakenAreTold) {
  const auto expect_note = [this](const std::vector<std::string>& command, const std::string& note) {
    const RunResult result = run(command);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "adamas: note: " + note + "\n");
  };
  run_well({"restore", "a.adm", "-o", "v.vti", "-q", "--step", "1"});
  write("a.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0.25\" file=\"v.vti\"/>"
        "</Collection></VTKFile>");
  run_well({"store", "a.pvd", "-o", "t.adm"});
  expect_note({"store", "v.vti", "-o", "t.adm", "--append"},
              "v.vti: no times: 1 step, taken to be at 1, behind the last one of t.adm at 0.25");
  expect_note({"store", "a.pvd", "-o", "t.adm", "--append"},
              "a.pvd: 1 of 1 step is not later than the last one of t.adm, at 1: nothing is added");
  EXPECT_EQ(info("t.adm")["times"], (std::vector<double>{0.25, 1}));
  expect_note(
      {"store", "v.vti", "v.vti", "-o", "t.adm", "--append"},
      "v.vti and 1 more: no times: 2 steps, taken to be at 2 to 3, behind the last one of t.adm at 1");
  expect_note(
      adding(3),
      "s_2.raw and 2 more: no times: 3 steps, taken to be at 2 to 4, behind the last one of a.adm at 1");
}

}  // namespace
}  // namespace adamas::test
