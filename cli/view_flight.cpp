#include "cli/view_flight.h"

#include <filesystem>
#include <string>
#include <utility>

#include "cli/option_values.h"
#include "cli/usage.h"
#include "isosurface/view/flight.h"

namespace adamas::cli {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

std::vector<Viewpoint> path_of(const ViewOptions& options, const PictureSize& size, const ViewSession& view) {
  // A state has a viewpoint of its own.
  if (options.path.empty() && !options.state.empty()) return {view.state().viewpoint};
  if (options.path == "bookmarks") {
    std::vector<Viewpoint> path = view.bookmarked();
    if (path.empty()) wrong_usage("--camera-path bookmarks: expected a --state with bookmarks, found none");
    return path;
  }
  // A series moves by itself.
  const char* const otherwise = options.steps.empty() ? "orbit:36" : "orbit:1";
  return flight(options.path.empty() ? otherwise : options.path, view.box(), size.width, size.height);
}

}  // namespace

std::vector<FlightFrame> flight_frames(const ViewOptions& options, const PictureSize& size,
                                       const ViewSession& view) {
  const std::vector<Viewpoint> path = path_of(options, size, view);
  if (!options.steps.empty()) {
    if (view.times().size() < 2) wrong_usage("--steps: expected a stored series, found none");
    const auto [first, last] = parse_steps(options.steps, view.times().size(), "the series");
    return frames_of_steps(path, first, last);
  }
  std::vector<FlightFrame> frames;
  for (const Viewpoint& viewpoint : path) frames.push_back({viewpoint, std::nullopt});
  return frames;
}

FlightOutput::FlightOutput(const ViewOptions& options, OutputSet& outputs)
    : film_name_(options.film), outputs_(outputs) {
  FramePlaces places;
  places.frames_per_second = film_rate(options);
  if (!options.frames.empty()) {
    outputs.check_outside("--frames", options.frames);
    folder_.emplace("frames", options.frames, options.overwrite);
    places.folder = folder_->temporary();
  }
  if (!film_name_.empty()) {
    require_film_maker(film_name_);
    outputs.declare("--film", film_name_, film_endings());
    outputs.write(film_name_, [&places](const auto& path) { places.film = path; });
  }
  files_.emplace(std::move(places));
}

void FlightOutput::naming_outputs(const std::function<void()>& work) {
  const auto in_folder = [&] {
    if (folder_) {
      folder_->fill(work);
    } else {
      work();
    }
  };
  if (film_name_.empty()) return in_folder();
  outputs_.write(film_name_, [&in_folder](const auto&) { in_folder(); });
}

void FlightOutput::add(const Raster& picture) {
  naming_outputs([&] { files_->add(picture); });
}

void FlightOutput::finish() {
  naming_outputs([this] { files_->finish(); });
}

void FlightOutput::commit() {
  if (folder_) folder_->commit();
}

}  // namespace adamas::cli
