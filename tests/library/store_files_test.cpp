#include "adamas/store_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::Scratch;

constexpr int kSteps = 5;

/// A series of balls whose samples are shifted from step to step.
class Series {
 public:
  Series() {
    for (int n = 0; n < kSteps; ++n) {
      Volume step = generate_buckyball({24, 20, 18});
      std::rotate(step.samples.begin(), step.samples.begin() + n, step.samples.end());
      steps.push_back(std::move(step));
    }
  }
  [[nodiscard]] SeriesSource source(std::size_t first, std::size_t count) const {
    SeriesSource source{steps.front().grid, {}, [this, first](std::uint32_t n) -> VolumeStore::PlaneSource {
                          return [&samples = steps[first + n].samples](std::uint64_t k,
                                                                       std::span<std::byte> plane) {
                            std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(k * plane.size()),
                                        plane.size(), plane.begin());
                          };
                        }};
    for (std::size_t n = 0; n < count; ++n) source.times.push_back(0.5 * static_cast<double>(first + n));
    return source;
  }
  /// Writes the steps as step_0.vti, step_1.vti and so on.
  void write(const Scratch& scratch) const {
    for (std::size_t n = 0; n < steps.size(); ++n)
      write_volume(scratch / ("step_" + std::to_string(n) + ".vti"), steps[n].grid, steps[n].samples);
  }

  std::vector<Volume> steps;
};

class Notes final : public Progress {
 public:
  void report(std::string_view, double) override {}
  void note(NoteKind, std::string_view text) override { all += std::string(text) + "\n"; }
  std::string all;
};

