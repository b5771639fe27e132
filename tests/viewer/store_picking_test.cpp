// Tests what a click on the surface of a store reports.

#include <gtest/gtest.h>

#include "ball_store.h"
#include "tests/support/scratch.h"
#include "viewer/session/view_session.h"

namespace adamas {

using namespace isosurface;
using namespace viewer;

namespace {

TEST(StorePicking, PlacesComeToHaveTheErrorOfTheirCells) {
  // The surface at 100 has the radius 10 about (16, 16, 16).
  const test::Scratch folder;
  test::make_ball_store(folder / "ball.adm");
  ViewSession session(640, 480);
  session.open((folder / "ball.adm").string(), {}, SilentProgress::instance());
  session.state().documents[0].surfaces[0].isovalue = 100;
  const auto error_at_middle = [&]() -> std::optional<double> {
    session.finish();
    auto picked = session.pick(320, 240);
    if (!picked) return std::nullopt;
    while (picked->reading.is_pending) session.complete(*picked);
    EXPECT_TRUE(picked->reading.value);
    return picked->reading.error;
  };
  session.state().pixels = 0.25;
  const auto fine = error_at_middle();
  session.state().pixels = 40;
  const auto coarse = error_at_middle();
  ASSERT_TRUE(fine && coarse);
  const Viewpoint& from = session.state().viewpoint;
  const double pixel = 1 / View(from).pixels_at(1, distance(from.eye, {16, 16, 16}));
  EXPECT_LE(*fine, 0.25 * pixel);
  EXPECT_GT(*coarse, 2 * *fine);
  EXPECT_LE(*coarse, 40 * pixel);
  // The second surface has a mesh of its own.
  auto& surfaces = session.state().documents[0].surfaces;
  surfaces.push_back(surfaces[0]);
  surfaces[1].isovalue = 60;
  session.finish();
  auto picked = session.pick(320, 240);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->surface, 1u);
  while (picked->reading.is_pending) session.complete(*picked);
  EXPECT_TRUE(picked->reading.error);
}

}  // namespace
}  // namespace adamas
