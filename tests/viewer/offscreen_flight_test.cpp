#include <gtest/gtest.h>

#include <functional>

#include "adamas/view.h"
#include "tests/support/scratch.h"
#include "tests/viewer/ball_store.h"

namespace adamas {
namespace {

/// A store that is viewed by the public header alone.
class OffscreenFlights : public testing::Test {
 protected:
  OffscreenFlights() {
    test::make_ball_store(folder_ / "ball.adm");
    view_.files = {folder_ / "ball.adm"};
    view_.isovalues = {100};
    view_.size = {160, 120};
    flight_.camera_path = Orbit{2};
  }

  const test::Scratch folder_;
  ViewOptions view_;
  FlightOptions flight_;
};

TEST_F(OffscreenFlights, DrawAllFrames) {
  flight_.frames = folder_ / "frames";
  OutputSet outputs;
  OffscreenFlight flight(view_, flight_, outputs);
  FlightReport report;
  try {
    report = flight.draw();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  ASSERT_EQ(report.frames.size(), 2u);
  EXPECT_FALSE(report.drawn_by.empty());
  EXPECT_GT(report.bytes, 0u);
  for (const ViewedFrame& frame : report.frames) {
    EXPECT_EQ(frame.problem, "");
    EXPECT_GT(frame.triangles, 0u);
    EXPECT_FALSE(frame.step) << "a store of one step is no series";
  }
  flight.finish();
  EXPECT_FALSE(std::filesystem::exists(flight_.frames));
  flight.commit();
  EXPECT_TRUE(std::filesystem::exists(flight_.frames / "frame0002.png"));
}

TEST_F(OffscreenFlights, RefuseWhatTheyAreNotToDo) {
  const auto refused = [&](const std::function<void(ViewOptions&, FlightOptions&)>& change,
                           const std::string& expected) {
    ViewOptions view = view_;
    FlightOptions flight = flight_;
    change(view, flight);
    OutputSet outputs;
    EXPECT_NE(test::error_of([&] { OffscreenFlight(view, flight, outputs); }).find(expected),
              std::string::npos)
        << expected;
  };
  refused(
      [](auto& view, auto&) {
        view.size = {4, 4};
      },
      "--size: expected a width and a height from 16 to 8192");
  refused(
      [](auto& view, auto&) {
        view.opacities = {0.5, 0.5};
      },
      "--opacity: expected one for each --isovalue");
  refused([](auto& view, auto&) { view.opacities = {2}; }, "--opacity: expected a number above 0");
  refused([](auto& view, auto&) { view.range = {3, 1}; }, "--range: expected a < b in a,b, found '3,1'");
  refused([](auto& view, auto&) { view.pixels = 0; }, "--pixels: expected a positive number");
  refused([](auto& view, auto&) { view.frame_milliseconds = -1; },
          "--frame-time: expected milliseconds from 0");
  refused([](auto& view, auto&) { view.hidden = {"steel"}; },
          "--hide: expected one of no material, found 'steel'");
  refused([](auto& view, auto&) { view.culled_from = CameraPlace{{1, 1, 1}, {1, 1, 1}}; }, "--culled-from: ");
  refused([](auto&, auto& flight) { flight.frame_rate = 5; }, "--frame-rate: expected a --film beside it");
  refused(
      [](auto& view, auto& flight) {
        view.step = 0;
        flight.steps = {0, 1};
      },
      "--steps: expected no --step beside it");
  refused([this](auto& view, auto&) { view.files = {folder_ / "none.adm"}; }, "none.adm");
}

}  // namespace
}  // namespace adamas