TEST(VolumeStoreSeries, StepsComeBack) {
  const Scratch scratch;
  const Series series;
  const auto path = scratch / "series.adm";
  const BuildReport built = VolumeStore::build(path, series.source(0, 3), {.gradients = true});
  EXPECT_EQ(built.file_bytes, std::filesystem::file_size(path));
  EXPECT_GT(built.bytes.samples, 0u);
  VolumeStore::append(path, series.source(3, 2));
  VolumeStore store = VolumeStore::open(path);
  EXPECT_EQ(store.steps(), 5u);
  EXPECT_EQ(store.times(), (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  for (std::uint32_t step = 0; step < store.steps(); ++step)
    EXPECT_EQ(store.restore({}, step).samples, series.steps[step].samples) << step;
  std::vector<std::vector<std::byte>> found(kSteps);
  store.restore_steps({1, 4}, {}, [&found](std::uint32_t step, std::span<const std::byte> plane) {
    found[step].insert(found[step].end(), plane.begin(), plane.end());
  });
  EXPECT_TRUE(found[0].empty());
  for (std::size_t step = 1; step < kSteps; ++step) EXPECT_EQ(found[step], series.steps[step].samples);
  EXPECT_TRUE(store.damaged_steps({0, 4}).empty());
  const VerifiedStore verified = store.verify();
  EXPECT_EQ(verified.bad_pages + verified.bad_copies, 0u);
  const StoreFacts facts = store.facts();
  EXPECT_EQ(verified.pages, store.steps() * facts.pages);
  EXPECT_EQ(facts.blocks, 2u);
  EXPECT_TRUE(facts.gradients);
  EXPECT_EQ(facts.file_bytes, store.file_bytes());
  EXPECT_EQ(facts.unfinished_bytes, 0u);
}

TEST(VolumeStoreSeries, SurfacesAreThoseOfTheStep) {
  const Scratch scratch;
  const Series series;
  VolumeStore::build(scratch / "series.adm", series.source(0, kSteps));
  VolumeStore::build(scratch / "one.adm", series.steps[3].grid, series.steps[3].samples);
  VolumeStore store = VolumeStore::open(scratch / "series.adm"), one = VolumeStore::open(scratch / "one.adm");
  const Isosurface wanted = one.isosurface({.isovalue = 80.5}), first = store.isosurface({.isovalue = 80.5});
  const Isosurface found = store.isosurface({.isovalue = 80.5, .step = 3});
  EXPECT_EQ(found.surface.points, wanted.surface.points);
  EXPECT_EQ(found.surface.triangles, wanted.surface.triangles);
  EXPECT_EQ(found.surface.normals, wanted.surface.normals);
  EXPECT_NE(found.surface.points, first.surface.points);
  EXPECT_GT(found.reads.pages, 0u);

  const std::vector<double> isovalues{80.5, 1e9, 120.5};
  Notes notes;
  const Isosurface several = store.isosurfaces(isovalues, {.step = 3}, notes);
  ASSERT_EQ(several.ends.size(), 3u);
  EXPECT_EQ(several.ends[0], wanted.surface.triangles.size());
  EXPECT_EQ(several.ends[1], several.ends[0]);
  EXPECT_EQ(several.ends[2], several.surface.triangles.size());
  EXPECT_EQ(several.surface.values.front(), 80.5F);
  EXPECT_EQ(several.surface.values.back(), 120.5F);
  EXPECT_NE(notes.all.find("no surface at isovalue 1e+09: samples are from"), std::string::npos) << notes.all;
  EXPECT_NE(test::error_of([&] { store.isosurface({.isovalue = 80.5, .step = 5}); }).find("--step"),
            std::string::npos);
}

TEST(VolumeStoreSeries, WrongOptionsAreRefused) {
  const Scratch scratch;
  const Series series;
  const auto path = scratch / "series.adm";
  const auto has = [](const std::string& message, const char* text) {
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  const auto build = [&](const BuildOptions& options) {
    return test::error_of([&] { VolumeStore::build(path, series.source(0, 2), options); });
  };
  has(build({.smoothing = BuildOptions::Smoothing::kNone}), "--smoothing");
  has(build({.smooth_along_time = false}), "--no-time-smoothing");
  has(build({.block_steps = 0}), "--block-steps");
  has(build({.group_pages = 3}), "--group-pages");
  SeriesSource backward = series.source(0, 2);
  std::swap(backward.times[0], backward.times[1]);
  has(test::error_of([&] { VolumeStore::build(path, backward); }), "ascend");
  EXPECT_EQ(scratch.entries(), 0);
  VolumeStore::build(path, series.source(0, 2));
  has(test::error_of([&] { VolumeStore::append(path, series.source(0, 2)); }), "after the time");
  has(test::error_of([&] { VolumeStore::append(path, series.source(2, 2), {.gradients = true}); }),
      "--gradients");
  VolumeStore store = VolumeStore::open(path);
  EXPECT_EQ(store.steps(), 2u);
  has(test::error_of([&] { store.restore({}, 2); }), "--step: expected less than 2");
  Notes notes;
  store.restore({}, {}, notes);
  has(notes.all, "the first of 2 steps");
}

TEST(StoreFiles, ASeriesOfFilesIsTheStoreOfItsSteps) {
  const Scratch scratch;
  const Series series;
  series.write(scratch);
  SeriesSource source = series.source(0, kSteps);
  source.times = {0, 1, 2, 3, 4};
  source.array = "values";
  VolumeStore::build(scratch / "arrays.adm", source);
  OutputSet outputs;
  const StoreReport report =
      store_files({.inputs = {(scratch / "step_%d.vti").string()}, .output = scratch / "files.adm"}, outputs);
  EXPECT_FALSE(std::filesystem::exists(scratch / "files.adm"));
  outputs.commit();
  EXPECT_EQ(test::bytes_of(scratch / "files.adm"), test::bytes_of(scratch / "arrays.adm"));
  EXPECT_EQ(report.steps, 5u);
  EXPECT_EQ(report.input_bytes, kSteps * series.steps[0].grid.bytes());
  EXPECT_EQ(report.added_bytes(), report.stored.file_bytes);
}

TEST(StoreFiles, StepsAreAddedToAStore) {
  const Scratch scratch;
  const Series series;
  series.write(scratch);
  const auto add = [&](const std::string& name) {
    OutputSet outputs;
    StoreReport report = store_files(
        {.inputs = {(scratch / name).string()}, .output = scratch / "grown.adm", .append = true}, outputs);
    outputs.commit();
    return report;
  };
  EXPECT_EQ(add("step_0.vti").steps_before, 0u);
  const StoreReport report = add("step_1.vti");
  EXPECT_EQ(report.steps_before, 1u);
  EXPECT_EQ(report.steps, 1u);
  VolumeStore store = VolumeStore::open(scratch / "grown.adm");
  EXPECT_EQ(report.bytes_before + report.added_bytes(), store.file_bytes());
  EXPECT_EQ(store.restore({}, 1).samples, series.steps[1].samples);
}

TEST(StoreFiles, RestoredFilesHaveTheSamples) {
  const Scratch scratch;
  const Series series;
  const auto path = scratch / "series.adm";
  VolumeStore::build(path, series.source(0, kSteps));
  OutputSet outputs;
  const RestoreReport one =
      restore_files({.store = path, .part = {.lod = 1}, .step = 2, .output = scratch / "a.nrrd"}, outputs);
  const RestoreReport list =
      restore_files({.store = path, .steps = StepRange{1, 3}, .output = scratch / "list.pvd"}, outputs);
  const RestoreReport folder = restore_files({.store = path, .output = scratch / "all.zarr"}, outputs);
  outputs.commit();
  folder.folder->commit();
  EXPECT_EQ(one.steps, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(one.lod, 1);
  EXPECT_EQ(one.bytes, std::filesystem::file_size(scratch / "a.nrrd"));
  EXPECT_EQ(read_volume(scratch / "a.nrrd").samples, VolumeStore::open(path).restore({.lod = 1}, 2).samples);
  EXPECT_EQ(list.steps, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(read_volume(scratch / "list_0003.vti").samples, series.steps[3].samples);
  EXPECT_EQ(folder.steps.size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(scratch / "all.zarr" / ".zattrs"));
}

TEST(StoreFiles, WhatIsWrongIsToldInALine) {
  const Scratch scratch;
  const Series series;
  series.write(scratch);
  const auto path = scratch / "a.adm";
  OutputSet first, outputs;
  const auto has = [](const std::string& message, const char* text) {
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  has(test::error_of([&] { store_files({.inputs = {"none.vti"}, .output = path}, first); }), "none.vti");
  VolumeStore::build(path, series.source(0, 2));
  has(test::error_of([&] {
        restore_files({.store = path, .steps = StepRange{1, 2}, .output = scratch / "a.zarr"}, outputs);
      }),
      "--steps: expected two of the 2 steps");
  has(test::error_of(
          [&] { restore_files({.store = path, .output = scratch / "a.vti", .overwrite = true}, outputs); }),
      "--overwrite");
}

TEST(VolumeInput, RawFilesAreReadByWhatIsSaidOfThem) {
  const Scratch scratch;
  const Volume ball = generate_buckyball({9, 8, 7});
  write_volume(scratch / "a.raw", ball.grid, ball.samples);
  VolumeInput input;
  input.path = (scratch / "a.raw").string();
  input.raw.dimensions = ball.grid.dimensions;
  EXPECT_NE(test::error_of([&] { read_volume(input); }).find("--type"), std::string::npos);
  input.raw.type = parse_stored_type(sample_name(ball.grid.type));
  input.raw.spacing = Vec3{1, 2, 3};
  EXPECT_EQ(input.option(), "--dimensions");
  const Volume read = read_volume(input);
  EXPECT_EQ(read.samples, ball.samples);
  EXPECT_EQ(read.grid.spacing, (Vec3{1, 2, 3}));
  input.stack = true;
  EXPECT_NE(test::error_of([&] { read_volume(input); }).find("--stack and --dimensions"), std::string::npos);
}

TEST(VolumeInput, AFileAloneIsOneStep) {
  const Scratch scratch;
  const Series series;
  series.write(scratch);
  const VolumeInputSteps one = find_volume_steps({(scratch / "step_1.vti").string()});
  ASSERT_EQ(one.steps.size(), 1u);
  EXPECT_EQ(read_volume(one.steps[0].input).samples, series.steps[1].samples);
  const VolumeInputSteps all = find_volume_steps({(scratch / "step_#.vti").string()});
  ASSERT_EQ(all.steps.size(), 5u);
  EXPECT_EQ(all.steps[4].time, 4);
  EXPECT_EQ(all.times, StepTimes::kCounted);
  VolumeInput stack;
  stack.stack = true;
  EXPECT_NE(test::error_of([&] { find_volume_steps({"a", "b"}, stack); }).find("--stack"), std::string::npos);
}

}  // namespace
}  // namespace adamas
