// Tests what the window writes of all steps of a series, with an OpenGL context and no window.

#include "viewer/window/step_export.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <set>
#include <thread>

#include "core/base/child_process.h"
#include "core/picture/canvas.h"
#include "tests/support/damaged_step.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/test_series.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/session/camera_control.h"
#include "viewer/window/offscreen_pictures.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;
using namespace picture;
using namespace viewer;

namespace {

namespace fs = std::filesystem;
using test::Motion;
using test::TestSeries;

constexpr std::uint32_t kSteps = 5;
constexpr int kWidth = 160, kHeight = 120;

class StepExports : public testing::Test {
 protected:
  StepExports() : programs_(std::getenv("PATH")) {}
  ~StepExports() override { ::setenv("PATH", programs_.c_str(), 1); }

  void SetUp() override {
    build(kSteps, 3);
    try {
      context.emplace();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    session = opened(false);
  }
  void build(int steps, std::uint32_t block_steps) const {
    const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, steps);
    build_series(path().string(), path().string(), series.source(), test::with_blocks(block_steps));
  }
  [[nodiscard]] fs::path path() const { return folder / "waves.adm"; }
  [[nodiscard]] std::unique_ptr<ViewSession> opened(bool waits) const {
    auto result = std::make_unique<ViewSession>(kWidth, kHeight);
    DocumentOptions options;
    options.waits_for_pages = waits;
    result->open(path().string(), options, SilentProgress::instance());
    result->state().documents[0].surfaces[0].isovalue = 60.5;
    result->act(Action::kViewRight);
    return result;
  }
  [[nodiscard]] std::unique_ptr<StepExport> begun(ExportForm form) const {
    return std::make_unique<StepExport>(*session, ExportRequest{form, kWidth, kHeight, 1});
  }
  static std::string outcome_of(StepExport& work) {
    while (work.go_on()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return work.outcome();
  }
  /// Returns the names of all files in the folder except the series.
  [[nodiscard]] std::set<std::string> written() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.folder())) names.insert(entry.path().filename());
    names.erase("waves.adm");
    return names;
  }
  /// Returns the bytes of the picture of a step that is drawn without a window.
  [[nodiscard]] std::string picture(std::uint32_t step, const Viewpoint& viewpoint) {
    // Only one context is current at a time.
    context.reset();
    std::optional<Raster> raster;
    {
      const auto other = opened(true);
      other->set_step(step);
      raster = OffscreenPictures(*other, kWidth, kHeight).draw(viewpoint);
    }
    context.emplace();
    const test::Scratch apart;
    write_png(apart / "p.png", raster.value());
    return test::bytes_of(apart / "p.png");
  }
  [[nodiscard]] fs::path image(const std::string& name, int number) const {
    return folder / name / fmt::format("frame{:04}.png", number);
  }

  test::Scratch folder;
  std::optional<OffscreenContext> context;
  std::unique_ptr<ViewSession> session;

 private:
  std::string programs_;
};

TEST_F(StepExports, WriteWhatAFlightWithoutAWindowDraws) {
  session->set_step(2);
  const std::string state = to_text(session->remembered());
  std::vector<std::string> expected;
  for (std::uint32_t step = 0; step < kSteps; ++step)
    expected.push_back(picture(step, session->state().viewpoint));
  EXPECT_EQ((std::set<std::string>(expected.begin(), expected.end())).size(), kSteps);
  const auto work = begun(ExportForm::kFrames);
  EXPECT_EQ(outcome_of(*work),
            image("waves-images-001", 1).parent_path().string() + " was written: 5 images");
  EXPECT_EQ(work->done(), kSteps);
  EXPECT_EQ(work->steps(), kSteps);
  EXPECT_EQ(written(), std::set<std::string>{"waves-images-001"});
  for (std::uint32_t step = 0; step < kSteps; ++step)
    EXPECT_TRUE(test::bytes_of(image("waves-images-001", static_cast<int>(step) + 1)) == expected[step])
        << step;
  EXPECT_EQ(to_text(session->remembered()), state) << "the view is as it was";
}

TEST_F(StepExports, GoAlongTheBookmarks) {
  session->act(Action::kBookmark);
  session->act(Action::kViewFront);
  session->act(Action::kBookmark);
  session->act(Action::kViewTop);
  session->has_keyed_camera = true;
  const std::vector<Viewpoint> path = session->bookmarked();
  const std::string first = picture(0, path[0]), last = picture(kSteps - 1, path[1]),
                    middle = picture(2, along(path, 2, kSteps));
  outcome_of(*begun(ExportForm::kFrames));
  EXPECT_TRUE(test::bytes_of(image("waves-images-001", 1)) == first);
  EXPECT_TRUE(test::bytes_of(image("waves-images-001", 3)) == middle);
  EXPECT_TRUE(test::bytes_of(image("waves-images-001", kSteps)) == last);
}

