#include "viewer/window/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/picture/colour_map.h"
#include "core/picture/ticks.h"
#include "viewer/session/camera_control.h"
#include "viewer/window/key_bindings.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;
using namespace timevarying;

namespace {

constexpr std::size_t kHistory = 240;

float em() { return ImGui::GetFontSize(); }

bool slider(const char* label, double& value, double least, double greatest, const char* format,
            ImGuiSliderFlags flags = 0) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &least, &greatest, format, flags);
}

void help_mark(const char* text) {
  ImGui::SameLine();
  ImGui::TextDisabled("(?)");
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * em());
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// Shows the number of samples per value, and the isovalues; a click or a drag moves the nearest one.
void show_histogram(const DocumentFacts& facts, DocumentState& state) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 5 * em()};
  ImGui::InvisibleButton("histogram", size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(255, 255, 255, 255));
  const std::uint64_t most = std::max<std::uint64_t>(1, *std::ranges::max_element(facts.histogram));
  const auto parts = static_cast<float>(facts.histogram.size());
  for (std::size_t n = 0; n < facts.histogram.size(); ++n) {
    // The scale is logarithmic, since most samples usually have one value.
    const double part =
        std::log1p(static_cast<double>(facts.histogram[n])) / std::log1p(static_cast<double>(most));
    const float left = at.x + size.x * static_cast<float>(n) / parts;
    list.AddRectFilled({left, at.y + size.y * (1 - static_cast<float>(part))},
                       {left + size.x / parts, at.y + size.y}, IM_COL32(130, 146, 168, 255));
  }
  const auto [least, greatest] = facts.value_range;
  const double width = greatest > least ? greatest - least : 1;
  for (const SurfaceState& surface : state.surfaces) {
    const auto x = at.x + size.x * static_cast<float>((surface.isovalue - least) / width);
    list.AddLine({x, at.y}, {x, at.y + size.y}, IM_COL32(214, 92, 16, 255), 2);
  }
  if (!ImGui::IsItemActive() || state.surfaces.empty()) return;
  const double wanted = least + width * std::clamp((ImGui::GetIO().MousePos.x - at.x) / size.x, 0.0F, 1.0F);
  std::ranges::min_element(state.surfaces, {}, [&](const SurfaceState& surface) {
    return std::abs(surface.isovalue - wanted);
  })->isovalue = wanted;
}

void show_surface(const DocumentFacts& facts, SurfaceState& surface, bool& is_removed) {
  ImGui::Checkbox("##shown", &surface.is_shown);
  ImGui::SameLine();
  std::array<float, 3> colour{static_cast<float>(surface.colour.r), static_cast<float>(surface.colour.g),
                              static_cast<float>(surface.colour.b)};
  if (ImGui::ColorEdit3("##colour", colour.data(), ImGuiColorEditFlags_NoInputs))
    surface.colour = {colour[0], colour[1], colour[2]};
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 1.8F * em());
  const auto [least, greatest] = facts.value_range;
  slider("##isovalue", surface.isovalue, least, greatest, "isovalue %.5g", ImGuiSliderFlags_NoRoundToFormat);
  ImGui::SameLine();
  is_removed = ImGui::SmallButton("x");
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  slider("##opacity", surface.opacity, 0.05, 1, "opacity %.2f");
}

void show_surfaces(const DocumentFacts& facts, DocumentState& state) {
  show_histogram(facts, state);
  std::size_t removed = state.surfaces.size();
  for (std::size_t n = 0; n < state.surfaces.size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    bool is_removed = false;
    show_surface(facts, state.surfaces[n], is_removed);
    if (is_removed) removed = n;
    ImGui::PopID();
  }
  constexpr std::size_t kMostSurfaces = 8;
  if (removed < state.surfaces.size() && state.surfaces.size() > 1)
    state.surfaces.erase(state.surfaces.begin() + static_cast<std::ptrdiff_t>(removed));
  if (state.surfaces.size() < kMostSurfaces && ImGui::Button("Another isovalue")) {
    SurfaceState another = state.surfaces.back();
    another.isovalue = 0.5 * (another.isovalue + facts.value_range[1]);
    another.colour = {0.45, 0.62, 0.85};
    another.opacity = 1;
    // The outermost surface is made transparent.
    state.surfaces.back().opacity = std::min(state.surfaces.back().opacity, 0.35);
    state.surfaces.push_back(another);
  }
}

