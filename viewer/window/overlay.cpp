#include "viewer/window/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/picture/colour_map.h"
#include "core/picture/ticks.h"
#include "viewer/session/picking.h"
#include "viewer/window/panels.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

constexpr ImU32 kText = IM_COL32(30, 30, 34, 255), kPale = IM_COL32(255, 255, 255, 215);

ImU32 packed(const Colour& colour) {
  const auto [r, g, b] = to_bytes(colour);
  return IM_COL32(r, g, b, 255);
}

float line_height() { return ImGui::GetTextLineHeight(); }

void draw_axes(ImDrawList& list, const Viewpoint& viewpoint, float height) {
  const ViewAxes axes(viewpoint);
  const float length = 2.6F * line_height(), x = 1.6F * length, y = height - 1.6F * length;
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  constexpr std::array<ImU32, 3> kColours{IM_COL32(196, 48, 43, 255), IM_COL32(38, 132, 62, 255),
                                          IM_COL32(48, 86, 190, 255)};
  std::array<int, 3> order{0, 1, 2};
  // Axes that point away come first, so that nearer ones are drawn over them.
  std::ranges::sort(order, std::greater<>{}, [&](int axis) { return axes.forward[axis]; });
  for (const int axis : order) {
    const auto n = static_cast<std::size_t>(axis);
    const ImVec2 end{x + length * static_cast<float>(axes.right[axis]),
                     y - length * static_cast<float>(axes.up[axis])};
    list.AddLine({x, y}, end, kColours[n], 2);
    const ImVec2 size = ImGui::CalcTextSize(kNames[n]);
    const ImVec2 at{x + 1.25F * (end.x - x) - 0.5F * size.x, y + 1.25F * (end.y - y) - 0.5F * size.y};
    list.AddText(at, kColours[n], kNames[n]);
  }
}

void draw_colour_bar(ImDrawList& list, const ViewSession& session, float width, float height) {
  const auto field = session.shown_field();
  if (!field) return;
  const ColourMap map = ColourMap::by_name(session.state().colour_map);
  const float bar_width = line_height(), bar_height = 0.45F * height;
  const float left = width - 6.5F * line_height(), top = 0.28F * height;
  list.AddRectFilled({left - 0.6F * bar_width, top - 2.2F * line_height()},
                     {width - 0.5F * line_height(), top + bar_height + line_height()}, kPale, 4);
  constexpr int kParts = 128;
  for (int n = 0; n < kParts; ++n) {
    const auto at = [&](int part) { return top + bar_height * static_cast<float>(part) / kParts; };
    list.AddRectFilled({left, at(n)}, {left + bar_width, at(n + 1)}, packed(map.at(1 - (n + 0.5) / kParts)));
  }
  list.AddRect({left, top}, {left + bar_width, top + bar_height}, kText);
  // A long name extends to the left.
  const float name_width = ImGui::CalcTextSize(field->name.c_str()).x;
  list.AddText(
      {std::min(left - 0.3F * bar_width, width - name_width - line_height()), top - 1.7F * line_height()},
      kText, field->name.c_str());
  const auto [low, high] = field->range;
  if (!(high > low)) return;
  const Ticks ticks = linear_ticks(low, high, 5);
  for (std::size_t n = 0; n < ticks.positions.size(); ++n) {
    const float y = top + bar_height * static_cast<float>((high - ticks.positions[n]) / (high - low));
    list.AddLine({left + bar_width, y}, {left + 1.3F * bar_width, y}, kText);
    list.AddText({left + 1.5F * bar_width, y - 0.5F * line_height()}, kText, ticks.labels[n].c_str());
  }
}

std::string time_text(double time) { return "time " + tidy_number(time); }

/// The width of the widest time of a step, so that the text keeps its place while steps are played.
float widest_time(const std::vector<double>& times, float font_size) {
  constexpr std::size_t kSome = 64;
  float widest = 0;
  for (std::size_t n = 0; n < times.size(); n += 1 + times.size() / kSome) {
    const std::string text = time_text(times[n]);
    widest = std::max(widest, ImGui::GetFont()->CalcTextSizeA(font_size, FLT_MAX, 0, text.c_str()).x);
  }
  return widest;
}

