// Tests the panel of a series' steps without a screen.

#include <gtest/gtest.h>
#include <imgui.h>

#include "panel_clicks.h"
#include "tests/support/test_series.h"
#include "viewer/window/overlay.h"
#include "viewer/window/panel_context.h"
#include "viewer/window/panels.h"

namespace adamas {

using namespace timevarying;
using namespace viewer;

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
    test::drag([this] { frame(); }, {x, y}, {x, y});
  }
  bool click_item(const char* name) {
    return test::click_item([this] { frame(); }, "Steps", name);
  }

  test::Scratch folder;
  ViewSession session{1000, 800};
  WindowInput input{session};
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

TEST_F(StepPanels, AskForExportsOneAtATime) {
  open(4);
  ASSERT_TRUE(click_item("Film"));
  EXPECT_EQ(session.wants_export, ExportForm::kFilm);
  ASSERT_TRUE(click_item("Images"));
  EXPECT_EQ(session.wants_export, ExportForm::kFrames);
  EXPECT_TRUE(input.key("F"));
  EXPECT_EQ(session.wants_export, ExportForm::kFilm);
  EXPECT_TRUE(input.key("I"));
  EXPECT_EQ(session.wants_export, ExportForm::kFrames);
  // Escape ends the export as soon as one is asked for, and not the program.
  input.key("Escape");
  EXPECT_TRUE(session.wants_export_end);
  EXPECT_FALSE(session.wants_end);
  session.wants_export_end = false;
  // While an export is made no other one can be asked for.
  session.wants_export.reset();
  session.is_exporting = true;
  input.key("F");
  EXPECT_FALSE(session.wants_export);
  input.key("Escape");
  EXPECT_TRUE(session.wants_export_end);
  EXPECT_FALSE(session.wants_end);
  session.wants_export_end = false;
  frame();
  frame();
  ASSERT_TRUE(test::click_item([this] { frame(); }, "Export", "Stop (Escape)"));
  EXPECT_TRUE(session.wants_export_end);
  // The outcome can be read, with panels or without, until it is closed.
  session.is_exporting = false;
  panels.exporting.outcome = "waves-film-001.mp4 was written";
  session.act(Action::kPanels);
  frame();
  frame();
  ASSERT_TRUE(test::click_item([this] { frame(); }, "Export", "#CLOSE"));
  EXPECT_EQ(panels.exporting.outcome, "");
  frame();
  EXPECT_FALSE(ImGui::FindWindowByName("Export")->Active);
  input.key("Escape");
  EXPECT_TRUE(session.wants_end);
}

TEST_F(StepPanels, AskForNoExportWithoutASeries) {
  open(1);
  input.key("F");
  EXPECT_FALSE(session.wants_export);
}

}  // namespace
}  // namespace adamas
