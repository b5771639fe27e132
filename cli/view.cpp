#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/interrupt.h"
#include "cli/opened_store.h"
#include "cli/option_values.h"
#include "cli/view_flight.h"
#include "core/io/input_file.h"
#include "viewer/session/remembered_states.h"
#include "viewer/session/view_session.h"
#include "viewer/window/offscreen_pictures.h"
#include "viewer/window/window.h"

namespace adamas::cli {

using namespace io;
using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

DocumentOptions document_options(const ViewOptions& options) {
  DocumentOptions documents;
  documents.memory = parse_size("--memory", options.memory);
  documents.waits_for_pages = waits_for_pages(options);
  documents.interpolates_in_shader = options.interpolation == "shader";
  if (!options.step.empty())
    documents.step = static_cast<std::uint32_t>(parse_count("--step", options.step, 0));
  return documents;
}

/// Says which step of a series is what is seen, where that was not asked for.
void note_steps(const std::string& path, const ViewOptions& options, Console& console) {
  const bool is_asked_for = !options.step.empty() || !options.steps.empty() || !options.state.empty();
  // A window has a slider.
  if (!is_store(path) || is_asked_for || !options.offscreen) return;
  if (const std::uint32_t steps = StoreFile(path).steps(); steps > 1)
    console.note("{}: the first of {} steps; --step says which", path, steps);
}

void protect_files(const ViewOptions& options, OutputSet& outputs) {
  for (const std::string& path : options.paths) outputs.protect(path);
  if (!options.colour_by.empty()) outputs.protect(options.colour_by);
}

void open_files(const ViewOptions& options, ViewSession& view, Session& session) {
  DocumentOptions documents = document_options(options);
  documents.colour_by = options.colour_by;
  for (const std::string& path : options.paths) {
    view.open(path, documents, session.console);
    note_steps(path, options, session.console);
  }
}

void restore_state(const ViewOptions& options, ViewSession& view) {
  if (!options.state.empty()) {
    check_input_file(options.state);
    view.restore(view_state(read_file(options.state), options.state));
  } else if (!options.offscreen && !options.fresh) {
    if (const auto remembered = remembered_state(remembered_states_file(), options.paths))
      view.restore(*remembered);
  }
}

Figures figures_of(const OffscreenPictures& pictures) {
  const UpdateReport& report = pictures.report();
  const DrawFigures& drawn = pictures.drawn();
  return {{"triangles", report.triangles},
          {"splits", report.splits},
          {"merges", report.merges},
          {"occluded_diamonds", report.hidden},
          {"occlusion_queries", report.depth_tests},
          {"largest_error_pixels", report.largest_error_pixels},
          {"pages_missing", report.pages_missing},
          {"pages_lost", report.pages_lost},
          {"rendered_triangles", drawn.triangles},
          {"draw_calls", drawn.draw_calls},
          {"copied_bytes", drawn.copied_bytes},
          {"update_seconds", report.seconds},
          {"draw_seconds", pictures.draw_seconds()}};
}

/// What the frames of a flight come to.
class FlightFigures {
 public:
  /// A frame that was drawn.
  void add(const OffscreenPictures& pictures) {
    frames_.push_back(figures_of(pictures));
    ++drawn_;
    seconds_ += pictures.report().seconds + pictures.draw_seconds();
    largest_ = std::max(largest_, pictures.report().largest_error_pixels);
    most_ = std::max(most_, pictures.report().triangles);
  }
  /// One that could not be had.
  void add_problem(const std::string& problem) { frames_.push_back({{"problem", problem}}); }
  void tell_step(const ViewSession& view) {
    if (view.times().size() < 2) return;
    frames_.back()["step"] = view.step();
    frames_.back()["time"] = view.times()[view.step()];
  }
  [[nodiscard]] std::size_t drawn() const { return drawn_; }
  [[nodiscard]] const Figures& frames() const { return frames_; }
  void print(const std::string& drawn_by, Console& console) const {
    console.table({{"frames", std::to_string(drawn_)},
                   {"most triangles", std::to_string(most_)},
                   {"largest error", fmt::format("{:.3g} pixels (estimate)", largest_)},
                   {"seconds a frame", fmt::format("{:.3f}", seconds_ / static_cast<double>(drawn_))},
                   {"drawn by", drawn_by}});
  }

