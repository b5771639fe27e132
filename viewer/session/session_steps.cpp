// The steps of series in a session: which one is seen, and how they are played.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/text.h"
#include "viewer/session/camera_control.h"
#include "viewer/session/view_session.h"

namespace adamas::viewer {

using namespace isosurface;

namespace {

/// How many of the steps that follow are read meanwhile.
constexpr std::size_t kStepsAhead = 3;

/// A file with fewer steps stays at its last one.
std::uint32_t step_of(const Document& document, std::uint32_t step) {
  const std::size_t steps = std::max<std::size_t>(1, document.facts().times.size());
  return std::min(step, static_cast<std::uint32_t>(steps - 1));
}

}  // namespace

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
    // What does not come, for want of memory, is not waited for.
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
  // What was reported is of another step where that has changed since.
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

}  // namespace adamas::viewer
