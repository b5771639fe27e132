#include "cli/view_flight.h"

#include <fmt/format.h>

#include "cli/usage_error.h"
#include "core/picture/canvas.h"
#include "isosurface/view/flight.h"
#include "viewer/scene/camera_control.h"

namespace adamas {

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
  std::vector<FlightFrame> frames;
  const auto steps = steps_of(options);
  if (steps) {
    const auto [first, last] = *steps;
    if (view.times().size() < 2) wrong_usage("--steps: expected a stored series, found none");
    if (last >= view.times().size())
      wrong_usage("--steps: expected steps below {}, found '{}'", view.times().size(), options.steps);
    const std::size_t count = last - first + 1;
    for (std::size_t n = 0; n < count; ++n)
      frames.push_back({along(path, n, count), first + static_cast<std::uint32_t>(n)});
    return frames;
  }
  for (const Viewpoint& viewpoint : path) frames.push_back({viewpoint, std::nullopt});
  return frames;
}

FlightOutput::FlightOutput(const ViewOptions& options, const PictureSize& size, OutputSet& outputs)
    : film_name_(options.film), size_(size), rate_(film_rate(options)), outputs_(outputs) {
  if (!options.frames.empty())
    folder_.emplace(options.frames, options.overwrite, std::initializer_list<const char*>{"frame0001.png"});
  if (film_name_.empty()) return;
  require_film_maker(film_name_);
  outputs.declare("--film", film_name_, film_endings());
}

void FlightOutput::add(const Raster& picture) {
  ++frames_;
  if (folder_)
    folder_->fill([&] { write_png(folder_->file(fmt::format("frame{:04}.png", frames_)), picture); });
  if (film_name_.empty()) return;
  outputs_.write(film_name_, [&](const auto& path) {
    if (!film_) film_ = std::make_unique<Film>(path, size_.width, size_.height, rate_);
    film_->add(picture);
  });
}

void FlightOutput::finish() {
  if (film_) outputs_.write(film_name_, [this](const auto&) { film_->finish(); });
}

void FlightOutput::commit() {
  if (folder_) folder_->commit();
}

}  // namespace adamas
