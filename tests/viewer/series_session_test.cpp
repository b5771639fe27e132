// Tests stored series in a session: each step shows the same as a file that is opened at that step.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "core/base/error.h"
#include "tests/support/damaged_step.h"
#include "tests/support/test_series.h"
#include "viewer/session/view_session.h"
#include "viewer/window/window_input.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;
using namespace viewer;

namespace {

using test::Motion;
using test::TestSeries;

constexpr std::uint32_t kSteps = 7;

class SeriesSessions : public testing::Test {
 protected:
  void SetUp() override {
    path = (folder / "waves.adm").string();
    build(path, kSteps, 3);
  }
  static void build(const std::string& name, int steps, std::uint32_t block_steps) {
    const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, steps);
    build_series(name, name, series.source(), test::with_blocks(block_steps));
  }
  [[nodiscard]] std::unique_ptr<ViewSession> session_at(std::uint32_t step, bool waits,
                                                        bool is_coloured = false) const {
    DocumentOptions options;
    options.step = step;
    options.waits_for_pages = waits;
    if (is_coloured) options.colour_by = path;
    auto session = std::make_unique<ViewSession>(320, 240);
    session->open(path, options, SilentProgress::instance());
    session->state().documents[0].surfaces[0].isovalue = 60.5;
    session->state().has_box = false;
    session->state().cut = {true, {{17, 16, 10}, {0.3, 1, 0.2}}, false, true};
    return session;
  }
  /// Returns the parts that are shown when nothing more comes.
  static std::vector<DrawnPart> finished(ViewSession& session) {
    session.finish();
    std::vector<DrawnPart> parts = session.parts();
    while (!session.report().is_current) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      parts = session.parts();
    }
    return session.parts();
  }
  static bool is_same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }
  static bool are_same(const std::vector<DrawnPart>& one, const std::vector<DrawnPart>& other) {
    return std::ranges::equal(one, other, [](const DrawnPart& a, const DrawnPart& b) {
      const auto same_vertex = [](const DrawnMesh::Vertex& v, const DrawnMesh::Vertex& w) {
        return v.place == w.place && v.normal == w.normal && is_same(v.front_value, w.front_value);
      };
      return a.mesh->indices == b.mesh->indices &&
             std::ranges::equal(a.mesh->vertices, b.mesh->vertices, same_vertex);
    });
  }

  test::Scratch folder;
  std::string path;
};

TEST_F(SeriesSessions, ShowAtEachStepWhatAFileThatIsOpenedThereShows) {
  for (const bool waits : {true, false}) {
    for (const bool is_coloured : {false, true}) {
      const auto session = session_at(0, waits, is_coloured);
      ASSERT_EQ(session->times().size(), kSteps);
      EXPECT_EQ(session->times()[3], 1.5);
      std::vector<DrawnPart> last;
      for (const std::uint32_t step : {0u, 1u, 6u, 0u, 3u}) {
        SCOPED_TRACE(testing::Message() << "step " << step << (waits ? " waits" : ""));
        session->set_step(step);
        ASSERT_EQ(session->step(), step);
        const std::vector<DrawnPart> parts = finished(*session);
        EXPECT_EQ(session->report().problem, "");
        const auto fresh = session_at(step, true, is_coloured);
        EXPECT_TRUE(are_same(parts, finished(*fresh)));
        EXPECT_FALSE(are_same(parts, last)) << "waves travel";
        EXPECT_EQ(session->shown_field()->range, fresh->shown_field()->range)
            << "colours mean the same in all steps";
        last = parts;
        const Vec3 place{11.3, 20.8, 7.6};
        const auto value_of = [&place](const ViewSession& of) {
          Reading reading;
          do reading = of.documents()[0]->at(place, of.state().documents[0], 0);
          while (reading.is_pending);
          return reading.value;
        };
        const std::optional<double> value = value_of(*session);
        ASSERT_TRUE(value);
        EXPECT_EQ(value, value_of(*fresh));
      }
    }
  }
}

