#include "adamas/slice_files.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adamas/error.h"
#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/generated_files.h"
#include "adamas/resample.h"
#include "adamas/slice.h"
#include "adamas/store_files.h"
#include "tests/library/same_slice.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::expect_same;
using test::Scratch;

const Plane kPlane{{0.5, 0.5, 0.4}, {0, 0, 1}};

TEST(SlicesOfFiles, AreThoseOfTheMeshInAFile) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("voronoi10", {8, 8, 8});
  const AdaptiveMesh mesh = resample(scene.data.view());
  write_mesh(scratch / "m.vtu", mesh.view());
  SliceRequest request{.inputs = {(scratch / "m.vtu").string()}, .plane = kPlane};
  expect_same(slice(request), slice(mesh, kPlane));
  request.field = mesh.fields().front().name;
  const Slice shown = slice(request);
  expect_same(shown, slice(mesh, kPlane, {.field = request.field}));
  EXPECT_EQ(shown.values.size(), shown.points.size());
  request.field = "none";
  EXPECT_THROW(slice(request), Error);
  request.sections = SliceSections::kAll;
  EXPECT_THROW(slice(request), Error);
}

/// Two steps of the moving scene, in files.
class SlicesOfASeries : public testing::Test {
 protected:
  void SetUp() override {
    OutputSet outputs;
    SeriesOutput files(list_, 2, 1, {".vtr", 2}, {".vtr", ".pvd"}, outputs);
    write_scene({.name = "moving", .cells = {8, 8, 8}}, files, outputs);
    outputs.commit();
    steps_ = read_series(list_);
    request_ = {.inputs = {list_.string()}, .plane = kPlane};
  }

  Scratch scratch_;
  std::filesystem::path list_ = scratch_ / "moving.pvd";
  std::vector<SeriesEntry> steps_;
  SliceRequest request_;
};

TEST_F(SlicesOfASeries, AreThoseOfTheDataOfAStep) {
  const std::vector<SeriesEntry> found = slice_steps(request_);
  ASSERT_EQ(found.size(), 2u);
  for (std::uint32_t n = 0; n < 2; ++n) {
    EXPECT_EQ(found[n].time, steps_[n].time);
    request_.step = n;
    const OwnedGridData data = read_grid_data(steps_[n].file);
    expect_same(slice(request_), slice(data.view(), kPlane));
    expect_same(slice({.inputs = {steps_[n].file}, .plane = kPlane}), slice(data.view(), kPlane));
  }
  request_.step = 2;
  EXPECT_THROW(slice(request_), Error);
  request_.step.reset();
  EXPECT_THROW(slice(request_), Error);
  EXPECT_THROW(slice_steps({.inputs = {steps_[0].file}}), Error);
}

TEST_F(SlicesOfASeries, AreWrittenStepByStep) {
  const auto sliced = [this](const char* output) {
    OutputSet outputs;
    const SliceReport report = write_slice(request_, scratch_ / output, outputs);
    outputs.commit();
    EXPECT_TRUE(std::filesystem::exists(scratch_ / output));
    return report;
  };
  const SliceReport all = sliced("polygons.pvd");
  EXPECT_TRUE(all.is_series);
  ASSERT_EQ(all.steps.size(), 2u);
  EXPECT_EQ(read_series(scratch_ / "polygons.pvd").size(), 2u);
  for (const SlicedStep& step : all.steps) {
    request_.step = step.number;
    const Slice cut = slice(request_);
    EXPECT_EQ(step.areas.pieces, cut.polygon_cells.size());
    ASSERT_EQ(step.areas.materials.size(), cut.materials.size());
    for (std::size_t m = 0; m < cut.materials.size(); ++m)
      EXPECT_EQ(step.areas.materials[m].second, cut.material_areas[m]);
  }
  EXPECT_FALSE(sliced("one.png").is_series);
  request_.step.reset();
  request_.steps = StepRange{1, 1};
  EXPECT_EQ(sliced("some.pvd").steps.size(), 1u);
  request_.steps = StepRange{1, 2};
  OutputSet outputs;
  EXPECT_THROW(write_slice(request_, scratch_ / "none.pvd", outputs), Error);
}

TEST(SlicesOfFiles, AreThoseOfTheSamplesOfAStore) {
  const Scratch scratch;
  const Volume ball = generate_buckyball({12, 10, 8});
  VolumeStore::build(scratch / "b.adm", ball.grid, ball.samples);
  const Box3 box = ball.grid.box();
  const SliceRequest request{.inputs = {(scratch / "b.adm").string()}, .plane = {box.center(), {0, 0, 1}}};
  const Slice cut = slice(request);
  EXPECT_GE(cut.polygon_cells.size(), 12u * 10u);
  EXPECT_NEAR(cut.material_areas[0], box.size().x * box.size().y, 1e-9);
  EXPECT_EQ(cut.values.size(), cut.points.size());
  const auto [low, high] = *VolumeStore::open(scratch / "b.adm").range();
  EXPECT_GE(*std::ranges::min_element(cut.values), low);
  EXPECT_LE(*std::ranges::max_element(cut.values), high);
  EXPECT_THROW(slice({.inputs = request.inputs, .plane = {{0, 0, 1e6}, {0, 0, 1}}}), Error);
  EXPECT_THROW(slice({.inputs = request.inputs, .plane = request.plane, .gradients = true}), Error);
}

}  // namespace

}  // namespace adamas
