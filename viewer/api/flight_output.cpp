#include "viewer/api/flight_output.h"

#include <utility>

namespace adamas::viewer {

using namespace picture;

FlightOutput::FlightOutput(const FlightOptions& options, OutputSet& outputs)
    : film_name_(options.film.string()), outputs_(outputs) {
  FramePlaces places;
  if (options.frame_rate) places.frames_per_second = *options.frame_rate;
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

}  // namespace adamas::viewer
