#include "viewer/window/step_export.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "viewer/window/free_name.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace fs = std::filesystem;

StepExport::StepExport(const ViewSession& session, const ExportRequest& request)
    : state_(session.state()),
      path_(session.has_keyed_camera ? session.bookmarked() : std::vector<Viewpoint>{}),
      request_(request),
      frames_per_second_(session.clock().pace().steps_per_second) {
  if (path_.size() < 2) path_ = {state_.viewpoint};
  std::size_t most = 0;
  for (std::size_t n = 0; n < session.documents().size(); ++n) {
    const DocumentFacts& facts = session.documents()[n]->facts();
    files_.push_back({facts.name, session.opened_with()[n]});
    files_.back().options.waits_for_pages = true;
    if (facts.times.size() <= most) continue;
    most = facts.times.size();
    series_ = facts.name;
  }
  state_.frame_milliseconds = 0;
  // Hidden parts are refined too: leaving them out would only save time, and depends on the picture before.
  state_.leaves_out_hidden = false;
  state_.depths.reset();
  thread_.emplace();
  thread_->begin([this] { open_files(); });
}

StepExport::~StepExport() {
  thread_.reset();
  discard();
}

fs::path StepExport::folder() const { return series_.has_parent_path() ? series_.parent_path() : "."; }

std::string StepExport::stem() const { return series_.stem().string() + (makes_film_ ? "-film" : "-images"); }

void StepExport::open_files() {
  auto session = std::make_unique<ViewSession>(request_.width, request_.height);
  for (const OpenedFile& file : files_) session->open(file.path, file.options, SilentProgress::instance());
  session->state() = state_;
  session->has_panels = false;
  session_ = std::move(session);
}

void StepExport::begin() {
  frames_ = frames_of_steps(path_, 0, static_cast<std::uint32_t>(session_->times().size() - 1));
  if (request_.form == ExportForm::kFilm) {
    try {
      require_film_maker(series_);
      makes_film_ = true;
    } catch (const Error&) {
      has_no_film_maker_ = true;
    }
  }
  try {
    names_ = PartialNames::in(folder());
    written_ = names_->next(ending());
    if (!makes_film_) fs::create_directory(written_);
  } catch (const std::system_error& error) {
    fail("{}: expected a writable folder, found that nothing can be made in {}: {}",
         (folder() / (stem() + ending())).string(), folder().string(), error.code().message());
  }
  const FramePlaces places{makes_film_ ? "" : written_, makes_film_ ? written_ : "", frames_per_second_};
  output_ = std::make_unique<FrameFiles>(places);
  pictures_ = std::make_unique<SessionPictures>(request_.width, request_.height, request_.scale);
}

bool StepExport::go_on() {
  if (!outcome_.empty()) return false;
  try {
    return next();
  } catch (const Error& error) {
    std::string text = error.what();
    if (!written_.empty())
      text = replaced(text, written_.string(),
                      free_name(folder(), stem(), ending()).lexically_normal().string());
    outcome_ = "Nothing was written: " + text;
    thread_.reset();
    discard();
    return false;
  }
}

bool StepExport::next() {
  if (!thread_->is_idle()) return true;
  if (!output_) begin();
  if (is_finishing_) {
    finish();
    return false;
  }
  if (next_ < frames_.size()) {
    if (draw_step()) ++next_;
    return true;
  }
  if (lost_.size() == frames_.size()) fail("{}", problem_);
  is_finishing_ = true;
  thread_->begin([this] { output_->finish(); });
  return true;
}

bool StepExport::draw_step() {
  const FlightFrame& frame = frames_[next_];
  session_->set_step(*frame.step);
  session_->state().viewpoint = frame.viewpoint;
  session_->set_size(request_.width, request_.height);
  static_cast<void>(session_->parts());
  const UpdateReport report = session_->report();
  if (!report.is_current) return false;
  if (!report.problem.empty()) {
    if (lost_.empty()) problem_ = report.problem;
    lost_.insert(*frame.step);
    output_->leave_out();
    return true;
  }
  const auto picture = std::make_shared<const Raster>(pictures_->draw(*session_));
  thread_->begin([this, picture] { output_->add(*picture); });
  return true;
}

void StepExport::finish() {
  output_.reset();
  const fs::path path = rename_to_free_name(written_, stem(), ending());
  written_.clear();
  names_.reset();
  outcome_ = fmt::format("{} was written: {} {}", path.lexically_normal().string(),
                         frames_.size() - lost_.size(), makes_film_ ? "steps" : "images");
  if (has_no_film_maker_) outcome_ += ", no film: the program ffmpeg is not on PATH";
  if (!lost_.empty()) outcome_ += fmt::format(", without {}: {}", named_steps(lost_), problem_);
}

void StepExport::discard() {
  output_.reset();
  std::error_code code;
  if (!written_.empty()) fs::remove_all(written_, code);
  written_.clear();
  names_.reset();
}

}  // namespace adamas::viewer
