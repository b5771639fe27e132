// Tests generated data, in memory and as files.

#include "adamas/generate.h"

#include <gtest/gtest.h>

#include "adamas/error.h"
#include "adamas/files.h"
#include "adamas/generated_files.h"
#include "adamas/series.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

std::vector<float> floats(const NumberSpan& numbers) {
  const auto values = std::get<std::span<const float>>(numbers);
  return {values.begin(), values.end()};
}

TEST(Generate, ScenesKnowTheirVolumesAndInterfaces) {
  const AnalyticScene scene("sphere", 0, {.box = {{0, 0, 0}, {2, 2, 2}}});
  const std::vector<SceneMaterial> materials = scene.materials();
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_NEAR(materials[0].volume + materials[1].volume, 8, 1e-9);
  EXPECT_FALSE(materials[0].sampled_volume);
  const GeneratedScene sampled = scene.sample({8, 8, 8});
  for (const SceneMaterial& material : sampled.materials)
    EXPECT_NEAR(*material.sampled_volume, material.volume, 2 * *material.sampling_error + 1e-9);
  EXPECT_GT(scene.interfaces(0.25).triangles.size(), 100u);
  const Volume inside = scene.samples({9, 9, 9}, SampleType::kFloat32);
  EXPECT_LT(inside.as<float>().front(), 0);
  EXPECT_GT(inside.as<float>()[4 + 9 * (4 + 9 * 4)], 0);
  EXPECT_THROW(AnalyticScene("sphere", 0, {.time = 2}), Error);
  EXPECT_THROW(static_cast<void>(scene.interfaces(0)), Error);
}

TEST(Generate, DataByName) {
  const OwnedGridData owned = generate_data({"shell3", {{6, 5, 4}}});
  EXPECT_EQ(floats(owned.view().fractions[1]),
            floats(generate_scene("shell3", {6, 5, 4}).data.view().fractions[1]));
  EXPECT_EQ(generated_names().front(), "impact");
  EXPECT_THROW(generate_data({"shell3"}), Error);
  EXPECT_THROW(generate_data({"impact", {{4, 4, 4}}, 1}), Error);
}

TEST(Generate, ImpactKeepsWhatDoesNotLeave) {
  ImpactSimulation flow({.cells = {6, 6, 10}});
  flow.advance_to(0.2);
  const FlowState state = flow.state();
  EXPECT_EQ(state.materials, (std::vector<std::string>{"projectile", "block", "empty"}));
  EXPECT_EQ(state.time, 0.2);
  for (std::size_t m = 0; m < 2; ++m)
    EXPECT_NEAR(state.inside.masses[m], state.start.masses[m] + state.entered.masses[m],
                1e-9 * state.start.masses[m]);
  EXPECT_EQ(flow.data().view().fields[0].unit, "g/cm3");
  EXPECT_THROW(ImpactSimulation({.speed = 11}), Error);
}

TEST(Generate, FilesAreWhatWasMade) {
  const test::Scratch scratch;
  OutputSet outputs;
  const std::filesystem::path list = scratch / "m.pvd";
  SeriesOutput series(list, 3, 1, {".vtr", 60}, {".vtr", ".pvd"}, outputs);
  const WrittenScene written =
      write_scene({.name = "moving", .cells = {6, 6, 6}, .blur = {0.5, 0.1}}, series, outputs);
  outputs.commit();
  ASSERT_EQ(written.states.size(), 3u);
  const std::vector<SeriesEntry> steps = read_series(list);
  for (std::size_t step = 0; step < 3; ++step) {
    const AnalyticScene scene("moving", 0, {.time = written.states[step].time});
    const GeneratedScene made = scene.sample({6, 6, 6}, {0.5, 0.1});
    const OwnedGridData read = read_grid_data(steps[step].file);
    EXPECT_EQ(floats(read.view().fractions[0]), floats(made.data.view().fractions[0]));
    EXPECT_EQ(made.materials[0].volume, written.states[step].materials[0].volume);
  }
}

TEST(Generate, FlowsAsFiles) {
  const test::Scratch scratch;
  OutputSet outputs;
  SeriesOutput series(scratch / "m.vti", {}, 1e-5, {".vti", 60}, {".vti"}, outputs);
  MixingSimulation flow({.cells = {8, 8, 8}}, SampleType::kUint16);
  write_flow(flow, series, outputs);
  const WrittenVolume ball = write_buckyball({9, 8, 7}, SampleType::kUint8, scratch / "b.vti", outputs);
  outputs.commit();
  EXPECT_EQ(series.bytes(), std::filesystem::file_size(scratch / "m.vti"));
  const std::vector<SampledField> fields = flow.fields();
  ASSERT_EQ(fields.size(), 2u);
  const Volume density = read_volume(scratch / "m.vti", "density");
  EXPECT_EQ(density.grid.dimensions, flow.grid().dimensions);
  EXPECT_EQ(fields[1].samples.size(), flow.grid().bytes());
  EXPECT_EQ(read_volume(scratch / "b.vti").samples, generate_buckyball({9, 8, 7}).samples);
  EXPECT_EQ(ball.bytes, std::filesystem::file_size(scratch / "b.vti"));
  EXPECT_THROW(MixingSimulation({.mach = 1}), Error);
  EXPECT_THROW(SeriesOutput(scratch / "n.vti", 3, 1, {".vti", 60}, {".vti"}, outputs), Error);
}

}  // namespace
}  // namespace adamas
