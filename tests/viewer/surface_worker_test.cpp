#include "viewer/contents/surface_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ball_store.h"
#include "tests/support/scratch.h"
#include "viewer/contents/frame_budget.h"
#include "viewer/contents/open_store.h"
#include "viewer/contents/store_section.h"

namespace adamas {

using namespace viewer;

namespace {

class SurfaceWorkers : public testing::Test {
 protected:
  void SetUp() override {
    path = (folder / "ball.adm").string();
    test::make_ball_store(path);
  }
  static WantedSurfaces wanted(double isovalue = 100) {
    WantedSurfaces result;
    result.viewpoint.eye = {16, -60, 18};
    result.viewpoint.target = {16, 16, 16};
    result.viewpoint.up = {0, 0, 1};
    result.isovalues = {isovalue, isovalue + 40};
    result.pixels = 0.5;
    result.max_triangles = 100'000;
    return result;
  }
  [[nodiscard]] std::unique_ptr<SurfaceWorker> worker(bool waits) {
    DocumentOptions options;
    options.waits_for_pages = waits;
    stores.push_back(OpenStore::open(path, options.memory, 0));
    return std::make_unique<SurfaceWorker>(*stores.back(), nullptr, options);
  }
  /// Returns what has been found when nothing more comes.
  static std::shared_ptr<const FoundSurfaces> finished(SurfaceWorker& worker, const WantedSurfaces& wanted) {
    worker.want(wanted);
    worker.wait_for(wanted);
    while (!worker.is_current()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return worker.found();
  }
  static void expect_same(const FoundSurfaces& found, const FoundSurfaces& expected) {
    EXPECT_EQ(found.report.problem, "");
    EXPECT_EQ(found.report.pages_missing, 0u);
    EXPECT_EQ(found.report.triangles, expected.report.triangles);
    EXPECT_EQ(found.report.largest_error_pixels, expected.report.largest_error_pixels);
    ASSERT_EQ(found.surfaces.size(), expected.surfaces.size());
    for (std::size_t s = 0; s < found.surfaces.size(); ++s) {
      ASSERT_EQ(found.surfaces[s].size(), expected.surfaces[s].size());
      for (std::size_t n = 0; n < found.surfaces[s].size(); ++n) {
        const DrawnMesh &mesh = *found.surfaces[s][n], &other = *expected.surfaces[s][n];
        EXPECT_EQ(mesh.indices, other.indices);
        ASSERT_EQ(mesh.vertices.size(), other.vertices.size());
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
          EXPECT_EQ(mesh.vertices[v].place, other.vertices[v].place);
          EXPECT_EQ(mesh.vertices[v].normal, other.vertices[v].normal);
        }
      }
    }
  }

