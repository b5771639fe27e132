#include "timevarying/page_loader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using Sample = std::uint8_t;
using test::CameraPath;
using test::chunks_of;
using test::expect_same;
using test::MemoryVolume;
using test::OpenStore;

MemoryVolume<Sample> waves(const test::Dimensions& dimensions) {
  return {dimensions,
          [](LatticePoint p) { return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j); }};
}

FrameRequest request(CameraPath& path) {
  FrameRequest result;
  result.viewpoint = path.next();
  result.isovalue = 80.5;
  result.pixels = 1.5;
  result.resident_only = true;
  return result;
}

/// Refines frames of one view until nothing is missing or nothing more comes, at most `most` times. Returns
/// the number of frames.
std::size_t sharpen(PagedFrames<Sample>& frames, PageLoader<Sample>& loader, const FrameRequest& wanted,
                    FrameFigures& figures, std::size_t most = 10'000) {
  for (std::size_t n = 1; n <= most; ++n) {
    figures = frames.refine(wanted);
    if (figures.pages_missing == 0) return n;
    loader.want(frames.missing_pages());
    loader.wait();
    const auto taken = loader.take(frames.pages(), frames.gradients());
    if (taken.pages.empty() && loader.is_idle()) return n;
  }
  ADD_FAILURE() << "frames do not come to an end";
  return most;
}

void fly(const StoreOptions& options, std::size_t threads) {
  const MemoryVolume<Sample> volume = waves({90, 44, 60});
  OpenStore<Sample> store, other;
  for (OpenStore<Sample>* each : {&store, &other}) {
    test::build(each->path(), volume, options);
    each->open();
  }
  PagedFrames<Sample> frames(store.pages()), expected(other.pages());
  PageLoader<Sample> loader(
      store.pages(), 1 << 20, [] {}, threads);
  CameraPath path(volume.grid.box(), 3);
  std::size_t most = 0;
  for (int n = 0; n < 6; ++n) {
    FrameRequest wanted = request(path);
    FrameFigures figures;
    most = std::max(most, sharpen(frames, loader, wanted, figures));
    test::expect_sound(frames.contour(), volume.grid.box());
    EXPECT_EQ(figures.pages_missing, 0u);
    wanted.resident_only = false;
    EXPECT_EQ(expected.refine(wanted).largest_error, figures.largest_error);
    expect_same(chunks_of(frames), chunks_of(expected));
  }
  EXPECT_GT(most, 3u);
  EXPECT_EQ(loader.problem(), "");
}

TEST(PageLoader, BringsWhatFramesLackUntilTheyAreThoseThatWait) {
  for (const std::size_t threads : {1, 3}) fly({}, threads);
}

TEST(PageLoader, BringsStoredGradientsToo) {
  StoreOptions options;
  options.gradients = true;
  for (const std::size_t threads : {1, 4}) fly(options, threads);
}

TEST(PageLoader, CanBeDestroyedAtAnyTime) {
  const MemoryVolume<Sample> volume = waves({90, 44, 60});
  OpenStore<Sample> store(volume);
  CameraPath path(volume.grid.box(), 4);
  PagedFrames<Sample> frames(store.pages());
  for (int n = 0; n < 20; ++n) {
    frames.refine(request(path));
    PageLoader<Sample> loader(
        store.pages(), 1 << 20, [] {}, 1 + n % 3);
    loader.want(frames.missing_pages());
    for (int waits = 0; waits < n % 4; ++waits) loader.wait();
    if (n % 3 == 0) loader.take(frames.pages(), frames.gradients());
    test::expect_sound(frames.contour(), volume.grid.box());
  }
}

