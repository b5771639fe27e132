#include "cli/resample_series.h"

#include <nlohmann/json.hpp>

#include "adamas/series_output.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_curves.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/film.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "workflow/input/series_forms.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;

namespace {

void write_text(const std::filesystem::path& path, const std::string& text) {
  OutputStream stream(path);
  stream.write(text);
  stream.finish();
}

/// The curves side by side, or the figures behind them.
void write_curves(const std::filesystem::path& path, const SeriesRecord& record) {
  if (file_extension(path) == ".csv") return write_text(path, series_csv(record));
  std::vector<Plot> plots;
  for (SeriesCurve& curve : series_curves(record)) plots.push_back(std::move(curve.plot));
  write_bytes(path, draw_plots(plots, picture_format(path), {.columns = 2}));
}

}  // namespace

void resample_series(const InputArguments& input, const std::vector<SeriesEntry>& steps,
                     const ResampleOptions& resampling, const SeriesOutputs& outputs, Session& session) {
  Console& console = session.console;
  std::vector<double> times;
  for (const SeriesEntry& step : steps) {
    session.outputs.protect(step.file);
    times.push_back(step.time);
  }
  std::optional<SeriesOutput> meshes;
  if (!outputs.mesh.empty()) meshes.emplace(outputs.mesh, times, ".vtu", session.outputs);
  for (const std::string& file : outputs.curves)
    session.outputs.declare("--curves", file, {".csv", ".png", ".svg", ".pdf"});

  session.outputs.declare("--film", outputs.film.file, film_endings());
  std::optional<SeriesFilm> film;
  if (!outputs.film.file.empty())
    film.emplace(outputs.film.file, parse_plane_option("--plane", outputs.film.plane), outputs.film.show,
                 std::filesystem::path(outputs.series).filename().string());

  SeriesRecord record;
  workflow::SeriesForms forms;
  SeriesResampler resampler(resampling, console);
  for (std::size_t n = 0; n < steps.size(); ++n) {
    console.about = steps[n].file;
    InputArguments from = input;
    from.path = steps[n].file;
    workflow::LoadedInput read;
    const auto check = [&resampling](const InputFacts& found) { check_options(resampling, found); };
    if (!record.left_out.read_input(n, from, check, console, read)) {
      if (meshes) meshes->leave_out(n, session.outputs);
      continue;
    }
    forms.check(steps[n].file, *read.data);
    if (record.steps.empty()) {
      if (read.source.fields) record.fields = read.source.fields->fields();
      record.density = density_field("", record.fields, steps[n].file);
    }
    ResampledMesh mesh;
    record.steps.push_back(resampler.resample(steps[n], read, record.density, mesh));
    record.steps.back().number = n;
    if (film) film->add(steps[n].time, mesh);
    if (!meshes) continue;
    console.step("writing " + outputs.mesh, -1);
    meshes->write(
        n, [&](const auto& path) { write_unstructured_mesh(path, to_unstructured_mesh(mesh)); },
        session.outputs);
  }
  console.about.clear();
  record.left_out.check(steps.size());
  if (meshes) meshes->write_list(session.outputs);
  session.outputs.write(outputs.film.file,
                        [&](const auto& path) { film->write(path, outputs.film.rate(), console); });
  print_series(record, console);
  for (const std::string& file : outputs.curves)
    session.outputs.write(file, [&record](const auto& path) { write_curves(path, record); });
  Figures figures{{"steps", series_figures(record)},
                  {"damaged_steps", record.left_out.numbers()},
                  {"seconds", console.seconds()},
                  {"peak_memory_bytes", peak_memory_bytes()}};
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  console.print("\n  {}, {:.2f} s, {} of memory at most\n", counted(record.steps.size(), "step"),
                console.seconds(), bytes_text(static_cast<double>(peak_memory_bytes())));
  session.commit();
  record.left_out.note(console);
}

}  // namespace adamas::cli
