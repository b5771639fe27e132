// Tests that long work asks whether to stop; the longer it is, the more often it asks.

#include <gtest/gtest.h>

#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas::test {

using namespace interfaces;

namespace {

/// Counts how often the work asks, and stops it after a given number of times.
class Asked final : public Progress {
 public:
  explicit Asked(std::size_t most = ~std::size_t{0}) : most_(most) {}
  void report(std::string_view stage, double fraction) override {
    EXPECT_FALSE(stage.empty());
    EXPECT_LE(fraction, 1) << stage;
  }
  [[nodiscard]] bool cancelled() const override { return count++ >= most_; }
  mutable std::size_t count = 0;

 private:
  std::size_t most_;
};

MultiMaterialData fractions(std::size_t cells) {
  return sample_scene(make_scene("voronoi10", 3), {cells, cells, cells}, {});
}

void work(const MultiMaterialData& data, Progress& progress) {
  const ResamplingSource source = make_grid_source(data, {}, progress);
  ResamplingOptions options;
  options.interface_error = 0.1 * source.box.diagonal();
  options.conserve = true;
  Resampler resampler(source, options, progress);
  resampler.refine();
  const ResampledMesh mesh = resampled_mesh(resampler);
  (void)cut_mesh(mesh, 0.5 * options.interface_error, progress);
}

/// The tests use one thread, on which each run asks for cancellation equally often.
class Cancellation : public testing::Test {
 protected:
  void SetUp() override { set_thread_limit(1); }
  void TearDown() override { set_thread_limit(0); }
};

TEST_F(Cancellation, EndsWorkAtAnyMoment) {
  const MultiMaterialData data = fractions(8);
  Asked all;
  work(data, all);
  for (std::size_t part = 0; part < 12; ++part) {
    Asked asked(part * all.count / 12);
    EXPECT_THROW(work(data, asked), Cancelled) << part;
    EXPECT_EQ(asked.count, part * all.count / 12 + 1);
  }
}

TEST_F(Cancellation, IsAskedForMoreOftenTheMoreThereIsToDo) {
  std::size_t before = 0;
  for (const std::size_t cells : {8, 16, 32}) {
    Asked asked;
    (void)make_grid_source(fractions(cells), {}, asked);
    EXPECT_GT(asked.count, before) << cells;
    before = asked.count;
  }
}

}  // namespace
}  // namespace adamas::test
