#include "viewer/session/view_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adamas/text.h"
#include "core/picture/colour_map.h"
#include "viewer/session/camera_control.h"
#include "viewer/session/line_meshes.h"
#include "viewer/session/picking.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

constexpr Colour kBoxColour{0.55, 0.55, 0.58}, kViewColour{0.8, 0.2, 0.1};
/// The duration of a full turn, and the number of viewpoints per second in a recorded path.
constexpr double kSecondsOfTurn = 12, kRecordedPerSecond = 30;

PartStyle line_style(const Colour& colour) {
  PartStyle style;
  style.front = style.back = colour;
  style.is_flat = true;
  return style;
}

/// The number of following steps that are read in advance.
constexpr std::size_t kStepsAhead = 3;

/// The step of a document; one with fewer steps stays at its last one.
std::uint32_t step_of(const Document& document, std::uint32_t step) {
  const std::size_t steps = std::max<std::size_t>(1, document.facts().times.size());
  return std::min(step, static_cast<std::uint32_t>(steps - 1));
}

}  // namespace

ViewSession::ViewSession(int width, int height) {
  state_.viewpoint.width_pixels = width;
  state_.viewpoint.height_pixels = height;
  state_.viewpoint.up = {0, 0, 1};
}

void ViewSession::open(const std::string& path, const DocumentOptions& options, Progress& progress) {
  std::unique_ptr<Document> document = open_document(path, options, progress);
  state_.documents.push_back(document->first_state());
  documents_.push_back(std::move(document));
  opened_with_.push_back(options);
  lost_steps_.clear();
  clock_.set_steps(static_cast<std::uint32_t>(std::max<std::size_t>(1, times().size())));
  set_step(step());
  if (documents_.size() > 1) return;
  act(Action::kViewIsometric);
  state_.cut.plane = {box().center(), {0, 1, 0}};
}

void ViewSession::restore(const ViewState& state) {
  const Viewpoint now = state_.viewpoint;
  const std::vector<DocumentState> first = state_.documents;
  state_ = state;
  state_.viewpoint = sized_as(state_.viewpoint, now);
  state_.culled_from.reset();
  clock_.pace() = state.pace;
  state_.documents.resize(documents_.size());
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    const DocumentFacts& facts = documents_[n]->facts();
    DocumentState& document = state_.documents[n];
    if (facts.has_isovalues && document.surfaces.empty()) {
      const std::uint32_t step = document.step;
      document = first[n];
      document.step = step;
    }
    if (!facts.has_isovalues) document.surfaces.clear();
    std::erase_if(document.hidden, [&](const std::string& material) {
      return std::ranges::find(facts.materials, material) == facts.materials.end();
    });
    if (std::ranges::find(facts.fields, document.field) == facts.fields.end()) {
      document.field.clear();
      document.range.reset();
    }
  }
  set_step(step());
}

Box3 ViewSession::box() const {
  Box3 all;
  for (const auto& document : documents_) {
    all.extend(document->facts().box.min);
    all.extend(document->facts().box.max);
  }
  return all;
}

void ViewSession::set_size(int width, int height) {
  if (width < 1 || height < 1) return;
  state_.viewpoint.width_pixels = width;
  state_.viewpoint.height_pixels = height;
}

std::vector<DrawnPart> ViewSession::parts() {
  drop_old_depths();
  std::vector<DrawnPart> result;
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    std::vector<DrawnPart> some = documents_[n]->parts(state_, state_.documents[n]);
    result.insert(result.end(), some.begin(), some.end());
  }
  asked_step_ = step();
  note_lost_step();
  if (state_.has_box && !documents_.empty()) add_box(result);
  if (state_.culled_from) add_culled_view(result);
  return result;
}

