#include "viewer/window/panels.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include "ball_store.h"
#include "panel_clicks.h"
#include "tests/support/scratch.h"
#include "viewer/window/overlay.h"
#include "viewer/window/panel_context.h"

namespace adamas {

using namespace isosurface;
using namespace viewer;

namespace {

/// Panels on a store of a ball, used without a screen.
class Panels : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = (folder / "ball.adm").string();
    test::make_ball_store(path);
    session.open(path, {std::size_t{64} << 20, path}, SilentProgress::instance());
    session.finish();
    frame();
    frame();
  }
  void frame() {
    context.begin(1000, 800, 0.02);
    draw_overlay(session);
    show_panels(session, input, panels);
    context.end();
  }
  void drag(float x, float y, float to_x, float to_y) {
    test::drag([this] { frame(); }, {x, y}, {to_x, to_y});
  }
  bool click_item(const char* window, const char* name, std::optional<int> document = {}) {
    return test::click_item([this] { frame(); }, window, name, document);
  }

  test::Scratch folder;
  ViewSession session{1000, 800};
  WindowInput input{session};
  PanelState panels;
  PanelContext context;
};

TEST_F(Panels, ClicksChangeTheState) {
  ASSERT_FALSE(session.state().has_edges);
  ASSERT_TRUE(click_item("adamas", "edges"));
  EXPECT_TRUE(session.state().has_edges);
  ASSERT_TRUE(click_item("adamas", "orthographic"));
  EXPECT_GT(session.state().viewpoint.height, 0);
  ASSERT_TRUE(click_item("adamas", "a plane"));
  EXPECT_TRUE(session.state().cut.is_on);
  ASSERT_TRUE(click_item("adamas", "y"));
  EXPECT_EQ(session.state().cut.plane.normal, (Vec3{0, 1, 0}));
  ASSERT_TRUE(click_item("adamas", "Bookmark"));
  EXPECT_EQ(session.state().bookmarks.size(), 1u);
  ASSERT_TRUE(click_item("adamas", "Play"));
  EXPECT_TRUE(session.is_playing());
}

TEST_F(Panels, TheHistogramMovesTheNearestIsovalue) {
  ImGuiWindow* const window = ImGui::FindWindowByName("adamas");
  ASSERT_TRUE(window);
  ASSERT_TRUE(click_item("adamas", "Another isovalue", 0));
  auto& surfaces = session.state().documents[0].surfaces;
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_LT(surfaces[0].opacity, 1) << "the outer one is seen through";
  surfaces[0].isovalue = 50;
  surfaces[1].isovalue = 150;
  // The histogram is the widest thing below the first header.
  ImGui::GetIO().MousePos = {window->Pos.x + 0.5F * window->Size.x, window->Pos.y + 100};
  frame();
  const float x = window->Pos.x + 0.8F * window->Size.x, y = window->Pos.y + 100;
  drag(x, y, x + 10, y);
  EXPECT_EQ(surfaces[0].isovalue, 50);
  EXPECT_NEAR(surfaces[1].isovalue, 200 * 0.84, 12);
}

TEST_F(Panels, ShowWhatWasPickedAndHelp) {
  frame();
  EXPECT_FALSE(ImGui::FindWindowByName("Place"));
  session.state().viewpoint = Viewpoint{{16, -40, 16}, {16, 16, 16}, {0, 0, 1}};
  session.set_size(1000, 800);
  input.press(MouseButton::kLeft, false, 500, 400);
  input.release(500, 400);
  ASSERT_TRUE(input.picked());
  frame();
  ASSERT_TRUE(ImGui::FindWindowByName("Place"));
  EXPECT_TRUE(ImGui::FindWindowByName("Place")->WasActive || ImGui::FindWindowByName("Place")->Active);
  session.act(Action::kHelp);
  frame();
  EXPECT_TRUE(ImGui::FindWindowByName("Keys and mouse")->Active);
  session.act(Action::kPanels);
  session.act(Action::kHelp);
  frame();
  frame();
  EXPECT_FALSE(ImGui::FindWindowByName("adamas")->Active);
}

TEST_F(Panels, KeepSoManyFramesForTheirPlots) {
  for (int n = 0; n < 1000; ++n) panels.add({1.0 * n, 2, 3, 4});
  EXPECT_LT(panels.history.size(), 1000u);
  EXPECT_EQ(panels.history.back().update_milliseconds, 999);
  ASSERT_TRUE(click_item("adamas", "Statistics"));
  frame();
}

}  // namespace
}  // namespace adamas
