#include "adamas/resample_series.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adamas/error.h"
#include "adamas/files.h"
#include "adamas/generated_files.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

constexpr double kError = 0.1;

/// Two steps of the moving scene, in files.
class ResampledSeriesOfAScene : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path list = scratch_ / "moving.pvd";
    OutputSet outputs;
    SeriesOutput files(list, 2, 1, {".vtr", 2}, {".vtr", ".pvd"}, outputs);
    write_scene({.name = "moving", .cells = {8, 8, 8}}, files, outputs);
    outputs.commit();
    steps_ = read_series(list);
    options_.resampling.interface_error = kError;
    options_.name = "moving";
  }
  ResampledSeries resample_all(OutputSet& outputs) { return resample_series(steps_, options_, outputs); }

  test::Scratch scratch_;
  std::vector<SeriesEntry> steps_;
  ResampleSeriesOptions options_;
};

TEST_F(ResampledSeriesOfAScene, HasTheMeshesOfSingleRuns) {
  OutputSet outputs;
  const ResampledSeries series = resample_all(outputs);
  ASSERT_EQ(series.steps.size(), 2u);
  EXPECT_FALSE(series.steps[0].adaptation);
  EXPECT_TRUE(series.steps[1].adaptation);
  for (std::size_t n = 0; n < 2; ++n) {
    const ResampledStep& step = series.steps[n];
    const AdaptiveMesh alone = resample(read_input({.path = steps_[n].file}), options_.resampling);
    EXPECT_EQ(step.number, n);
    EXPECT_EQ(step.report.tetrahedra, alone.tetrahedra().size());
    EXPECT_EQ(step.report.interface_error->certified, alone.report().interface_error->certified);
    const std::vector<MaterialTotals> totals = material_totals(alone);
    ASSERT_EQ(step.totals_mesh.size(), totals.size());
    for (std::size_t m = 0; m < totals.size(); ++m) {
      EXPECT_EQ(step.totals_mesh[m].volume, totals[m].volume);
      EXPECT_EQ(step.balance[m].volume_mesh, totals[m].volume);
    }
  }
  const std::string csv = series_csv(series);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_EQ(series_tables(series).front().rows.size(), 2u);
}

TEST_F(ResampledSeriesOfAScene, LeavesOutDamagedSteps) {
  write_text(steps_[0].file, "no data");
  options_.meshes = scratch_ / "meshes.pvd";
  OutputSet outputs;
  const ResampledSeries series = resample_all(outputs);
  outputs.commit();
  ASSERT_EQ(series.left_out.size(), 1u);
  EXPECT_EQ(series.left_out[0].number, 0u);
  EXPECT_TRUE(series.left_out[0].text().ends_with(": step 0 is left out"));
  EXPECT_EQ(read_series(options_.meshes).size(), 1u);
}

TEST_F(ResampledSeriesOfAScene, RefusesAFilmWithoutAPlane) {
  options_.film.file = scratch_ / "film.gif";
  OutputSet outputs;
  EXPECT_THROW(resample_all(outputs), Error);
}

}  // namespace

}  // namespace adamas
