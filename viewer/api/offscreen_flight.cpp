#include <utility>

#include "adamas/file_names.h"
#include "adamas/view.h"
#include "core/base/error.h"
#include "core/base/notes.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/view/flight.h"
#include "timevarying/play_order.h"
#include "viewer/api/flight_output.h"
#include "viewer/api/view_options.h"
#include "viewer/session/flight_frames.h"
#include "viewer/window/offscreen_pictures.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace timevarying;
using namespace viewer;

namespace {

constexpr ViewPlace kPlace = ViewPlace::kOffscreen;

void check_flight_options(const ViewOptions& view, const FlightOptions& flight) {
  if (flight.frame_rate && !(*flight.frame_rate > 0))
    wrong_usage("--frame-rate: expected a positive number, found '{}'", *flight.frame_rate);
  if (flight.steps && view.step) wrong_usage("--steps: expected no --step beside it, found '{}'", *view.step);
  if (flight.frame_rate && flight.film.empty())
    wrong_usage("--frame-rate: expected a --film beside it, found none");
}

void protect_files(const ViewOptions& view, OutputSet& outputs) {
  for (const std::filesystem::path& path : view.files) outputs.protect(path);
  if (!view.colour_by.empty()) outputs.protect(view.colour_by);
}

/// Notes which step of a series is shown, if that was not specified.
void note_step(const std::filesystem::path& file, const ViewOptions& view, const FlightOptions& flight,
               Progress& progress) {
  if (view.step || flight.steps || !view.state.empty() || file_extension(file) != ".adm") return;
  if (const std::uint32_t steps = StoreFile(file).steps(); steps > 1)
    note(progress, "{}: the first of {} steps; --step says which", file.string(), steps);
}

std::vector<Viewpoint> viewpoints(const ViewOptions& options, const FlightOptions& wanted,
                                  const std::array<int, 2>& size, const ViewSession& view) {
  if (wanted.along_bookmarks) {
    std::vector<Viewpoint> path = view.bookmarked();
    if (path.empty()) wrong_usage("--camera-path bookmarks: expected a --state with bookmarks, found none");
    return path;
  }
  // A state has a viewpoint of its own.
  if (!wanted.camera_path && !options.state.empty()) return {view.state().viewpoint};
  // A series moves by itself, so one viewpoint suffices.
  const Orbit otherwise{wanted.steps ? 1 : 36};
  return flight(wanted.camera_path.value_or(otherwise), view.box(), size[0], size[1]);
}

/// The requested pictures: one from each viewpoint of the path; with steps, one of each step, while the
/// camera moves along the path. Throws Error (kUsage) if the session has no such steps.
std::vector<FlightFrame> wanted_frames(const ViewOptions& options, const FlightOptions& wanted,
                                       const std::array<int, 2>& size, const ViewSession& view) {
  const std::vector<Viewpoint> path = viewpoints(options, wanted, size, view);
  if (wanted.steps) {
    if (view.times().size() < 2) wrong_usage("--steps: expected a stored series, found none");
    check_steps(*wanted.steps, view.times().size(), "the series");
    return frames_of_steps(path, wanted.steps->first, wanted.steps->last);
  }
  std::vector<FlightFrame> frames;
  for (const Viewpoint& viewpoint : path) frames.push_back({viewpoint, std::nullopt});
  return frames;
}

ViewedFrame frame_report(const OffscreenPictures& pictures) {
  const UpdateReport& report = pictures.report();
  const DrawFigures& drawn = pictures.drawn();
  ViewedFrame frame;
  frame.triangles = report.triangles;
  frame.splits = report.splits;
  frame.merges = report.merges;
  frame.occluded_diamonds = report.hidden;
  frame.occlusion_queries = report.depth_tests;
  frame.largest_error_pixels = report.largest_error_pixels;
  frame.pages_missing = report.pages_missing;
  frame.pages_lost = report.pages_lost;
  frame.rendered_triangles = drawn.triangles;
  frame.draw_calls = drawn.draw_calls;
  frame.copied_bytes = drawn.copied_bytes;
  frame.update_seconds = report.seconds;
  frame.draw_seconds = pictures.draw_seconds();
  return frame;
}

void add_page_counts(const ViewSession& view, FlightReport& report) {
  PageReads counts;
  for (const auto& document : view.documents()) counts += document->page_counts();
  report.pages = counts.pages;
  report.predictor_pages = counts.predictors;
  report.bytes = counts.bytes;
  report.copied_pages = counts.copies;
  report.damaged_pages = counts.damaged;
}

}  // namespace

struct OffscreenFlight::Contents {
  Contents(const ViewOptions& view_options, const FlightOptions& flight_options, OutputSet& outputs)
      : options(view_options),
        wanted(flight_options),
        size(picture_size(view_options, {1024, 768})),
        output(flight_options, outputs),
        view(size[0], size[1]) {}

  ViewOptions options;
  FlightOptions wanted;
  std::array<int, 2> size;
  FlightOutput output;
  ViewSession view;
};

OffscreenFlight::OffscreenFlight(const ViewOptions& options, const FlightOptions& wanted, OutputSet& outputs,
                                 Progress& progress) {
  check_view_options(options);
  check_flight_options(options, wanted);
  protect_files(options, outputs);
  contents_ = std::make_unique<Contents>(options, wanted, outputs);
  ViewSession& view = contents_->view;
  for (const std::filesystem::path& file : options.files) {
    view.open(file.string(), document_options(options, kPlace), progress);
    note_step(file, options, wanted, progress);
  }
  restore_state(options, view);
  apply_view_options(options, kPlace, view);
}

OffscreenFlight::OffscreenFlight(OffscreenFlight&&) noexcept = default;
OffscreenFlight& OffscreenFlight::operator=(OffscreenFlight&&) noexcept = default;
OffscreenFlight::~OffscreenFlight() = default;

FlightReport OffscreenFlight::draw(Progress& progress) {
  auto& [options, wanted, size, output, view] = *contents_;
  const std::vector<FlightFrame> path = wanted_frames(options, wanted, size, view);
  OffscreenPictures pictures(view, size[0], size[1]);
  FlightReport report;
  std::vector<std::pair<std::uint32_t, std::string>> lost;
  for (std::size_t n = 0; n < path.size(); ++n) {
    progress.step("flying", static_cast<double>(n) / static_cast<double>(path.size()));
    if (path[n].step) view.set_step(*path[n].step);
    if (const std::optional<Raster> picture = pictures.draw(path[n].viewpoint)) {
      output.add(*picture);
      report.frames.push_back(frame_report(pictures));
    } else {
      const std::string& problem = pictures.report().problem;
      if (!path[n].step) fail("{}", problem);
      lost.emplace_back(*path[n].step, problem);
      output.leave_out();
      report.frames.emplace_back().problem = problem;
    }
    if (view.times().size() < 2) continue;
    report.frames.back().step = view.step();
    report.frames.back().time = view.times()[view.step()];
  }
  if (lost.size() == path.size()) fail("{}", lost.front().second);
  for (const auto& [step, problem] : lost)
    progress.note(NoteKind::kIncomplete, fmt::format("{}: the frame of step {} is left out", problem, step));
  report.drawn_by = pictures.drawn_by();
  add_page_counts(view, report);
  return report;
}

void OffscreenFlight::finish() { contents_->output.finish(); }

void OffscreenFlight::commit() { contents_->output.commit(); }

}  // namespace adamas
