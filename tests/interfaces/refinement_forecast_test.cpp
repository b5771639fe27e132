// Tests of what is told about how far refining is.

#include "interfaces/resampling/refinement_forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/interfaces/resampler_scenes.h"

namespace adamas::test {

using namespace interfaces;

namespace {

/// Keeps the parts that are reported of one stage.
class OfStage final : public Progress {
 public:
  explicit OfStage(std::string stage) : stage_(std::move(stage)) {}
  void report(std::string_view stage, double fraction) override {
    if (stage.starts_with(stage_)) parts.push_back(fraction);
  }
  std::vector<double> parts;

 private:
  std::string stage_;
};

/// Loops report after so many cells each, so that the number of reports is the work, but for the rounds' own
/// overhead.
TEST(RefinementForecast, NeverFallsAndIsNotFarOff) {
  for (const auto& [scene, error] : {std::pair{"shell3", 0.003}, {"random", 0.005}}) {
    SCOPED_TRACE(scene);
    const MultiMaterialData data = sample_scene(make_scene(scene, 5), {24, 24, 24}, {});
    const ResamplingSource source = make_grid_source(data);
    ResamplingOptions options;
    options.interface_error = error * source.box.diagonal();
    options.certify = false;
    OfStage progress("refining interfaces: ");
    const unsigned threads = thread_limit();
    set_thread_limit(1);
    Resampler(source, options, progress).refine();
    set_thread_limit(threads);
    const auto known = std::ranges::find_if(progress.parts, [](double part) { return part >= 0; });
    const auto count = static_cast<double>(progress.parts.end() - known);
    EXPECT_GE(count, 100);
    double last = 0, off = 0;
    for (auto part = known; part != progress.parts.end(); ++part) {
      EXPECT_GE(*part, last) << "once known, always known";
      EXPECT_LE(*part, 1);
      last = *part;
      off += std::abs(last - static_cast<double>(part - known) / count);
    }
    EXPECT_LT(off / count, 0.25);
  }
}

TEST(RefinementForecast, IsRightWhereRoundsAreAsExpected) {
  // All children fail down to a diameter of 8, then 0.15 fewer of them in each round.
  std::vector<RefinementForecast::Round> rounds;
  double failing = 64, part = 1, splits = 64;
  for (double diameter = 16; diameter > 1.2; diameter *= std::cbrt(0.5)) {
    rounds.push_back({static_cast<std::size_t>(failing), static_cast<std::size_t>(splits), diameter});
    const double before = part;
    if (diameter < 8) part = std::max(0.3, part - 0.15);
    failing *= 2 * part;
    splits *= 2 * part * std::pow(before / part, 0.8);
  }
  RefinementForecast forecast;
  std::vector<double> parts;
  double all = 0;
  std::size_t first = 0;
  for (std::size_t r = 0; r < rounds.size(); ++r) {
    const auto found = forecast.begin_round(rounds[r]);
    if (!found && parts.empty()) first = r + 1;
    if (found) parts.push_back((*found)[0]);
  }
  ASSERT_GE(parts.size(), 5u);
  EXPECT_EQ(parts.size() + first, rounds.size());
  for (std::size_t r = first; r < rounds.size(); ++r) all += static_cast<double>(rounds[r].splits);
  double done = 0;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    EXPECT_NEAR(parts[n], done / all, 0.02) << n;
    done += static_cast<double>(rounds[first + n].splits);
  }
}

}  // namespace
}  // namespace adamas::test
