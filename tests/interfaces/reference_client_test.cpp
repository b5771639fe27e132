#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "interfaces/comparison/reference_mesher.h"
#include "interfaces/comparison/sizing_search.h"
#include "interfaces/reference_client/child_program.h"
#include "interfaces/reference_client/program_messages.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Shell scripts that take the place of the separate program.
class ChildProgram : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path script(const std::string& body) const {
    const auto path = scratch / "program";
    test::put_bytes(path, "#!/bin/sh\n" + body + "\n");
    ::chmod(path.c_str(), 0755);
    return path;
  }
  [[nodiscard]] ReferenceResult mesh(const std::filesystem::path& program, double seconds = 20) const {
    PiecewiseLinearComplex complex;
    complex.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    complex.patches = {{BodyId(0), BodyId(1), -1}};
    complex.triangles = {{{0, 1, 2}, 0}};
    MesherOptions options;
    options.program = program;
    options.limits.seconds = seconds;
    return mesh_by_mesh3(complex, {}, options);
  }
  test::Scratch scratch;
};

/// Returns whether a process exists and runs; one that ended but was not waited for counts as gone.
bool runs(int process) {
  const std::string stat = test::bytes_of("/proc/" + std::to_string(process) + "/stat");
  const std::size_t name = stat.rfind(')');
  return name != std::string::npos && stat.size() > name + 2 && stat[name + 2] != 'Z';
}

TEST_F(ChildProgram, GivesBackWhatItWrote) {
  const ChildResult result = run_child_program(script("cat"), {'a', '\0', 'b'}, {});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.output, (std::vector<char>{'a', '\0', 'b'}));
}

TEST_F(ChildProgram, TellsHowItEnded) {
  const ChildResult crashed = run_child_program(script("echo far too small >&2; kill -SEGV $$"), {}, {});
  EXPECT_TRUE(test::says(crashed.failure, "signal 11"));
  EXPECT_TRUE(test::says(crashed.failure, "(it said: far too small)"));
  EXPECT_TRUE(crashed.crashed);
  const ChildResult refused = run_child_program(script("exit 7"), {}, {});
  EXPECT_EQ(refused.failure, "ended with status 7");
  EXPECT_FALSE(refused.crashed);
  EXPECT_EQ(run_child_program(scratch / "none", {}, {}).failure, "could not be started");
}

TEST_F(ChildProgram, IsEndedAtItsTimeWithAllItStarted) {
  const auto pid = scratch / "pid";
  const auto start = std::chrono::steady_clock::now();
  const ReferenceResult result = mesh(script("sleep 100 &\necho $! > " + pid.string() + "\nsleep 100"), 0.5);
  EXPECT_EQ(result.failure, "took longer than 0.5 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  const int child = std::stoi(test::bytes_of(pid));
  for (int i = 0; i < 200 && runs(child); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(runs(child));
}

TEST_F(ChildProgram, LeavesNothingRunningBehindIt) {
  const auto pid = scratch / "pid";
  EXPECT_EQ(run_child_program(script("sleep 100 &\necho $! > " + pid.string()), {}, {}).failure, "");
  const int child = std::stoi(test::bytes_of(pid));
  for (int i = 0; i < 200 && runs(child); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(runs(child));
}

TEST_F(ChildProgram, HasTheLimitsItWasGiven) {
  ChildLimits limits;
  limits.seconds = 41;
  limits.memory_bytes = std::size_t{512} << 20;
  const ChildResult result = run_child_program(script("ulimit -v; ulimit -t; ulimit -c"), {}, limits);
  EXPECT_EQ(std::string(result.output.begin(), result.output.end()), "524288\n42\n0\n");
}

TEST_F(ChildProgram, StopsWhereTheUserDoes) {
  class Stop final : public Progress {
    void report(std::string_view, double) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  };
  EXPECT_THROW(run_child_program(script("sleep 100"), {}, {}, Stop()), Cancelled);
}

TEST_F(ChildProgram, IsNotBelieved) {
  EXPECT_EQ(mesh(script("echo no mesh")).failure, "gave no answer that can be read");
  EXPECT_EQ(mesh(script("true")).failure, "gave no answer that can be read");
  MesherReply good;
  good.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  good.tetrahedra = {{0, 1, 2, 3}};
  good.regions = {1};
  const auto failure = [&](const std::function<void(MesherReply&)>& damage) {
    MesherReply reply = good;
    damage(reply);
    const auto bytes = encode(reply);
    test::put_bytes(scratch / "reply", {bytes.begin(), bytes.end()});
    return mesh(script("cat " + (scratch / "reply").string())).failure;
  };
  EXPECT_EQ(failure([](MesherReply&) {}), "");
  EXPECT_NE(failure([](MesherReply& r) { r.tetrahedra[0][2] = 4; }), "");
  EXPECT_NE(failure([](MesherReply& r) { r.points[1].x = NAN; }), "");
  EXPECT_NE(failure([](MesherReply& r) { r.regions.push_back(1); }), "");
  EXPECT_NE(failure([](MesherReply& r) { r.regions[0] = 0; }), "");
  EXPECT_NE(failure([](MesherReply& r) { r.regions[0] = 3; }), "");
  EXPECT_NE(failure([](MesherReply& r) { r.triangles = {{0, 1, 2}}; }), "");
  EXPECT_EQ(failure([](MesherReply& r) { r.failure = "no luck"; }), "no luck");
  // Every truncation of the bytes is refused.
  const auto bytes = encode(good);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_FALSE(decode<MesherReply>({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}));
}

TEST_F(ChildProgram, RunsOutOfMemory) {
  PiecewiseLinearComplex complex;
  complex.patches = {{BodyId(), BodyId(0), 0}};
  // A fine terrace has many points on few planes.
  constexpr std::uint32_t kSide = 400;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    complex.points.push_back(
        {i % kSide + 0.1 * std::sin(i), i / kSide + 0.1 * std::cos(i), std::sin(7.0 * i)});
  for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) complex.triangles.push_back({{i, i + 1, i + kSide}, 0});
  }
  MesherOptions options;
  options.program = ADAMAS_REFERENCE_PROGRAM;
  options.limits.memory_bytes = std::size_t{80} << 20;
  EXPECT_NE(mesh_by_tetgen(complex, "zpQ", options).failure, "");
}

TEST_F(ChildProgram, SurvivesTetGenOnWhatIntersects) {
  PiecewiseLinearComplex complex;
  complex.source = "crossed";
  complex.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {1, 1, 0.1}, {0, 0, 2}};
  complex.patches = {{BodyId(0), BodyId(1), -1}};
  complex.triangles = {{{0, 1, 2}, 0}, {{3, 4, 5}, 0}, {{0, 1, 6}, 0}};
  MesherOptions options;
  options.program = ADAMAS_REFERENCE_PROGRAM;
  EXPECT_NE(mesh_by_tetgen(complex, "zpq1.414Q", options).failure, "");
}