void show_materials(const DocumentFacts& facts, DocumentState& state) {
  if (ImGui::SmallButton("All")) state.hidden.clear();
  ImGui::SameLine();
  if (ImGui::SmallButton("None")) state.hidden = {facts.materials.begin(), facts.materials.end()};
  for (std::size_t m = 0; m < facts.materials.size(); ++m) {
    const std::string& name = facts.materials[m];
    const Colour& colour = facts.material_colours[m];
    ImGui::PushID(static_cast<int>(m));
    bool is_shown = !state.hidden.contains(name);
    if (ImGui::Checkbox("##shown", &is_shown)) {
      if (is_shown) {
        state.hidden.erase(name);
      } else {
        state.hidden.insert(name);
      }
    }
    ImGui::SameLine();
    ImGui::ColorButton(
        "##colour",
        {static_cast<float>(colour.r), static_cast<float>(colour.g), static_cast<float>(colour.b), 1},
        ImGuiColorEditFlags_NoTooltip, {em(), em()});
    ImGui::SameLine();
    ImGui::TextUnformatted(name.c_str());
    ImGui::PopID();
  }
}

void show_field(const Document& document, DocumentState& state, ViewState& view) {
  const DocumentFacts& facts = document.facts();
  const std::string none = facts.materials.empty() ? "its colour" : "materials";
  if (ImGui::BeginCombo("coloured by", state.field.empty() ? none.c_str() : state.field.c_str())) {
    if (ImGui::Selectable(none.c_str(), state.field.empty())) state.field.clear();
    for (const std::string& field : facts.fields) {
      if (!ImGui::Selectable(field.c_str(), field == state.field)) continue;
      state.field = field;
      state.range.reset();
    }
    ImGui::EndCombo();
  }
  const auto range = document.colour_range(view, state);
  if (!range) return;
  if (ImGui::BeginCombo("colour map", view.colour_map.c_str())) {
    for (const std::string& name : ColourMap::names()) {
      if (ImGui::Selectable(name.c_str(), name == view.colour_map)) view.colour_map = name;
    }
    ImGui::EndCombo();
  }
  std::array<double, 2> ends = *range;
  if (ImGui::InputScalarN("range", ImGuiDataType_Double, ends.data(), 2, nullptr, nullptr, "%.4g") &&
      ends[0] < ends[1])
    state.range = ends;
  if (state.range) {
    ImGui::SameLine();
    if (ImGui::SmallButton("whole")) state.range.reset();
  }
}