TEST_F(SeriesSessions, ReadAheadAndShowTheSame) {
  const auto session = session_at(0, false);
  session->advance(0);
  finished(*session);
  // The pages of the next steps come although nobody has asked for them.
  const auto is_ready = [&](std::uint32_t step) {
    const std::vector<LoadedPart> loaded = session->loaded_steps();
    return std::ranges::find(loaded, LoadedPart{step, 1}) != loaded.end();
  };
  for (int n = 0; n < 10'000 && !(is_ready(1) && is_ready(2) && is_ready(3)); ++n)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(is_ready(0) && is_ready(1) && is_ready(2) && is_ready(3));
  EXPECT_FALSE(is_ready(6)) << "nobody needs it";
  session->set_step(1);
  session->finish();
  EXPECT_EQ(session->report().pages_missing, 0u) << "it is whole at once";
  EXPECT_TRUE(are_same(finished(*session), finished(*session_at(1, true))));
}

TEST_F(SeriesSessions, PlayStepAfterStep) {
  const auto session = session_at(0, false);
  StepClock& clock = session->clock();
  clock.pace().repeat = Repeat::kOnce;
  clock.pace().steps_per_second = 50;
  WindowInput input(*session);
  session->set_step(2);
  EXPECT_TRUE(input.key("Space"));
  EXPECT_TRUE(clock.is_playing());
  EXPECT_FALSE(session->is_playing()) << "the camera stays";
  std::vector<std::uint32_t> shown{session->step()};
  for (int n = 0; n < 100'000 && clock.is_playing(); ++n) {
    session->advance(0.001);
    session->parts();
    if (session->step() != shown.back()) shown.push_back(session->step());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(shown, (std::vector<std::uint32_t>{2, 3, 4, 5, 6}));
  EXPECT_TRUE(are_same(finished(*session), finished(*session_at(6, true))));
  input.key("Space");
  EXPECT_EQ(session->step(), 0u) << "from the end it begins anew";
  input.key("Space");
  EXPECT_FALSE(clock.is_playing());
  input.key("End");
  EXPECT_EQ(session->step(), kSteps - 1);
  input.key(".");
  EXPECT_EQ(session->step(), kSteps - 1) << "there is no later one";
  input.key(",");
  EXPECT_EQ(session->step(), kSteps - 2);
  input.key("Home");
  input.key(",");
  EXPECT_EQ(session->step(), 0u);
  input.key(".");
  EXPECT_EQ(session->step(), 1u);
}

TEST_F(SeriesSessions, TakeTheCameraAlongTheBookmarks) {
  const auto session = session_at(0, true);
  session->act(Action::kBookmark);
  const Viewpoint first = session->state().viewpoint;
  session->act(Action::kViewFront);
  session->act(Action::kBookmark);
  const Viewpoint last = session->state().viewpoint;
  session->has_keyed_camera = true;
  session->advance(1);
  EXPECT_EQ(session->state().viewpoint, last) << "nothing plays";
  session->clock().pace() = {10, Repeat::kOnce, false, 0};
  session->play_steps();
  std::vector<Viewpoint> seen;
  while (session->clock().is_playing()) {
    session->advance(0.1);
    if (session->clock().is_playing()) seen.push_back(session->state().viewpoint);
  }
  ASSERT_EQ(seen.size(), kSteps - 1);
  EXPECT_EQ(seen.back(), last);
  double before = 0;
  for (const Viewpoint& each : seen) {
    EXPECT_GT(distance(each.eye, first.eye), before);
    before = distance(each.eye, first.eye);
  }
}

TEST_F(SeriesSessions, TellOfAStepThatIsDamagedAndGoOn) {
  build(path, 10, 3);
  // Step 7 may be coded with the damaged step, step 8 is not.
  test::damage_step(path, 6);
  const auto session = session_at(0, true);
  const std::vector<DrawnPart> first = finished(*session);
  session->state().cut.is_on = false;
  for (const std::uint32_t step : {5u, 8u, 6u, 8u, 5u, 6u, 9u}) {
    SCOPED_TRACE(step);
    session->set_step(step);
    const std::vector<DrawnPart> parts = finished(*session);
    const std::string problem = session->report().problem;
    if (step == 6) {
      EXPECT_NE(problem.find("waves.adm"), std::string::npos) << problem;
      EXPECT_NE(problem.find("(step 6)"), std::string::npos) << problem;
      EXPECT_FALSE(parts.empty()) << "what there was stays to be seen";
      continue;
    }
    EXPECT_EQ(problem, "");
    const auto fresh = session_at(step, true);
    fresh->state().cut.is_on = false;
    EXPECT_TRUE(are_same(parts, finished(*fresh)));
  }
  // When the damaged step is read ahead, neither the step before nor later ones suffer.
  const auto ahead = session_at(5, false);
  ahead->advance(0);
  finished(*ahead);
  while (ahead->documents()[0]->steps_ahead().is_reading)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(are_same(finished(*ahead), finished(*session_at(5, true))));
  EXPECT_EQ(ahead->report().problem, "");
  ahead->set_step(6);
  finished(*ahead);
  EXPECT_NE(ahead->report().problem.find("waves.adm"), std::string::npos) << ahead->report().problem;
  ahead->set_step(8);
  EXPECT_TRUE(are_same(finished(*ahead), finished(*session_at(8, true))));
  EXPECT_EQ(ahead->report().problem, "");
}

TEST_F(SeriesSessions, PlayPastAStepThatIsDamagedAndNameIt) {
  build(path, 10, 3);
  test::damage_step(path, 6);
  for (const bool waits : {true, false}) {
    SCOPED_TRACE(waits);
    const auto session = session_at(5, waits);
    session->state().cut.is_on = false;
    finished(*session);
    EXPECT_TRUE(session->lost_steps().empty());
    session->clock().pace() = {50, Repeat::kOnce, false, 0.5};
    session->play_steps();
    std::vector<std::uint32_t> shown{session->step()};
    for (int n = 0; n < 100'000 && session->clock().is_playing(); ++n) {
      session->advance(0.001);
      finished(*session);
      if (session->step() != shown.back()) shown.push_back(session->step());
      if (session->step() == 6) {
        EXPECT_EQ(session->drawn_step(), 5u) << "the last one stays to be seen";
      } else if (session->step() != 7) {
        EXPECT_EQ(session->drawn_step(), session->step());
      }
    }
    EXPECT_EQ(shown, (std::vector<std::uint32_t>{5, 6, 7, 8, 9}));
    EXPECT_TRUE(session->lost_steps().contains(6));
    for (const std::uint32_t lost : session->lost_steps()) EXPECT_TRUE(lost == 6 || lost == 7) << lost;
    EXPECT_TRUE(are_same(finished(*session), [&] {
      const auto fresh = session_at(9, true);
      fresh->state().cut.is_on = false;
      return finished(*fresh);
    }()));
  }
}

TEST_F(SeriesSessions, NameADamagedStepThatIsThereOnlyAfterItWasLookedFor) {
  build(path, 10, 3);
  test::damage_step(path, 6);
  const auto session = session_at(0, true);
  session->state().cut.is_on = false;
  session->set_step(6);
  session->parts();
  while (!session->report().is_current) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  session->advance(0);
  EXPECT_EQ(session->lost_steps(), std::set<std::uint32_t>{6});
  // The loss does not extend to the step that comes next.
  session->set_step(9);
  session->advance(0);
  EXPECT_EQ(session->lost_steps(), std::set<std::uint32_t>{6});
}

TEST_F(SeriesSessions, TellHowMuchOfEachStepIsInMemoryHoweverFarAway) {
  constexpr std::uint32_t kMany = 24;
  build(path, kMany, 3);
  const auto session = session_at(0, true);
  session->state().cut.is_on = false;
  const auto loaded = [&] {
    while (session->documents()[0]->steps_ahead().is_reading)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return session->loaded_steps();
  };
  const auto wait_for = [&](const auto& holds) {
    for (int n = 0; n < 10'000 && !holds(); ++n) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return holds();
  };
  for (std::uint32_t step = 0; step < kMany; ++step) {
    session->set_step(step);
    session->advance(0);
    finished(*session);
    const auto has_it = [&] {
      const std::vector<LoadedPart> now = loaded();
      return std::ranges::find(now, LoadedPart{step, 1}) != now.end();
    };
    EXPECT_TRUE(wait_for(has_it)) << step;
  }
  // All steps that were seen are still in memory, the first as well as the last.
  EXPECT_TRUE(wait_for([&] { return loaded().size() == kMany; }));
  const std::vector<LoadedPart> all = loaded();
  for (std::uint32_t step = 0; step < std::min<std::size_t>(kMany, all.size()); ++step)
    EXPECT_EQ(all[step], (LoadedPart{step, 1}));
  // The same holds where no further step is to come.
  session->clock().pace().repeat = Repeat::kOnce;
  for (const std::uint32_t step : {kMany - 2, kMany - 1}) {
    session->set_step(step);
    session->advance(0);
    finished(*session);
  }
  EXPECT_EQ(loaded().size(), kMany);
}

TEST_F(SeriesSessions, KeepTheStepInTheirState) {
  const auto session = session_at(4, true);
  EXPECT_EQ(session->step(), 4u);
  session->set_step(5);
  const ViewState again = view_state(to_text(session->state()), "state");
  EXPECT_EQ(again.documents, session->state().documents);
  const auto other = session_at(0, true);
  other->restore(again);
  EXPECT_EQ(other->step(), 5u);
  EXPECT_TRUE(are_same(finished(*other), finished(*session)));
  // A state without a step, as older files have it, means the first step.
  session->set_step(0);
  EXPECT_EQ(to_text(session->state()).find("step"), std::string::npos);
  other->restore(view_state(to_text(session->state()), "state"));
  EXPECT_EQ(other->step(), 0u);
  // Files of fewer steps show their last one.
  build(path, 3, 3);
  const auto shorter = session_at(0, true);
  shorter->restore(again);
  EXPECT_EQ(shorter->step(), 2u);
  build(path, 1, 3);
  const auto single = session_at(4, true);
  single->restore(again);
  EXPECT_EQ(single->step(), 0u);
  EXPECT_EQ(single->report().problem, "");
  EXPECT_FALSE(finished(*single).empty());
}

TEST(NamedSteps, AreAFewOfThem) {
  EXPECT_EQ(named_steps({3}), "step 3");
  EXPECT_EQ(named_steps({3, 1}), "steps 1 and 3");
  EXPECT_EQ(named_steps({1, 2, 3, 4, 5, 9}), "steps 1, 2, 3, 4, 5 and 9");
  EXPECT_EQ(named_steps({1, 2, 3, 4, 5, 9, 10, 30}), "steps 1, 2, 3, 4, 5, 9 and 2 more");
}

TEST_F(SeriesSessions, RememberHowTheyArePlayed) {
  const auto session = session_at(0, true);
  session->clock().pace() = {12.5, Repeat::kThereAndBack, true, 0.5};
  const ViewState kept = view_state(to_text(session->remembered()), "state");
  const auto other = session_at(0, true);
  EXPECT_FALSE(other->clock().pace() == session->clock().pace());
  other->restore(kept);
  EXPECT_EQ(other->clock().pace(), session->clock().pace());
}

TEST_F(SeriesSessions, ShowSeriesTogetherAndRefuseColoursOfOtherSteps) {
  const std::string shorter = (folder / "short.adm").string();
  build(shorter, 3, 3);
  const auto session = session_at(6, true);
  session->open(shorter, {}, SilentProgress::instance());
  EXPECT_EQ(session->step(), 6u);
  EXPECT_EQ(session->state().documents[1].step, 2u);
  session->set_step(1);
  EXPECT_EQ(session->state().documents[0].step, 1u);
  EXPECT_EQ(session->state().documents[1].step, 1u);
  DocumentOptions options;
  options.colour_by = shorter;
  try {
    session->open(path, options, SilentProgress::instance());
    FAIL() << "it was opened";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("short.adm: expected one step or the 7"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace adamas
