#include "adamas/resample_series.h"

#include <optional>

#include "adamas/series_output.h"
#include "core/base/loop_progress.h"
#include "core/picture/film.h"
#include "workflow/output/resampled_mesh_output.h"
#include "workflow/series/resample_steps.h"
#include "workflow/series/series_film.h"

namespace adamas {

using namespace interfaces;
using namespace io;
using namespace workflow;

ResampledSeries resample_series(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
                                OutputSet& outputs, Progress& progress) {
  const LoopProgress loops(progress);
  check_film(options.film);
  std::vector<double> times;
  for (const SeriesEntry& step : steps) {
    outputs.protect(step.file);
    times.push_back(step.time);
  }
  std::optional<SeriesOutput> meshes;
  if (!options.meshes.empty()) meshes.emplace(options.meshes, times, ".vtu", outputs);
  outputs.declare("--film", options.film.file.string(), picture::film_endings());
  std::optional<SeriesFilm> film;
  if (!options.film.file.empty()) film.emplace(options.film, options.name);

  StepActions actions;
  actions.finish = [&](std::size_t n, ResampledMesh& mesh, const MaterialColours& colours) {
    if (film) film->add(steps[n].time, mesh, colours);
    if (!meshes) return;
    progress.step("writing " + options.meshes.string(), -1);
    meshes->write(
        n, [&](const auto& path) { write_resampled_mesh(path, mesh, colours); }, outputs);
  };
  actions.leave_out = [&](std::size_t n) {
    if (meshes) meshes->leave_out(n, outputs);
  };
  ResampledSeries series = resample_steps(steps, options, actions, progress);
  if (meshes) meshes->write_list(outputs);
  outputs.write(options.film.file.string(), [&](const auto& path) { film->write(path, progress); });
  return series;
}

}  // namespace adamas