 private:
  Figures frames_ = Figures::array();
  std::size_t drawn_ = 0;
  double seconds_ = 0, largest_ = 0;
  std::uint64_t most_ = 0;
};

/// Draws the frames. Those of steps that cannot be had are left out, as long as there are others.
Figures fly(const ViewOptions& options, const PictureSize& size, ViewSession& view, FlightOutput& output,
            Session& session) {
  const std::vector<FlightFrame> path = flight_frames(options, size, view);
  OffscreenPictures pictures(view, size.width, size.height);
  FlightFigures figures;
  std::vector<std::pair<std::uint32_t, std::string>> lost;
  for (std::size_t n = 0; n < path.size(); ++n) {
    session.console.step("flying", static_cast<double>(n) / static_cast<double>(path.size()));
    if (path[n].step) view.set_step(*path[n].step);
    if (const std::optional<Raster> picture = pictures.draw(path[n].viewpoint)) {
      output.add(*picture);
      figures.add(pictures);
    } else {
      const std::string& problem = pictures.report().problem;
      if (!path[n].step) fail("{}", problem);
      lost.emplace_back(*path[n].step, problem);
      output.leave_out();
      figures.add_problem(problem);
    }
    figures.tell_step(view);
  }
  session.console.clear();
  if (figures.drawn() == 0) fail("{}", lost.front().second);
  for (const auto& [step, problem] : lost)
    session.console.note_incomplete("{}: the frame of step {} is left out", problem, step);
  figures.print(pictures.drawn_by(), session.console);
  return {{"drawn_by", pictures.drawn_by()}, {"frames", figures.frames()}};
}

void run_offscreen(const ViewOptions& options, Session& session) {
  protect_files(options, session.outputs);
  const PictureSize size = picture_size(options, {1024, 768});
  FlightOutput output(options, session.outputs);
  ViewSession view(size.width, size.height);
  open_files(options, view, session);
  restore_state(options, view);
  apply_view_options(options, view);
  Figures figures = fly(options, size, view, output, session);
  PageCounts counts;
  for (const auto& document : view.documents()) counts += document->page_counts();
  add_page_counts(counts, figures);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  output.finish();
  session.console.flush();
  output.commit();
  session.commit();
}

void run_window(const ViewOptions& options, Session& session) {
  protect_files(options, session.outputs);
  WindowOptions window;
  const PictureSize size = picture_size(options, {window.width, window.height});
  window.width = size.width;
  window.height = size.height;
  window.documents = document_options(options);
  ViewSession view(size.width, size.height);
  open_files(options, view, session);
  restore_state(options, view);
  apply_view_options(options, view);
  session.console.clear();
  window.is_ended = interrupted;
  show_window(view, window);
  std::vector<std::string> names;
  for (const auto& document : view.documents()) names.push_back(document->facts().name);
  const std::filesystem::path memory = remembered_states_file();
  if (!memory.empty()) remember_state(memory, names, view.remembered());
  session.console.check();
}

void run(const ViewOptions& options, Session& session) {
  check_view_options(options, session);
  if (options.offscreen) {
    run_offscreen(options, session);
  } else {
    run_window(options, session);
  }
}

}  // namespace

void add_view(const Command& app, Session& session) {
  const auto options = std::make_shared<ViewOptions>();
  const Command command =
      add_command(app, session, "view", "Looks at stores, meshes and interfaces, in a window or without one",
                  "adamas view head.adm --isovalue 1150", [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->paths,
          "Stores (.adm), meshes from adamas resample (.vtu), saved hierarchies (.h5), interfaces (.vtp, "
          ".ply, .arec, .txt)")
      .required()
      .type_name("FILE...");
  add_view_options(command, *options);
}

}  // namespace adamas::cli
