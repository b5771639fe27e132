#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <functional>
#include <optional>

namespace adamas::test {

/// Moves the mouse, presses, moves on and lets go; `frame` shows the panels.
inline void drag(const std::function<void()>& frame, const ImVec2& from, const ImVec2& to) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = from;
  frame();
  io.MouseDown[0] = true;
  frame();
  io.MousePos = to;
  frame();
  frame();
  io.MouseDown[0] = false;
  frame();
  frame();
}

/// Clicks at an item of a window, given by its name and, where there is one, by the number of the part that
/// has it. Places are tried one by one as with a mouse. Returns false where there is no such item.
inline bool click_item(const std::function<void()>& frame, const char* window, const char* name,
                       std::optional<int> part = {}) {
  ImGuiWindow* const found = ImGui::FindWindowByName(window);
  if (found == nullptr || !found->Active) return false;
  const ImGuiID id = part ? ImHashStr(name, 0, found->GetID(*part)) : found->GetID(name);
  for (float y = found->Pos.y + 4; y < found->Pos.y + found->Size.y; y += 6) {
    for (float x = found->Pos.x + 6; x < found->Pos.x + found->Size.x; x += 6) {
      ImGui::GetIO().MousePos = {x, y};
      frame();
      if (ImGui::GetCurrentContext()->HoveredId != id) continue;
      drag(frame, {x, y}, {x, y});
      return true;
    }
  }
  return false;
}

}  // namespace adamas::test
