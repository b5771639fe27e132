#include "adamas/experiment.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "adamas/error.h"
#include "adamas/output_folder.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

ExperimentOptions options_of_a_scene() {
  ExperimentOptions options;
  options.generate = GeneratedData{"sphere", {{8, 8, 8}}, {}};
  options.resampling.interface_error = 0.1;
  options.planes = {{{0, 0, 0.5}, {0, 0, 1}}};
  options.published_by = "nobody";
  options.published = {{"tetrahedra", 1000}};
  return options;
}

TEST(Experiment, HasTheMeshOfASingleRunAndWritesItsFiles) {
  const test::Scratch scratch;
  OutputFolder folder("an experiment", scratch / "experiment", false);
  const ExperimentOptions options = options_of_a_scene();
  const ExperimentRecord record = run_experiment(options, folder);
  folder.commit();

  const OwnedGridData data = generate_data(*options.generate);
  const AdaptiveMesh mesh = resample(data.view(), options.resampling);
  EXPECT_EQ(record.interfaces.report.tetrahedra, mesh.tetrahedra().size());
  EXPECT_EQ(&record.last(), &record.interfaces);
  EXPECT_EQ(record.wanted_runs().size(), 1u);
  ASSERT_EQ(record.published.size(), 1u);
  EXPECT_EQ(record.published[0].here, static_cast<double>(mesh.tetrahedra().size()));
  ASSERT_EQ(record.balance.size(), mesh.materials().size());
  for (std::size_t m = 0; m < record.balance.size(); ++m)
    EXPECT_NEAR(record.balance[m].volume_mesh, mesh.report().materials[m].volume_mesh, 1e-6);
  for (const auto* pictures : {&record.input_pictures, &record.mesh_pictures, &record.slices}) {
    EXPECT_FALSE(pictures->empty());
    for (const ExperimentPicture& picture : *pictures)
      EXPECT_TRUE(std::filesystem::exists(scratch / "experiment" / picture.file)) << picture.file;
  }
  for (const char* file : {"mesh.vtu", "cut-mesh.vtu", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(scratch / "experiment" / file)) << file;
}

TEST(Experiment, RefusesOptionsThatDoNotGoTogether) {
  ExperimentOptions options = options_of_a_scene();
  options.check();
  options.published_by.clear();
  EXPECT_THROW(options.check(), Error);
  options = options_of_a_scene();
  options.film.file = "film.gif";
  EXPECT_THROW(options.check(), Error);
  options = options_of_a_scene();
  options.input.path = "data.vtr";
  EXPECT_THROW(options.check(), Error);
}

}  // namespace

}  // namespace adamas