  test::Scratch folder;
  std::string path;
  std::vector<std::unique_ptr<OpenStore>> stores;
};

TEST_F(SurfaceWorkers, SharpenUntilTheirSurfacesAreThoseThatWait) {
  const auto waiting = worker(true), sharpening = worker(false);
  for (const double isovalue : {100.0, 60.0, 100.0}) {
    WantedSurfaces all = wanted(isovalue);
    expect_same(*finished(*sharpening, all), *finished(*waiting, all));
    all.viewpoint.eye = {70, 20, 5};
    expect_same(*finished(*sharpening, all), *finished(*waiting, all));
  }
}

/// The memory of pages has one limit for any number of isovalues, with a section, in both ways of paging.
TEST_F(SurfaceWorkers, KeepToOneMemoryOfPages) {
  VolumeGrid grid;
  grid.dimensions = {129, 129, 129};
  grid.type = SampleType::kUint8;
  std::vector<std::byte> samples;
  for (int k = 0; k < 129; ++k) {
    for (int j = 0; j < 129; ++j) {
      for (int i = 0; i < 129; ++i)
        samples.push_back(static_cast<std::byte>(std::lround(
            120 + 40 * std::sin(0.2 * i) * std::cos(0.23 * j) + 40 * std::sin(0.17 * k + 0.1 * i))));
    }
  }
  path = (folder / "waves.adm").string();
  VolumeStore::build(path, grid, samples);
  constexpr std::size_t kMemory = std::size_t{3} << 20;
  for (const bool waits : {true, false}) {
    DocumentOptions options;
    options.memory = kMemory;
    options.waits_for_pages = waits;
    const auto store = OpenStore::open(path, kMemory, 0);
    StoreSection section(*store, nullptr);
    SurfaceWorker some(*store, nullptr, options);
    WantedSurfaces all = wanted();
    all.max_triangles = 10'000'000;
    all.viewpoint.eye = {64, -100, 70};
    all.viewpoint.target = {64, 64, 64};
    all.isovalues.clear();
    for (int n = 0; n < 4; ++n) {
      all.isovalues.push_back(90 + 20 * n);
      StoreSection::Wanted plane{{{64, 64, 64}, {1, 0.3, 0.2}}};
      plane.plane.origin.x += n;
      section.want(plane);
      EXPECT_EQ(finished(some, all)->report.problem, "");
      section.wait_for(plane);
      EXPECT_LE(store->pages().bytes_held(), kMemory);
    }
    if (waits) {
      EXPECT_GT(store->pages().bytes_held(), kMemory / 10 * 9) << "there are more pages than fit";
    }
  }
}

TEST_F(SurfaceWorkers, ComeToAnEndHoweverShortTheTimeOfAFrameIs) {
  const auto any = worker(true);
  for (const bool waits : {true, false}) {
    const auto short_of_time = worker(waits);
    WantedSurfaces all = wanted();
    const auto expected = finished(*any, all);
    all.seconds = 1e-6;
    expect_same(*finished(*short_of_time, all), *expected);
  }
}

TEST_F(SurfaceWorkers, CanBeDestroyedWhilePagesCome) {
  for (int n = 0; n < 10; ++n) {
    const auto some = worker(false);
    some->want(wanted());
    if (n % 2 == 0) some->wait_for(wanted());
  }
}

TEST_F(SurfaceWorkers, TellOfAStoreThatIsCutOffAndKeepWhatThereIs) {
  const auto some = worker(false);
  WantedSurfaces all = wanted();
  // At this detail the coarsest pages are already in memory.
  all.pixels = 300;
  const auto before = finished(*some, all);
  EXPECT_EQ(before->report.problem, "");
  std::filesystem::resize_file(path, 600);
  all.pixels = 0.5;
  const auto found = finished(*some, all);
  EXPECT_NE(found->report.problem.find("ball.adm"), std::string::npos) << found->report.problem;
  EXPECT_EQ(found->report.problem.find('\n'), std::string::npos);
  EXPECT_GT(found->report.pages_lost, 0u);
  EXPECT_EQ(found->surfaces.size(), 2u);
  EXPECT_GT(found->report.largest_error_pixels, all.pixels);
}

TEST(FrameBudgets, GiveAMovingViewWhatThereIsTimeFor) {
  // A triangle takes `cost` seconds.
  for (const double cost : {1e-7, 1e-6, 1e-5}) {
    FrameBudget budget;
    const double time = 0.02;
    const std::uint64_t most = 500'000;
    int late = 0;
    for (int n = 0; n < 60; ++n) {
      budget.begin(time, most, false);
      const std::uint64_t triangles = budget.triangles();
      EXPECT_LE(triangles, most);
      const double seconds = cost * static_cast<double>(triangles);
      const bool is_stopped = seconds > budget.seconds();
      budget.note(is_stopped ? budget.seconds() : seconds, is_stopped);
      late += n > 20 && is_stopped ? 1 : 0;
    }
    EXPECT_EQ(late, 0);
    budget.begin(time, most, false);
    EXPECT_GE(static_cast<double>(budget.triangles()), 0.5 * std::min(500'000.0, time / cost));
  }
}

TEST(FrameBudgets, GiveAViewThatStandsStillAllInTheEnd) {
  for (const double cost : {1e-6, 1e-4, 1.0}) {
    FrameBudget budget;
    budget.begin(0.01, 1'000'000, false);
    budget.note(0.01, true);
    int frames = 0;
    for (; !budget.is_whole() && frames < 200; ++frames) {
      budget.begin(0.01, 1'000'000, true);
      const double seconds = cost * static_cast<double>(budget.triangles());
      const bool is_stopped = seconds > budget.seconds();
      budget.note(is_stopped ? budget.seconds() : seconds, is_stopped);
    }
    EXPECT_LT(frames, 100);
  }
}

TEST(FrameBudgets, AreNoneWithoutATime) {
  FrameBudget budget;
  budget.begin(0, 77, false);
  EXPECT_EQ(budget.triangles(), 77u);
  EXPECT_EQ(budget.seconds(), 0);
  budget.note(1000, false);
  EXPECT_TRUE(budget.is_whole());
}

}  // namespace
}  // namespace adamas