TEST_F(StepExports, TakeNoNameThatThereIs) {
  test::put_bytes(folder / "waves-images-001", "mine");
  const auto work = begun(ExportForm::kFrames);
  while (work->done() < 2) {
    ASSERT_TRUE(work->go_on());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (const std::string& name : written()) EXPECT_EQ(name.find("waves-images-002"), std::string::npos);
  // A folder with this name appears before the export is complete.
  fs::create_directory(folder / "waves-images-002");
  EXPECT_TRUE(test::says(outcome_of(*work), "waves-images-003 was written"));
  EXPECT_EQ(test::bytes_of(folder / "waves-images-001"), "mine");
  EXPECT_TRUE(fs::is_empty(folder / "waves-images-002"));
  EXPECT_EQ(written(), (std::set<std::string>{"waves-images-001", "waves-images-002", "waves-images-003"}));
}

TEST_F(StepExports, MakeAFilm) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  EXPECT_TRUE(test::says(outcome_of(*begun(ExportForm::kFilm)), "waves-film-001.mp4 was written: 5 steps"));
  EXPECT_EQ(test::bytes_of(folder / "waves-film-001.mp4").substr(4, 4), "ftyp");
  const std::string command =
      fmt::format("ffmpeg -loglevel error -nostdin -i '{}' '{}'", (folder / "waves-film-001.mp4").string(),
                  (folder / "of-film-%d.png").string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(fs::exists(folder / "of-film-5.png"));
  EXPECT_FALSE(fs::exists(folder / "of-film-6.png"));
}

TEST_F(StepExports, MakeImagesAndSaySoWhereThereIsNoFfmpeg) {
  ::setenv("PATH", folder.folder().c_str(), 1);
  const std::string outcome = outcome_of(*begun(ExportForm::kFilm));
  EXPECT_TRUE(test::says(outcome, "waves-images-001 was written: 5 images, no film: the program ffmpeg"));
  EXPECT_TRUE(fs::exists(image("waves-images-001", kSteps)));
  EXPECT_EQ(written(), std::set<std::string>{"waves-images-001"});
}

TEST_F(StepExports, LeaveNothingWhereTheyAreStopped) {
  for (const ExportForm form : {ExportForm::kFrames, ExportForm::kFilm}) {
    for (const std::size_t done : {0u, 1u, 3u}) {
      auto work = begun(form);
      do {
        ASSERT_TRUE(work->go_on());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      } while (work->done() < done);
      work.reset();
      EXPECT_EQ(written(), std::set<std::string>{});
    }
  }
}

TEST_F(StepExports, SayInALineWhatWentWrong) {
  {
    const test::FileSizeLimit full(1000);
    const std::string outcome = outcome_of(*begun(ExportForm::kFrames));
    EXPECT_TRUE(test::says(outcome, "Nothing was written: "));
    EXPECT_TRUE(test::says(outcome, "waves-images-001/frame0001.png"));
    EXPECT_EQ(outcome.find("partial"), std::string::npos) << outcome;
  }
  if (!find_program("ffmpeg").empty()) {
    const test::FileSizeLimit full(1000);
    const std::string outcome = outcome_of(*begun(ExportForm::kFilm));
    EXPECT_TRUE(test::says(outcome, "waves-film-001.mp4: ffmpeg could not make the film"));
  }
  EXPECT_EQ(written(), std::set<std::string>{});
  if (::geteuid() != 0) {
    fs::permissions(folder.folder(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_TRUE(test::says(outcome_of(*begun(ExportForm::kFrames)), "expected a writable folder"));
    fs::permissions(folder.folder(), fs::perms::owner_all);
  }
  fs::remove(path());
  EXPECT_TRUE(test::says(outcome_of(*begun(ExportForm::kFrames)), "waves.adm"));
  EXPECT_EQ(written(), std::set<std::string>{});
}

TEST_F(StepExports, LeaveOutStepsThatAreDamagedAndNameThem) {
  build(9, 3);
  test::damage_step(path(), 8);
  session = opened(false);
  const std::string outcome = outcome_of(*begun(ExportForm::kFrames));
  EXPECT_TRUE(test::says(outcome, "waves-images-001 was written: 8 images, without step 8: "));
  EXPECT_TRUE(test::says(outcome, "waves.adm"));
  for (int number = 1; number <= 8; ++number) EXPECT_TRUE(fs::exists(image("waves-images-001", number)));
  EXPECT_FALSE(fs::exists(image("waves-images-001", 9)));
  for (std::uint32_t step = 0; step < 8; ++step) test::damage_step(path(), step);
  EXPECT_TRUE(test::says(outcome_of(*begun(ExportForm::kFrames)), "Nothing was written: "));
  EXPECT_EQ(written(), std::set<std::string>{"waves-images-001"});
}

}  // namespace
}  // namespace adamas
