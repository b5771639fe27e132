#include "cli/experiment_series.h"

#include <optional>

#include "cli/series_curves.h"
#include "cli/series_film.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "workflow/input/series_forms.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;

SeriesRecord follow_series(const ExperimentOptions& options, const ExperimentRequest& request,
                           const std::vector<SeriesEntry>& steps, const OutputFolder& folder,
                           Console& console) {
  const std::filesystem::path list = folder.file("mesh.pvd");
  std::optional<SeriesFilm> film;
  if (!options.film.file.empty())
    film.emplace(options.film.file, request.planes.front(), options.show,
                 std::filesystem::path(options.inputs.front()).filename().string());
  SeriesRecord record;
  workflow::SeriesForms forms;
  SeriesResampler resampler(request.resampling, console);
  std::vector<SeriesEntry> meshes;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const SeriesEntry& step = steps[n];
    console.about = step.file;
    InputArguments from = options.input;
    from.path = step.file;
    workflow::LoadedInput input;
    const auto check = [&request](const InputFacts& found) { check_options(request.resampling, found); };
    if (!record.left_out.read_input(n, from, check, console, input)) continue;
    forms.check(step.file, *input.data);
    if (record.steps.empty()) {
      if (input.source.fields) record.fields = input.source.fields->fields();
      record.density = request.density(record.fields, step.file);
    }
    ResampledMesh mesh;
    record.steps.push_back(resampler.resample(step, input, record.density, mesh));
    record.steps.back().number = n;
    if (film) film->add(step.time, mesh);
    meshes.push_back({step.time, step_file(list, n, ".vtu")});
    write_unstructured_mesh(folder.file(meshes.back().file), to_unstructured_mesh(mesh));
  }
  console.about.clear();
  record.left_out.check(steps.size());
  write_series(list, meshes);
  OutputStream csv(folder.file("series.csv"));
  csv.write(series_csv(record));
  csv.finish();
  if (film) film->write(folder.file(options.film.file), options.film.rate(), console);
  return record;
}

void add_series(HtmlReport& report, const SeriesRecord& record, const std::string& film,
                const std::filesystem::path& folder) {
  report.heading("Over time");
  report.paragraph(
      fmt::format("{} steps, each resampled from the mesh of the one before. mesh.pvd has the meshes, "
                  "series.csv the figures.",
                  record.steps.size()));
  for (const std::string& line : record.left_out.lines()) report.paragraph(line);
  if (!film.empty())
    report.film(read_file(folder / film), file_extension(film),
                "The mesh in a plane over time: " + film + ".");
  for (const SeriesCurve& curve : series_curves(record)) {
    const std::string png = draw_plot(curve.plot, PictureFormat::kPng);
    write_bytes(folder / (curve.name + ".png"), png);
    write_bytes(folder / (curve.name + ".svg"), draw_plot(curve.plot, PictureFormat::kSvg));
    report.picture(png, PictureFormat::kPng, curve.caption);
  }
  for (const TextTable& table : series_tables(record)) report.table(table);
}

}  // namespace adamas::cli
