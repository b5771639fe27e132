#include "viewer/window/step_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/picture/ticks.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;
using namespace timevarying;

namespace {

float em() { return ImGui::GetFontSize(); }

constexpr ImU32 kLoaded = IM_COL32(96, 150, 110, 255), kLost = IM_COL32(176, 24, 24, 255);

/// Of each step as high as the part of it that is in memory; red where a step could not be shown.
void draw_loaded(ImDrawList& list, const ViewSession& session, const ImVec2& at, const ImVec2& size) {
  const float part = size.x / static_cast<float>(session.times().size()), bottom = at.y + size.y;
  const auto bar = [&](std::uint32_t step, double height, ImU32 colour) {
    const float left = at.x + part * static_cast<float>(step);
    list.AddRectFilled({left, bottom - 0.4F * size.y * static_cast<float>(height)},
                       {left + std::max(part, 1.0F), bottom}, colour);
  };
  for (const LoadedPart& loaded : session.loaded_steps()) bar(loaded.step, loaded.part, kLoaded);
  for (const std::uint32_t step : session.lost_steps()) bar(step, 1, kLost);
}

/// A line over all steps, with bars of what is in memory and a mark at the step that is seen; a click or
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
  draw_loaded(list, session, at, size);
  list.AddRect(at, {at.x + size.x, at.y + size.y}, IM_COL32(130, 146, 168, 255), 3);
  constexpr float kLeastWidth = 4;
  const float middle = left(session.step()) + 0.5F * part, half = 0.5F * std::max(part, kLeastWidth);
  list.AddRectFilled({middle - half, at.y}, {middle + half, at.y + size.y}, IM_COL32(214, 92, 16, 200), 2);
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetNextWindowPos({ImGui::GetIO().MousePos.x, at.y - 0.5F * em()}, ImGuiCond_Always, {0.5F, 1});
  ImGui::SetTooltip("Green: how much of a step is in memory for this view\nRed: damaged, it cannot be shown");
}

void show_pace(StepPace& pace) {
  int repeat = static_cast<int>(pace.repeat);
  ImGui::SetNextItemWidth(8.5F * em());
  if (ImGui::Combo("##repeat", &repeat, "once\0loop\0there and back\0"))
    pace.repeat = static_cast<Repeat>(repeat);
  ImGui::SameLine();
  ImGui::Checkbox("backward", &pace.is_backward);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(10 * em());
  ImGui::SliderScalar("##speed", ImGuiDataType_Double, &pace.steps_per_second, &kSlowest, &kFastest,
                      "%.1f steps a second", ImGuiSliderFlags_Logarithmic);
  pace.steps_per_second = std::clamp(pace.steps_per_second, kSlowest, kFastest);
}

/// One button for each form of export.
void show_export(ViewSession& session) {
  ImGui::BeginDisabled(session.is_exporting);
  if (ImGui::Button("Film")) session.act(Action::kExportFilm);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Writes all steps as a film beside the file, from here or along the bookmarks (F)");
  ImGui::SameLine();
  if (ImGui::Button("Images")) session.act(Action::kExportFrames);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Writes an image of each step into a folder beside the file (I)");
  ImGui::EndDisabled();
}

/// Which steps cannot be seen, and which one is.
void show_text(const ViewSession& session) {
  const std::uint32_t step = session.step();
  const std::string seen =
      fmt::format("step {} of 0 to {}, time {}{}", step, session.times().size() - 1,
                  tidy_number(session.times()[step]), session.report().is_current ? "" : " (coming)");
  const std::set<std::uint32_t>& lost = session.lost_steps();
  if (!lost.empty()) {
    const std::string text = "damaged: " + named_steps(lost);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kLost), "%s", text.c_str());
    ImGui::SameLine();
  }
  ImGui::TextUnformatted(seen.c_str());
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
  show_export(session);
  ImGui::SameLine();
  show_text(session);
  ImGui::End();
}

}  // namespace adamas::viewer