void ViewSession::add_box(std::vector<DrawnPart>& parts) {
  const Box3 all = box();
  if (!box_lines_ || !(drawn_box_.min == all.min) || !(drawn_box_.max == all.max)) {
    drawn_box_ = all;
    box_lines_ = lines_of_box(all);
  }
  parts.push_back({box_lines_, line_style(kBoxColour)});
}

void ViewSession::add_culled_view(std::vector<DrawnPart>& parts) {
  if (!view_lines_ || drawn_view_ != state_.culled_from) {
    drawn_view_ = state_.culled_from;
    view_lines_ = lines_of_view(*drawn_view_);
  }
  parts.push_back({view_lines_, line_style(kViewColour)});
}

void ViewSession::finish() {
  drop_old_depths();
  for (std::size_t n = 0; n < documents_.size(); ++n) documents_[n]->finish(state_, state_.documents[n]);
}

void ViewSession::drop_old_depths() {
  // Depths belong to one view of some surfaces: those of others would hide too much.
  const Viewpoint& from = state_.culled_from ? *state_.culled_from : state_.viewpoint;
  if (!state_.leaves_out_hidden || depths_of_ != state_.documents ||
      (state_.depths && !(state_.depths->viewpoint() == from)))
    state_.depths.reset();
}

bool ViewSession::wants_depths() const {
  if (!state_.leaves_out_hidden || state_.culled_from || documents_.empty()) return false;
  const bool has_them =
      state_.depths && state_.depths->viewpoint() == state_.viewpoint && depths_of_ == state_.documents;
  if (has_them) return false;
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    if (!documents_[n]->shows_surfaces_of(state_.documents[n])) return false;
  }
  return true;
}

void ViewSession::set_depths(std::shared_ptr<const DepthPyramid> depths) {
  state_.depths = std::move(depths);
  depths_of_ = state_.documents;
}

std::optional<Plane> ViewSession::clip() const {
  if (!state_.cut.is_on || !state_.cut.cuts_away) return std::nullopt;
  return state_.cut.plane;
}

UpdateReport ViewSession::report() const {
  UpdateReport all;
  for (const auto& document : documents_) {
    const UpdateReport one = document->report();
    all.triangles += one.triangles;
    all.splits += one.splits;
    all.merges += one.merges;
    all.largest_error_pixels = std::max(all.largest_error_pixels, one.largest_error_pixels);
    all.seconds += one.seconds;
    all.depth_tests += one.depth_tests;
    all.hidden += one.hidden;
    all.pages_missing += one.pages_missing;
    all.pages_lost += one.pages_lost;
    all.is_current = all.is_current && one.is_current;
    if (all.problem.empty()) all.problem = one.problem;
  }
  return all;
}

std::optional<ViewSession::ShownField> ViewSession::shown_field() const {
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    const DocumentState& document = state_.documents[n];
    if (const auto range = documents_[n]->colour_range(state_, document))
      return ShownField{document.field.empty() ? "value" : document.field, *range};
  }
  return std::nullopt;
}

void ViewSession::look(const Vec3& direction, const Vec3& up) {
  state_.viewpoint = showing_all(looking(state_.viewpoint, direction, up), box());
}

void ViewSession::next_field() {
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    const std::vector<std::string>& fields = documents_[n]->facts().fields;
    if (fields.empty()) continue;
    DocumentState& document = state_.documents[n];
    const auto found = std::ranges::find(fields, document.field);
    document.range.reset();
    // The first field follows none, and none follows the last one.
    if (document.field.empty()) {
      document.field = fields.front();
    } else if (found == fields.end() || found + 1 == fields.end()) {
      document.field.clear();
    } else {
      document.field = *(found + 1);
    }
  }
}

void ViewSession::next_bookmark() {
  if (state_.bookmarks.empty()) return;
  bookmark_ %= state_.bookmarks.size();
  state_.viewpoint = sized_as(state_.bookmarks[bookmark_].viewpoint, state_.viewpoint);
  ++bookmark_;
}

