#include "cli/series_film.h"

#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/picture/film.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;
using namespace workflow;

SeriesFilm::SeriesFilm(const std::filesystem::path& file, const Plane& plane, const std::string& show,
                       std::string name)
    : name_(std::move(name)), scale_(name_ + ", " + to_string(plane)) {
  require_film_maker(file);
  style_.plane = plane;
  style_.field = show;
}

void SeriesFilm::add(double time, ResampledMesh& mesh) {
  SliceInput input;
  input.name = name_;
  input.mesh = std::move(mesh);
  if (input.outline(style_.plane).empty())
    fail("{}: expected a plane that cuts {}, found {}", name_, box_text(input.box()),
         to_string(style_.plane));
  const CrossSection section = cut(input, SliceMode::kMaterials, style_);
  pictures_.push_back(make_slice_picture(input, {SliceMode::kMaterials}, style_, {section}));
  scale_.add(pictures_.back());
  times_.push_back(time);
  mesh = *std::move(input.mesh);
}

void SeriesFilm::write(const std::filesystem::path& path, double frames_per_second, Progress& progress) {
  std::unique_ptr<Film> film;
  for (std::size_t n = 0; n < pictures_.size(); ++n) {
    progress.step("drawing the film", static_cast<double>(n) / static_cast<double>(pictures_.size()));
    scale_.apply(n, times_[n], pictures_[n]);
    const Raster frame = draw_slice_frame(pictures_[n]);
    if (!film) film = std::make_unique<Film>(path, frame.width(), frame.height(), frames_per_second);
    film->add(frame);
  }
  if (film) film->finish();
}

void SeriesFilmText::check() const {
  if (file.empty()) {
    if (!frame_rate.empty()) wrong_usage("--frame-rate: expected --film as well");
    return;
  }
  if (!is_film(file))
    wrong_usage("--film: expected a file name that ends in .mp4, .webm or .gif, found '{}'", file);
  if (plane.empty()) wrong_usage("--film: expected --plane as well");
  static_cast<void>(parse_plane_option("--plane", plane));
  static_cast<void>(rate());
}

double SeriesFilmText::rate() const {
  return frame_rate.empty() ? kFrameRate : parse_positive("--frame-rate", frame_rate);
}

void add_film_options(const Command& command, SeriesFilmText& text) {
  command
      .add_option("--film", text.file,
                  "Of a series: a film of the meshes in a plane, by ffmpeg: .mp4, .webm or .gif")
      .type_name("FILE")
      .group("Film");
  command.add_option("--frame-rate", text.frame_rate, "Steps of the film per second (default 10)")
      .type_name("N")
      .group("Film");
}

}  // namespace adamas::cli
