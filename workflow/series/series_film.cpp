#include "workflow/series/series_film.h"

#include <memory>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/picture/film.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace picture;

void check_film(const SeriesFilmOptions& options) {
  if (options.frames_per_second && !(*options.frames_per_second > 0))
    wrong_usage("--frame-rate: expected a positive number, found '{}'", *options.frames_per_second);
  if (options.file.empty()) {
    if (options.plane || !options.field.empty())
      wrong_usage("--{}: expected --film as well", options.plane ? "plane" : "show");
    if (options.frames_per_second) wrong_usage("--frame-rate: expected --film as well");
    return;
  }
  if (!is_film(options.file))
    wrong_usage("--film: expected a file name that ends in .mp4, .webm or .gif, found '{}'",
                options.file.string());
  if (!options.plane) wrong_usage("--film: expected --plane as well");
}

SeriesFilm::SeriesFilm(const SeriesFilmOptions& options, std::string name)
    : frames_per_second_(options.frames_per_second.value_or(kFrameRate)),
      name_(std::move(name)),
      scale_(name_ + ", " + to_string(*options.plane)) {
  require_film_maker(options.file);
  style_.plane = *options.plane;
  style_.field = options.field;
}

void SeriesFilm::add(double time, ResampledMesh& mesh, const MaterialColours& colours) {
  SliceInput input;
  input.name = name_;
  input.mesh = std::move(mesh);
  input.colours = colours;
  if (input.outline(style_.plane).empty())
    fail("{}: expected a plane that cuts {}, found {}", name_, box_text(input.box()),
         to_string(style_.plane));
  const CrossSection section = cut(input, SliceMode::kMaterials, style_);
  pictures_.push_back(make_slice_picture(input, {SliceMode::kMaterials}, style_, {section}));
  scale_.add(pictures_.back());
  times_.push_back(time);
  mesh = *std::move(input.mesh);
}

void SeriesFilm::write(const std::filesystem::path& path, Progress& progress) {
  std::unique_ptr<Film> film;
  for (std::size_t n = 0; n < pictures_.size(); ++n) {
    progress.step("drawing the film", static_cast<double>(n) / static_cast<double>(pictures_.size()));
    scale_.apply(n, times_[n], pictures_[n]);
    const Raster frame = draw_slice_frame(pictures_[n]);
    if (!film) film = std::make_unique<Film>(path, frame.width(), frame.height(), frames_per_second_);
    film->add(frame);
  }
  if (film) film->finish();
}

}  // namespace adamas::workflow