void ViewSession::toggle_cut() {
  state_.cut.is_on = !state_.cut.is_on;
  if (!box().contains(cut_handle())) state_.cut.plane.origin = box().center();
}

void ViewSession::act(Action action) {
  constexpr Vec3 kUp{0, 0, 1};
  const auto toggle = [](bool& flag) { flag = !flag; };
  switch (action) {
    case Action::kViewFront:
      return look({0, 1, 0}, kUp);
    case Action::kViewRight:
      return look({-1, 0, 0}, kUp);
    case Action::kViewTop:
      return look({0, 0, -1}, {0, 1, 0});
    case Action::kViewIsometric:
      return look({-0.62, 0.72, -0.42}, kUp);
    case Action::kProjection:
      state_.viewpoint = with_projection(state_.viewpoint, !(state_.viewpoint.height > 0));
      return;
    case Action::kShowAll:
      state_.viewpoint = showing_all(state_.viewpoint, box());
      return;
    case Action::kCameraMode:
      state_.camera_mode = static_cast<CameraMode>((static_cast<int>(state_.camera_mode) + 1) % 3);
      return;
    case Action::kEdges:
      return toggle(state_.has_edges);
    case Action::kField:
      return next_field();
    case Action::kColourBar:
      return toggle(state_.has_colour_bar);
    case Action::kColourMap: {
      const std::vector<std::string>& names = ColourMap::names();
      const auto found = std::ranges::find(names, state_.colour_map);
      state_.colour_map = found == names.end() || found + 1 == names.end() ? names.front() : *(found + 1);
      return;
    }
    case Action::kAxes:
      return toggle(state_.has_axes);
    case Action::kBox:
      return toggle(state_.has_box);
    case Action::kShading:
      state_.shading = state_.shading == Shading::kLit ? Shading::kSphere : Shading::kLit;
      return;
    case Action::kCut:
      return toggle_cut();
    case Action::kCulledFrom:
      state_.culled_from = state_.culled_from ? std::nullopt : std::optional<Viewpoint>(state_.viewpoint);
      return;
    case Action::kHidden:
      return toggle(state_.leaves_out_hidden);
    case Action::kPanels:
      return toggle(has_panels);
    case Action::kHelp:
      return toggle(has_help);
    case Action::kBookmark:
      state_.bookmarks.push_back({fmt::format("view {}", state_.bookmarks.size() + 1), state_.viewpoint});
      return;
    case Action::kNextBookmark:
      return next_bookmark();
    case Action::kRecord:
      is_recording_ = !is_recording_;
      is_playing_ = false;
      if (is_recording_) path_.clear();
      return;
    case Action::kPlay:
      if (times().size() > 1) return play_steps();
      [[fallthrough]];
    case Action::kPlayCamera:
      is_playing_ = !is_playing_;
      is_recording_ = false;
      played_ = 0;
      return;
    case Action::kPreviousStep:
    case Action::kNextStep:
    case Action::kFirstStep:
    case Action::kLastStep:
    case Action::kTime:
    case Action::kExportFilm:
    case Action::kExportFrames:
      return act_on_steps(action);
    case Action::kScreenshot:
      wants_screenshot = true;
      return;
    case Action::kQuit:
      (is_exporting || wants_export ? wants_export_end : wants_end) = true;
      return;
  }
}

std::optional<Picked> ViewSession::pick(double x, double y) {
  const Ray ray = ray_through(state_.viewpoint, x, y);
  std::optional<Picked> nearest;
  double nearest_distance = 0;
  for (std::size_t n = 0; n < documents_.size(); ++n) {
    const std::vector<DrawnPart> parts = documents_[n]->parts(state_, state_.documents[n]);
    const std::optional<Hit> hit = viewer::pick(parts, ray, clip());
    if (!hit || (nearest && hit->distance >= nearest_distance)) continue;
    const std::size_t surface = parts[hit->part].surface;
    Reading reading = documents_[n]->at(hit->place, state_.documents[n], surface);
    // The value is that of the visible side, if an interface has values on both.
    if (std::isfinite(hit->value)) reading.value = hit->value;
    nearest = Picked{documents_[n]->facts().name, hit->place, std::move(reading), n, surface};
    nearest_distance = hit->distance;
  }
  return nearest;
}