void show_document(const Document& document, DocumentState& state, ViewState& view) {
  const DocumentFacts& facts = document.facts();
  const std::size_t slash = facts.name.find_last_of('/');
  const std::string name = slash == std::string::npos ? facts.name : facts.name.substr(slash + 1);
  if (!ImGui::CollapsingHeader(name.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::TextDisabled("%s", facts.summary.c_str());
  if (facts.has_isovalues) show_surfaces(facts, state);
  if (!facts.materials.empty()) show_materials(facts, state);
  if (!facts.fields.empty() || document.colour_range(view, state)) show_field(document, state, view);
}

void show_detail(ViewState& view) {
  if (!ImGui::CollapsingHeader("Detail", ImGuiTreeNodeFlags_DefaultOpen)) return;
  slider("error", view.pixels, 0.25, 32, "%.2f pixels", ImGuiSliderFlags_Logarithmic);
  help_mark(
      "The greatest isosurface error as it is seen, an estimate of the distance to the surface of all "
      "samples.");
  const std::uint64_t least = 1000, most = 10'000'000;
  ImGui::SliderScalar("triangles", ImGuiDataType_U64, &view.max_triangles, &least, &most, "%llu",
                      ImGuiSliderFlags_Logarithmic);
  help_mark("Never more triangles than these, whatever the error.");
  slider("time", view.frame_milliseconds, 0, 200, view.frame_milliseconds > 0 ? "%.0f ms" : "any");
  help_mark(
      "For the mesh of a frame while the view moves: it has as many triangles as there is time for, and "
      "all of them once the view stands still.");
}

void show_cut(ViewSession& session) {
  if (!ImGui::CollapsingHeader("Plane", ImGuiTreeNodeFlags_DefaultOpen)) return;
  CutState& cut = session.state().cut;
  bool is_on = cut.is_on;
  if (ImGui::Checkbox("a plane", &is_on)) session.act(Action::kCut);
  if (!cut.is_on) return;
  ImGui::SameLine();
  ImGui::Checkbox("cuts away", &cut.cuts_away);
  ImGui::SameLine();
  ImGui::Checkbox("section", &cut.shows_section);
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) ImGui::SameLine();
    if (ImGui::Button(kNames[static_cast<std::size_t>(axis)])) {
      cut.plane.normal = {};
      cut.plane.normal[axis] = 1;
    }
  }
  ImGui::SameLine();
  if (ImGui::Button("turn round")) cut.plane.normal = -cut.plane.normal;
  ImGui::SameLine();
  if (ImGui::Button("as I look"))
    cut.plane.normal = normalized(session.state().viewpoint.eye - session.state().viewpoint.target);
  const Box3 box = session.box();
  const Vec3 normal = normalized(cut.plane.normal);
  double low = 0, high = 0;
  for (const Vec3& corner : box.corners()) {
    const double along = dot(corner - box.center(), normal);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  double place = dot(cut.plane.origin - box.center(), normal);
  if (slider("place", place, low, high, "%.4g")) cut.plane.origin = box.center() + place * normal;
}

void show_camera(ViewSession& session, PanelState& panels) {
  if (!ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ViewState& view = session.state();
  int mode = static_cast<int>(view.camera_mode);
  if (ImGui::Combo("mouse", &mode, "trackball\0turntable\0fly\0"))
    view.camera_mode = static_cast<CameraMode>(mode);
  bool is_parallel = view.viewpoint.height > 0;
  if (ImGui::Checkbox("orthographic", &is_parallel)) session.act(Action::kProjection);
  ImGui::SameLine();
  ImGui::Checkbox("edges", &view.has_edges);
  ImGui::SameLine();
  bool is_sphere = view.shading == Shading::kSphere;
  if (ImGui::Checkbox("as a sphere", &is_sphere)) session.act(Action::kShading);
  ImGui::Checkbox("leave out what is hidden", &view.leaves_out_hidden);
  bool is_kept = view.culled_from.has_value();
  if (ImGui::Checkbox("keep this view's mesh", &is_kept)) session.act(Action::kCulledFrom);
  if (ImGui::Button("Bookmark")) session.act(Action::kBookmark);
  ImGui::SameLine();
  if (ImGui::Button(session.is_recording() ? "End recording" : "Record")) session.act(Action::kRecord);
  ImGui::SameLine();
  if (ImGui::Button(session.is_playing() ? "Stop" : "Play")) session.act(Action::kPlayCamera);
  if (session.path().size() > 1 && !session.is_recording()) {
    ImGui::SameLine();
    if (ImGui::Button("Save path")) panels.wants_path_saved = true;
  }
  std::size_t removed = view.bookmarks.size();
  for (std::size_t n = 0; n < view.bookmarks.size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    if (ImGui::SmallButton("Go")) view.viewpoint = sized_as(view.bookmarks[n].viewpoint, view.viewpoint);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 1.8F * em());
    ImGui::InputText("##name", &view.bookmarks[n].name);
    ImGui::SameLine();
    if (ImGui::SmallButton("x")) removed = n;
    ImGui::PopID();
  }
  if (removed < view.bookmarks.size())
    view.bookmarks.erase(view.bookmarks.begin() + static_cast<std::ptrdiff_t>(removed));
}

void show_plot(const PanelState& panels, const char* name, const char* format, double FrameTimes::*member) {
  std::vector<float> values;
  for (const FrameTimes& times : panels.history) values.push_back(static_cast<float>(times.*member));
  if (values.empty()) return;
  const float most = *std::ranges::max_element(values);
  const std::string text = fmt::format(fmt::runtime(format), values.back());
  ImGui::PlotLines(name, values.data(), static_cast<int>(values.size()), 0, text.c_str(), 0, 1.2F * most,
                   {0, 2.6F * em()});
}

void show_statistics(const ViewSession& session, const PanelState& panels) {
  if (!ImGui::CollapsingHeader("Statistics")) return;
  const UpdateReport report = session.report();
  ImGui::Text("%s triangles, %s splits, %s merges", fmt::format("{}", report.triangles).c_str(),
              fmt::format("{}", report.splits).c_str(), fmt::format("{}", report.merges).c_str());
  if (report.pages_missing > 0)
    ImGui::Text("%s pages missing", fmt::format("{}", report.pages_missing).c_str());
  if (report.pages_lost > 0) ImGui::Text("%s pages lost", fmt::format("{}", report.pages_lost).c_str());
  show_plot(panels, "update", "{:.1f} ms", &FrameTimes::update_milliseconds);
  show_plot(panels, "drawing", "{:.1f} ms", &FrameTimes::draw_milliseconds);
  show_plot(panels, "error", "{:.2f} pixels", &FrameTimes::largest_error_pixels);
  ImGui::TextDisabled("%s", panels.drawn_by.c_str());
}

void show_file(PanelState& panels) {
  if (!ImGui::CollapsingHeader("File")) return;
  const bool is_entered = ImGui::InputText("##path", &panels.path, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if (ImGui::Button("Open") || is_entered) panels.wants_open = !panels.path.empty();
  ImGui::TextDisabled("or drop files on the window");
}

void show_picked(const ViewSession& session, WindowInput& input) {
  if (!input.picked()) return;
  const Picked& picked = *input.picked();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x - 0.8F * em(), 0.8F * em()}, ImGuiCond_Always, {1, 0});
  bool is_open = true;
  ImGui::Begin(
      "Place", &is_open,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
  const Vec3& p = picked.place;
  ImGui::Text("%s, %s, %s", tidy_number(p.x).c_str(), tidy_number(p.y).c_str(), tidy_number(p.z).c_str());
  if (!picked.reading.material.empty()) ImGui::Text("material: %s", picked.reading.material.c_str());
  if (picked.reading.value) {
    const auto field = session.shown_field();
    ImGui::Text("%s: %s", field ? field->name.c_str() : "value", tidy_number(*picked.reading.value).c_str());
  }
  if (picked.reading.error) ImGui::Text("error (estimate): %s", tidy_number(*picked.reading.error).c_str());
  ImGui::TextDisabled("%s", picked.document.c_str());
  ImGui::End();
  if (!is_open) input.forget_picked();
}

void show_help(ViewSession& session) {
  if (!session.has_help) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::Begin("Keys and mouse", &session.has_help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  std::vector<std::array<std::string, 2>> rows{{"Left button", "Turn; a click tells what is there"},
                                               {"Shift, or middle", "Move"},
                                               {"Right, or wheel", "Zoom"},
                                               {"Arrows, Page Up, Down", "Move, where the mouse flies"}};
  for (const KeyBinding& binding : kKeyBindings)
    rows.push_back({std::string(binding.key), std::string(binding.what)});
  ImGui::BeginTable("keys", 4);
  // There are two columns side by side, each read from top to bottom.
  const std::size_t half = (rows.size() + 1) / 2;
  for (std::size_t n = 0; n < half; ++n) {
    for (std::size_t row = n; row < rows.size(); row += half) {
      for (const std::string& text : rows[row]) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(text.c_str());
      }
    }
    ImGui::TableNextRow();
  }
  ImGui::EndTable();
  ImGui::End();
}

constexpr ImU32 kLoaded = IM_COL32(96, 150, 110, 255), kLost = IM_COL32(176, 24, 24, 255);

/// Draws a bar for each step, as high as the part of it that is in memory, or red if the step could not be
/// shown.
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

/// Shows a line over all steps, with bars of what is in memory and a mark at the visible step; a click or a
/// drag goes to another one.
void show_slider(ViewSession& session, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{width, ImGui::GetFrameHeight()};
  ImGui::InvisibleButton("steps", size);
  const std::size_t count = session.times().size();
  // Each step has an equal part of the width.
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

/// Shows one button for each form of export.
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

/// Shows which step is visible, and which steps cannot be shown.
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

/// Shows the panel of steps: playing, its speed, and a slider over the steps.
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

/// Shows an export in a small window at the upper edge, even if panels are hidden.
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

}  // namespace

void PanelState::add(const FrameTimes& times) {
  history.push_back(times);
  if (history.size() > kHistory) history.erase(history.begin());
}

void show_panels(ViewSession& session, WindowInput& input, PanelState& panels) {
  show_help(session);
  show_picked(session, input);
  show_export_panel(session, panels.exporting);
  if (!session.has_panels) return;
  show_step_panel(session);
  const float height = ImGui::GetIO().DisplaySize.y - step_panel_height(session);
  const float most = std::max(4 * em(), height - 8 * em());
  ImGui::SetNextWindowPos({0.6F * em(), 0.6F * em()}, ImGuiCond_Once);
  ImGui::SetNextWindowSizeConstraints({18 * em(), 4 * em()}, {40 * em(), most});
  ImGui::SetNextWindowSize({22 * em(), most}, ImGuiCond_Once);
  ImGui::Begin("adamas", nullptr, ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushItemWidth(0.6F * ImGui::GetContentRegionAvail().x);
  for (std::size_t n = 0; n < session.documents().size(); ++n) {
    ImGui::PushID(static_cast<int>(n));
    show_document(*session.documents()[n], session.state().documents[n], session.state());
    ImGui::PopID();
  }
  show_detail(session.state());
  show_cut(session);
  show_camera(session, panels);
  show_statistics(session, panels);
  show_file(panels);
  ImGui::PopItemWidth();
  ImGui::Separator();
  ImGui::TextDisabled("H: keys and mouse");
  if (!panels.message.empty()) ImGui::TextWrapped("%s", panels.message.c_str());
  ImGui::End();
}

float step_panel_height(const ViewSession& session) {
  if (!session.has_panels || session.times().size() < 2) return 0;
  const ImGuiStyle& style = ImGui::GetStyle();
  return 2 * ImGui::GetFrameHeight() + style.ItemSpacing.y + 2 * style.WindowPadding.y;
}

}  // namespace adamas::viewer
