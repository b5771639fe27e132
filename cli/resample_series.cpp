#include "cli/resample_series.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "adamas/resample_series.h"
#include "adamas/text.h"
#include "cli/figures.h"
#include "cli/series_figures.h"

namespace adamas::cli {

void resample_series(const InputArguments& input, const std::vector<SeriesEntry>& steps,
                     const ResampleOptions& resampling, const SeriesFiles& files, Session& session) {
  Console& console = session.console;
  ResampleSeriesOptions options;
  options.input = to_input_options(input);
  options.resampling = resampling;
  options.resampling.smooth_labels = input.smooth_labels;
  options.resampling.fractions = fraction_options(input);
  options.fraction_option = fraction_option(input);
  options.name = std::filesystem::path(files.series).filename().string();
  options.meshes = files.mesh;
  options.film = files.film.to_library();
  for (const std::string& file : files.curves)
    session.outputs.declare("--curves", file, {".csv", ".png", ".svg", ".pdf"});

  const ResampledSeries series = adamas::resample_series(steps, options, session.outputs, console);
  print_series(series, console);
  for (const std::string& file : files.curves)
    session.outputs.write(file, [&series](const auto& path) { write_series_curves(path, series); });
  Figures figures{{"steps", series_figures(series)},
                  {"damaged_steps", damaged_steps(series)},
                  {"seconds", console.seconds()},
                  {"peak_memory_bytes", peak_memory_bytes()}};
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  console.print("\n  {}, {:.2f} s, {} of memory at most\n", counted(series.steps.size(), "step"),
                console.seconds(), bytes_text(static_cast<double>(peak_memory_bytes())));
  session.commit();
  series.note_left_out(console);
}

}  // namespace adamas::cli