void ViewSession::complete(Picked& picked) {
  if (!picked.reading.is_pending) return;
  const Reading now =
      documents_[picked.number]->at(picked.place, state_.documents[picked.number], picked.surface);
  if (!picked.reading.value) picked.reading.value = now.value;
  picked.reading.error = now.error;
  picked.reading.is_pending = now.is_pending;
}

void ViewSession::advance(double seconds) {
  advance_steps(seconds);
  constexpr std::size_t kMostRecorded = 100'000;
  if (is_recording_ && path_.size() < kMostRecorded) path_.push_back(state_.viewpoint);
  if (!is_playing_) return;
  if (path_.size() < 2) {
    const double pixels = 2.0 * state_.viewpoint.height_pixels * seconds / kSecondsOfTurn;
    state_.viewpoint = rotated(state_.viewpoint, CameraMode::kTurntable, -pixels, 0);
    return;
  }
  played_ += kRecordedPerSecond * seconds;
  const auto last = static_cast<double>(path_.size() - 1);
  if (played_ >= last) is_playing_ = false;
  const double at = std::min(played_, last);
  const auto below = std::min(static_cast<std::size_t>(at), path_.size() - 2);
  state_.viewpoint =
      sized_as(between(path_[below], path_[below + 1], at - static_cast<double>(below)), state_.viewpoint);
}

Vec3 ViewSession::cut_handle() const {
  const Plane& plane = state_.cut.plane;
  const Vec3 normal = normalized(plane.normal), middle = box().center();
  return middle - dot(middle - plane.origin, normal) * normal;
}

void ViewSession::drag_cut(double right, double down) {
  const Vec3 handle = cut_handle(), normal = normalized(state_.cut.plane.normal);
  const Box3 all = box();
  const double step = 0.01 * all.diagonal();
  const auto from = in_picture(state_.viewpoint, handle),
             to = in_picture(state_.viewpoint, handle + step * normal);
  if (!from || !to) return;
  const double x = (*to)[0] - (*from)[0], y = (*to)[1] - (*from)[1], length = std::hypot(x, y);
  // If the normal points towards the eye or away from it, dragging down moves the plane away from the eye.
  constexpr double kLeastLength = 0.2;  // pixels
  const double away = dot(normal, state_.viewpoint.eye - handle) > 0 ? -1 : 1;
  const double steps = length > kLeastLength
                           ? (right * x + down * y) / (length * length)
                           : away * down / std::max(1.0, state_.viewpoint.height_pixels / 100.0);
  const Vec3 moved = handle + (steps * step) * normal;
  if (all.contains(moved)) state_.cut.plane.origin = moved;
}

std::size_t ViewSession::longest_series() const {
  std::size_t longest = 0;
  for (std::size_t n = 1; n < documents_.size(); ++n) {
    if (documents_[n]->facts().times.size() > documents_[longest]->facts().times.size()) longest = n;
  }
  return longest;
}

const std::vector<double>& ViewSession::times() const {
  static const std::vector<double> kNone;
  return documents_.empty() ? kNone : documents_[longest_series()]->facts().times;
}

std::uint32_t ViewSession::step() const {
  return documents_.empty() ? 0 : state_.documents[longest_series()].step;
}

std::uint32_t ViewSession::drawn_step() const {
  const UpdateReport report = documents_.empty() ? UpdateReport{} : documents_[longest_series()]->report();
  return report.step.value_or(step());
}

void ViewSession::set_step(std::uint32_t step) {
  for (std::size_t n = 0; n < documents_.size(); ++n)
    state_.documents[n].step = step_of(*documents_[n], step);
}