/// Draws the time of the present step at the lower right.
void draw_time(ImDrawList& list, const ViewSession& session, float width, float bottom) {
  const std::vector<double>& times = session.times();
  if (times.size() < 2) return;
  const std::uint32_t step = session.drawn_step();
  const std::string number = fmt::format("step {} of 0 to {}", step, times.size() - 1);
  const std::string longest = fmt::format("step {0} of 0 to {0}", times.size() - 1);
  const float large = 1.4F * ImGui::GetFontSize(), margin = 0.5F * line_height();
  const float room = std::max(ImGui::CalcTextSize(longest.c_str()).x, widest_time(times, large));
  const float left = width - room - 2.5F * margin, top = bottom - large - line_height() - 3 * margin;
  list.AddRectFilled({left - margin, top - margin}, {width - margin, bottom - margin}, kPale, 4);
  list.AddText(ImGui::GetFont(), large, {left, top - 0.4F * margin}, kText, time_text(times[step]).c_str());
  list.AddText({left, top + large}, kText, number.c_str());
}

/// Draws the visible materials, one below the other.
void draw_materials(ImDrawList& list, const ViewSession& session, float height) {
  constexpr std::size_t kMost = 24;
  std::vector<std::pair<std::string, Colour>> names;
  for (std::size_t n = 0; n < session.documents().size(); ++n) {
    const DocumentFacts& facts = session.documents()[n]->facts();
    const DocumentState& state = session.state().documents[n];
    for (std::size_t m = 0; m < facts.materials.size(); ++m) {
      if (!state.hidden.contains(facts.materials[m]))
        names.emplace_back(facts.materials[m], facts.material_colours[m]);
    }
  }
  if (names.empty() || names.size() > kMost) return;
  const float step = 1.25F * line_height(), side = 0.9F * line_height();
  float widest = 0;
  for (const auto& [name, colour] : names) widest = std::max(widest, ImGui::CalcTextSize(name.c_str()).x);
  const float left = 9 * line_height(),
              top = height - 0.8F * line_height() - step * static_cast<float>(names.size());
  list.AddRectFilled({left - 0.5F * side, top - 0.3F * side},
                     {left + widest + 2.2F * side, top + step * static_cast<float>(names.size())}, kPale, 4);
  for (std::size_t n = 0; n < names.size(); ++n) {
    const float y = top + step * static_cast<float>(n);
    list.AddRectFilled({left, y}, {left + side, y + side}, packed(names[n].second), 2);
    list.AddText({left + 1.5F * side, y - 0.05F * side}, kText, names[n].first.c_str());
  }
}

void draw_handle(ImDrawList& list, const ViewSession& session) {
  const ViewState& state = session.state();
  if (!state.cut.is_on || !session.has_panels) return;
  const Vec3 handle = session.cut_handle();
  const Vec3 tip = handle + 0.08 * session.box().diagonal() * normalized(state.cut.plane.normal);
  const auto from = in_picture(state.viewpoint, handle), to = in_picture(state.viewpoint, tip);
  if (!from) return;
  const auto point = [](const std::array<double, 2>& p) {
    return ImVec2{static_cast<float>(p[0]), static_cast<float>(p[1])};
  };
  constexpr ImU32 kHandle = IM_COL32(214, 92, 16, 255);
  if (to) list.AddLine(point(*from), point(*to), kHandle, 3);
  list.AddCircleFilled(point(*from), 0.45F * line_height(), kHandle);
  list.AddCircle(point(*from), 0.45F * line_height(), IM_COL32(255, 255, 255, 255), 0, 2);
}

void draw_message(ImDrawList& list, const std::string& text, ImU32 colour, float width, float height) {
  const float wrap = 0.7F * width;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const float left = 0.5F * (width - size.x), top = height - size.y - 1.5F * line_height();
  list.AddRectFilled({left - 8, top - 5}, {left + size.x + 8, top + size.y + 5}, kPale, 4);
  list.AddText(nullptr, 0, {left, top}, colour, text.c_str(), nullptr, wrap);
}

}  // namespace

void draw_overlay(const ViewSession& session) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ViewState& state = session.state();
  const float bottom = size.y - step_panel_height(session);
  if (state.has_axes) draw_axes(list, state.viewpoint, bottom);
  if (state.has_colour_bar) draw_colour_bar(list, session, size.x, size.y);
  if (!session.shown_field()) draw_materials(list, session, bottom);
  if (state.has_time) draw_time(list, session, size.x, bottom);
  draw_handle(list, session);
  const UpdateReport report = session.report();
  if (!report.problem.empty()) {
    draw_message(list, report.problem, IM_COL32(176, 24, 24, 255), size.x, bottom);
  } else if (state.culled_from && session.has_panels) {
    draw_message(list, "The mesh is kept as the red view has it (O: let it go)", kText, size.x, bottom);
  } else if (session.is_recording()) {
    draw_message(list, "The camera's path is being recorded (R: end)", kText, size.x, bottom);
  }
}

}  // namespace adamas::viewer
