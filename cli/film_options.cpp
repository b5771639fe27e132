#include "cli/film_options.h"

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

SeriesFilmOptions FilmOptions::to_library() const {
  if (file.empty() && !frame_rate.empty()) wrong_usage("--frame-rate: expected --film as well");
  SeriesFilmOptions result{.file = file, .field = show};
  if (!plane.empty()) result.plane = parse_plane_option("--plane", plane);
  if (!frame_rate.empty()) result.frames_per_second = parse_positive("--frame-rate", frame_rate);
  return result;
}

void add_film_options(const Command& command, FilmOptions& options) {
  command
      .add_option("--film", options.file,
                  "Of a series: a film of the meshes in a plane, by ffmpeg: .mp4, .webm or .gif")
      .type_name("FILE")
      .group("Film");
  command.add_option("--frame-rate", options.frame_rate, "Steps of the film per second (default 10)")
      .type_name("N")
      .group("Film");
}

}  // namespace adamas::cli