std::vector<LoadedPart> ViewSession::loaded_steps() const {
  return documents_.empty() ? std::vector<LoadedPart>{} : documents_[longest_series()]->steps_ahead().loaded;
}

bool ViewSession::is_ready(std::uint32_t step) const {
  if (!report().is_current) return false;
  return std::ranges::all_of(documents_, [&](const auto& document) {
    if (document->facts().times.size() < 2) return true;
    const StepsAhead ahead = document->steps_ahead();
    // Pages for which there is no memory are not waited for.
    return !ahead.is_reading || ahead.has_all_of(step_of(*document, step));
  });
}

std::vector<Viewpoint> ViewSession::bookmarked() const {
  std::vector<Viewpoint> path;
  for (const Bookmark& each : state_.bookmarks) path.push_back(sized_as(each.viewpoint, state_.viewpoint));
  return path;
}

void ViewSession::play_steps() {
  if (clock_.is_playing()) {
    clock_.pause();
  } else {
    set_step(clock_.play(step()));
  }
}

void ViewSession::act_on_steps(Action action) {
  const std::uint32_t now = step();
  switch (action) {
    case Action::kPreviousStep:
      return set_step(now > 0 ? now - 1 : 0);
    case Action::kNextStep:
      return set_step(now + 1);
    case Action::kFirstStep:
      return set_step(0);
    case Action::kTime:
      state_.has_time = !state_.has_time;
      return;
    case Action::kExportFilm:
    case Action::kExportFrames:
      if (times().size() > 1 && !is_exporting)
        wants_export = action == Action::kExportFilm ? ExportForm::kFilm : ExportForm::kFrames;
      return;
    default:
      return set_step(std::numeric_limits<std::uint32_t>::max());
  }
}

void ViewSession::note_lost_step() {
  // The report concerns another step if that has changed since.
  if (asked_step_ != step()) return;
  bool is_lost = false;
  for (const auto& document : documents_) {
    if (document->facts().times.size() < 2) continue;
    const UpdateReport report = document->report();
    if (!report.is_current) return;
    is_lost = is_lost || !report.problem.empty();
  }
  if (is_lost) {
    lost_steps_.insert(step());
  } else {
    lost_steps_.erase(step());
  }
}

ViewState ViewSession::remembered() const {
  ViewState state = state_;
  state.pace = clock_.pace();
  return state;
}

void ViewSession::advance_steps(double seconds) {
  if (times().size() < 2) return;
  note_lost_step();
  const std::vector<std::uint32_t> next = clock_.following(step(), 1);
  set_step(clock_.advance(step(), seconds, next.empty() || is_ready(next[0])));
  if (has_keyed_camera && clock_.is_playing() && state_.bookmarks.size() > 1)
    state_.viewpoint = along(bookmarked(), step(), times().size());
  const std::vector<std::uint32_t> expected = clock_.following(step(), kStepsAhead);
  for (const auto& document : documents_) document->expect(expected);
}

std::string named_steps(const std::set<std::uint32_t>& steps) {
  constexpr std::size_t kMost = 6;
  std::vector<std::string> names;
  for (auto step = steps.begin(); step != steps.end() && names.size() < kMost; ++step)
    names.push_back(std::to_string(*step));
  if (names.size() < steps.size()) names.push_back(fmt::format("{} more", steps.size() - names.size()));
  return (steps.size() == 1 ? "step " : "steps ") + listed(names);
}

std::string path_text(const std::vector<Viewpoint>& path) {
  std::string text = "# eye, target and upward direction of each frame\n";
  for (const Viewpoint& v : path)
    text += fmt::format("{},{},{}  {},{},{}  {},{},{}\n", v.eye.x, v.eye.y, v.eye.z, v.target.x, v.target.y,
                        v.target.z, v.up.x, v.up.y, v.up.z);
  return text;
}

}  // namespace adamas::viewer