TEST(PageLoader, LeavesFramesWithinTheirMemory) {
  // The surface crosses more pages than there is room for.
  const MemoryVolume<Sample> volume = waves({200, 60, 60});
  OpenStore<Sample> store(volume);
  store.open(0);
  const std::size_t least = PageMemory<Sample>::kLeast;
  PagedFrames<Sample> frames(store.pages());
  PageLoader<Sample> loader(store.pages(), 1 << 20);
  FrameRequest wanted;
  wanted.isovalue = 80.5;
  wanted.resident_only = true;
  wanted.viewpoint.up = {0, 0, 1};
  std::size_t lacking = 0, whole = 0;
  for (int n = 0; n < 12; ++n) {
    // The camera is far away, then near one end, then near the other.
    const double away = n % 3 == 0 ? 260 : 20;
    wanted.pixels = n % 3 == 0 ? 30 : 1;
    wanted.viewpoint.target = {n % 3 == 1 ? 20.0 : n % 3 == 2 ? 180.0 : 100.0, 30, 30};
    wanted.viewpoint.eye = wanted.viewpoint.target + Vec3{1, -away, 2};
    wanted.viewpoint.field_of_view = 0.6;
    FrameFigures figures;
    // Each page comes at most once for a view, so the number of frames is bounded.
    std::set<std::pair<std::uint64_t, MissingPage::Part>> come;
    for (bool is_full = false; !is_full;) {
      figures = frames.refine(wanted);
      EXPECT_LE(store.pages().held_pages().size(), least);
      test::expect_sound(frames.contour(), volume.grid.box());
      if (figures.pages_missing == 0) break;
      loader.want(frames.missing_pages());
      loader.wait();
      const auto taken = loader.take(frames.pages(), frames.gradients());
      is_full = !taken.without_room.empty();
      for (const MissingPage& page : taken.pages)
        is_full = !come.emplace(store.pages().grid().number(page.id), page.part).second || is_full;
    }
    (figures.pages_missing == 0 ? whole : lacking) += 1;
  }
  EXPECT_GT(lacking, 3u);
  EXPECT_GT(whole, 3u);
  EXPECT_GT(store.pages().evicted_pages(), 50u);
}

/// Expects sound frames after something has happened to the file while it is open, and that the loader
/// reports this problem alone.
void expect_survival(const std::function<void(const std::filesystem::path&)>& happens, const char* problem) {
  const MemoryVolume<Sample> volume = waves({90, 44, 60});
  OpenStore<Sample> store(volume);
  PagedFrames<Sample> frames(store.pages());
  PageLoader<Sample> loader(
      store.pages(), 0, [] {}, 2);
  CameraPath path(volume.grid.box(), 3);
  FrameFigures figures;
  frames.refine(request(path));
  happens(store.path());
  for (int n = 0; n < 6; ++n) {
    FrameRequest wanted = request(path);
    sharpen(frames, loader, wanted, figures);
    test::expect_sound(frames.contour(), volume.grid.box());
    EXPECT_EQ(figures.pages_missing, 0u) << "what cannot be had is not asked for again";
    EXPECT_EQ(figures.triangles, frames.contour().triangles.size());
    if (figures.pages_lost > 0) {
      EXPECT_GT(figures.largest_error, wanted.pixels);
    }
  }
  EXPECT_NE(loader.problem().find(problem), std::string::npos) << loader.problem();
  EXPECT_EQ(loader.problem().empty(), *problem == 0);
  EXPECT_EQ(loader.problem().find('\n'), std::string::npos);
}

TEST(PageLoader, TellsOfAFileThatIsCutOff) {
  expect_survival([](const auto& path) { std::filesystem::resize_file(path, 4000); }, "store.adm");
}

TEST(PageLoader, TellsOfAFileThatIsChanged) {
  expect_survival(
      [](const auto& path) {
        const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        for (std::streamoff at = 64; at < size; at += 97) {
          file.seekp(at);
          file.put('\x5a');
        }
      },
      "damaged");
}

TEST(PageLoader, DoesNotMindAFileThatIsRemoved) {
  expect_survival([](const auto& path) { std::filesystem::remove(path); }, "");
}

}  // namespace
}  // namespace adamas