TEST(SizingSearch, FindsTheSizeOfADistance) {
  using Outcome = SizingTrial::Outcome;
  const auto search = [](double wanted, double first, const std::function<SizingTrial(double)>& attempt) {
    int trials = 0;
    double last = 0;
    const bool found = search_sizing(wanted, first, [&](double size) {
      ++trials;
      const SizingTrial trial = attempt(size);
      last = trial.distance;
      return trial;
    });
    EXPECT_LE(trials, SizingOptions().most_trials);
    if (found) {
      EXPECT_NEAR(last, wanted, 0.05 * wanted);
    }
    return found;
  };
  const auto power = [](double s) { return SizingTrial{Outcome::kMeasured, 3 * std::pow(s, 1.7)}; };
  for (const double first : {1e-4, 0.01, 1.0, 20.0}) EXPECT_TRUE(search(0.05, first, power)) << first;
  EXPECT_TRUE(search(0.05, 1, [&](double s) {
    return s > 0.3 ? SizingTrial{Outcome::kTooCoarse, 0} : power(s);
  }));
  EXPECT_TRUE(search(0.05, 0.001, [&](double s) {
    return s < 0.02 ? SizingTrial{Outcome::kTooFine, 0} : power(s);
  }));
  // Where the distance jumps over the one wanted, the search fails and says so.
  EXPECT_FALSE(search(0.05, 1, [&](double s) {
    return SizingTrial{Outcome::kMeasured, s < 0.1 ? 0.01 : 0.2};
  }));
  EXPECT_FALSE(search(0.05, 1, [](double) { return SizingTrial{Outcome::kTooCoarse, 0}; }));
}

TEST(SizingSearch, TriesNoSizeAboveTheGreatest) {
  using Outcome = SizingTrial::Outcome;
  SizingOptions options;
  options.greatest = 1.7;
  std::vector<double> sizes;
  const auto fine = [&](double size) {
    sizes.push_back(size);
    return SizingTrial{Outcome::kMeasured, 1e-6 * size};
  };
  EXPECT_FALSE(search_sizing(1, 0.1, fine, options));
  EXPECT_NEAR(*std::max_element(sizes.begin(), sizes.end()), 1.7, 1e-9);
  EXPECT_EQ(std::count_if(sizes.begin(), sizes.end(), [](double s) { return s > 1.69; }), 1);
  // When the time is over there is no further trial either.
  sizes.clear();
  EXPECT_FALSE(search_sizing(
      1, 5,
      [&](double size) {
        sizes.push_back(size);
        return SizingTrial{Outcome::kOver, 0};
      },
      options));
  ASSERT_EQ(sizes.size(), 1u);
  EXPECT_NEAR(sizes[0], 1.7, 1e-9);
}

}  // namespace
}  // namespace adamas
