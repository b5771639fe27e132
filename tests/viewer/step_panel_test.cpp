// The panel of a series' steps, gone through without any screen.

#include "viewer/window/step_panel.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "tests/support/test_series.h"
#include "viewer/window/overlay.h"
#include "viewer/window/panel_context.h"
#include "viewer/window/panels.h"

namespace adamas {
namespace {

using test::Motion;
using test::TestSeries;

constexpr float kWidth = 1000, kHeight = 800;

class StepPanels : public testing::Test {
 protected:
  void open(int steps) {
    const std::string path = (folder / "waves.adm").string();
    const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, steps);
    build_series(path, path, series.source(), test::with_blocks(8));
    session.open(path, {std::size_t{64} << 20, "", 0, false}, SilentProgress::instance());
    session.finish();
    frame();
    frame();
  }
  void frame() {
    context.begin(static_cast<int>(kWidth), static_cast<int>(kHeight), 0.02);
    draw_overlay(session);
    show_panels(session, input, panels);
    context.end();
  }
  static ImGuiWindow* panel() {
    ImGuiWindow* const found = ImGui::FindWindowByName("Steps");
    return found != nullptr && found->Active ? found : nullptr;
  }
  void click(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    frame();
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    ImGui::GetIO().MouseDown[0] = false;
    frame();
  }
  /// Clicks at an item by its name, tried place by place as a mouse would.
  bool click_item(const char* name) {
    const ImGuiID id = panel()->GetID(name);
    for (float y = panel()->Pos.y + 4; y < kHeight; y += 6) {
      for (float x = 4; x < kWidth; x += 6) {
        ImGui::GetIO().MousePos = {x, y};
        frame();
        if (ImGui::GetCurrentContext()->HoveredId != id) continue;
        click(x, y);
        return true;
      }
    }
    return false;
  }

  test::Scratch folder;
  ViewSession session{1000, 800};
  Input input{session};
  PanelState panels;
  PanelContext context;
};

TEST_F(StepPanels, AreThereForSeriesAlone) {
  open(1);
  EXPECT_FALSE(panel());
  EXPECT_EQ(step_panel_height(session), 0);
  open(4);
  ASSERT_TRUE(panel());
  EXPECT_EQ(panel()->Pos.y + panel()->Size.y, kHeight);
  EXPECT_EQ(panel()->Size.y, step_panel_height(session));
  session.act(Action::kPanels);
  frame();
  EXPECT_FALSE(panel());
  EXPECT_EQ(step_panel_height(session), 0);
}

TEST_F(StepPanels, ClicksGoToStepsAndPlay) {
  open(10);
  const float y = panel()->Pos.y + ImGui::GetStyle().WindowPadding.y + 4;
  click(0.55F * kWidth, y);
  EXPECT_EQ(session.step(), 5u);
  click(kWidth - 12, y);
  EXPECT_EQ(session.step(), 9u);
  click(12, y);
  EXPECT_EQ(session.step(), 0u);
  ASSERT_TRUE(click_item(">"));
  EXPECT_EQ(session.step(), 1u);
  ASSERT_TRUE(click_item("<"));
  EXPECT_EQ(session.step(), 0u);
  ASSERT_TRUE(click_item("backward"));
  EXPECT_TRUE(session.clock().pace().is_backward);
  ASSERT_TRUE(click_item("Play"));
  EXPECT_TRUE(session.clock().is_playing());
  ASSERT_TRUE(click_item("Pause"));
  EXPECT_FALSE(session.clock().is_playing());
}

}  // namespace
}  // namespace adamas
