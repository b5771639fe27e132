#include "viewer/window/export_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace adamas::viewer {

void show_export_panel(ViewSession& session, ExportNotice& notice) {
  if (!session.is_exporting && notice.outcome.empty()) return;
  const float em = ImGui::GetFontSize(), width = ImGui::GetIO().DisplaySize.x;
  ImGui::SetNextWindowPos({0.5F * width, 0.8F * em}, ImGuiCond_Always, {0.5F, 0});
  ImGui::SetNextWindowSize({std::min(32 * em, width), 0});
  bool is_open = true;
  ImGui::Begin("Export", session.is_exporting ? nullptr : &is_open,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  if (session.is_exporting) {
    const bool is_known = notice.steps > 0;
    const std::string text = !is_known ? "opening the files"
                             : notice.done == notice.steps
                                 ? "finishing"
                                 : fmt::format("{} of {} steps", notice.done, notice.steps);
    const float part = is_known ? static_cast<float>(notice.done) / static_cast<float>(notice.steps) : 0;
    ImGui::ProgressBar(part, {ImGui::GetContentRegionAvail().x - 9 * em, 0}, text.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Stop (Escape)", {ImGui::GetContentRegionAvail().x, 0}))
      session.wants_export_end = true;
  } else {
    ImGui::TextWrapped("%s", notice.outcome.c_str());
  }
  ImGui::End();
  if (!is_open) notice.outcome.clear();
}

}  // namespace adamas::viewer
