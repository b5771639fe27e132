#include "viewer/window/step_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "core/picture/ticks.h"

namespace adamas {

namespace {

float em() { return ImGui::GetFontSize(); }

/// A line over all steps, with bars where steps are in memory and a mark at the one that is seen; a click or
/// a drag goes to another one.
void show_slider(ViewSession& session, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{width, ImGui::GetFrameHeight()};
  ImGui::InvisibleButton("steps", size);
  const std::size_t count = session.times().size();
  // Each step has a part of the width of its own.
  const float part = size.x / static_cast<float>(count);
  const auto left = [&](std::size_t step) { return at.x + part * static_cast<float>(step); };
  if (ImGui::IsItemActive()) {
    const float wanted = std::floor((ImGui::GetIO().MousePos.x - at.x) / part);
    session.set_step(static_cast<std::uint32_t>(std::clamp(wanted, 0.0F, static_cast<float>(count - 1))));
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(255, 255, 255, 255), 3);
  const float top = at.y + 0.62F * size.y, bottom = at.y + size.y;
  for (const std::uint32_t step : session.ready_steps())
    list.AddRectFilled({left(step), top}, {left(step + 1), bottom}, IM_COL32(96, 150, 110, 255));
  list.AddRect(at, {at.x + size.x, at.y + size.y}, IM_COL32(130, 146, 168, 255), 3);
  constexpr float kLeastWidth = 4;
  const float middle = left(session.step()) + 0.5F * part, half = 0.5F * std::max(part, kLeastWidth);
  list.AddRectFilled({middle - half, at.y}, {middle + half, bottom}, IM_COL32(214, 92, 16, 200), 2);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Green: in memory for this view");
}

void show_pace(StepPace& pace) {
  int repeat = static_cast<int>(pace.repeat);
  ImGui::SetNextItemWidth(9 * em());
  if (ImGui::Combo("##repeat", &repeat, "once\0loop\0there and back\0"))
    pace.repeat = static_cast<Repeat>(repeat);
  ImGui::SameLine();
  ImGui::Checkbox("backward", &pace.is_backward);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(10 * em());
  constexpr double kLeast = 0.5, kMost = 60;
  ImGui::SliderScalar("##speed", ImGuiDataType_Double, &pace.steps_per_second, &kLeast, &kMost,
                      "%.1f steps a second", ImGuiSliderFlags_Logarithmic);
  pace.steps_per_second = std::clamp(pace.steps_per_second, kLeast, kMost);
}

}  // namespace

float step_panel_height(const ViewSession& session) {
  if (!session.has_panels || session.times().size() < 2) return 0;
  const ImGuiStyle& style = ImGui::GetStyle();
  return 2 * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

void show_step_panel(ViewSession& session) {
  const float height = step_panel_height(session);
  if (height == 0) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, size.y - height});
  ImGui::SetNextWindowSize({size.x, height});
  ImGui::Begin("Steps", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
  show_slider(session, ImGui::GetContentRegionAvail().x);
  if (ImGui::Button(session.clock().is_playing() ? "Pause" : "Play", {5 * em(), 0})) session.play_steps();
  ImGui::SameLine();
  if (ImGui::Button("<")) session.act(Action::kPreviousStep);
  ImGui::SameLine();
  if (ImGui::Button(">")) session.act(Action::kNextStep);
  ImGui::SameLine();
  show_pace(session.clock().pace());
  ImGui::SameLine();
  if (session.state().bookmarks.size() > 1) {
    ImGui::Checkbox("along bookmarks", &session.has_keyed_camera);
    ImGui::SameLine();
  }
  const std::uint32_t step = session.step();
  const std::string text =
      fmt::format("step {} of 0 to {}, time {}{}", step, session.times().size() - 1,
                  tidy_number(session.times()[step]), session.report().is_current ? "" : " (coming)");
  ImGui::TextUnformatted(text.c_str());
  ImGui::End();
}

}  // namespace adamas
