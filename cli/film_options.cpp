#include "cli/film_options.h"

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

SeriesFilmOptions FilmOptions::to_library() const {
  if (file.empty() && frame_rate) wrong_usage("--frame-rate: expected --film as well");
  SeriesFilmOptions result{file, plane, show};
  if (frame_rate) result.frames_per_second = *frame_rate;
  return result;
}

void add_film_options(const Command& command, FilmOptions& options) {
  command
      .add_option("--film", options.file,
                  "Of a series: a film of the meshes in a plane, by ffmpeg: .mp4, .webm or .gif")
      .type_name("FILE")
      .group("Film");
  command
      .add_converted("--frame-rate", "Steps of the film per second (default 10)",
                     [&options](const std::string& option, const std::string& text) {
                       options.frame_rate = parse_positive(option, text);
                     })
      .type_name("N")
      .group("Film");
}

}  // namespace adamas::cli
