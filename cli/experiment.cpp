#include "adamas/experiment.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/output_folder.h"
#include "adamas/report_text.h"
#include "cli/command.h"
#include "cli/experiment_figures.h"
#include "cli/experiment_options.h"
#include "cli/series_figures.h"

namespace adamas::cli {

namespace {

void print_record(const ExperimentRecord& record, const std::string& folder, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"mesh", "tetrahedra", "with interfaces", "interface error", "seconds"}};
  const auto add = [&](const std::string& name, const ExperimentRun& run) {
    rows.push_back(
        {name, std::to_string(run.report.tetrahedra), std::to_string(run.report.interface_tetrahedra),
         run.report.interface_error ? fmt::format("{:.4g}", run.report.interface_error->certified) : "-",
         fmt::format("{:.2f}", run.seconds)});
  };
  add("interfaces", record.interfaces);
  if (record.with_fields) add("with fields", *record.with_fields);
  console.table(rows);
  // Errors of the steps of a series, of which the input is one, were noted as the meshes were made.
  for (const auto& [mesh, run] : record.wanted_runs()) {
    const bool told = record.series && (run == &record.interfaces || run == &record.last());
    if (told) continue;
    for (const std::string& line : unreached_lines(run->report, console.verbose))
      console.note_incomplete("{}: {}", mesh, line);
  }
  if (record.series) {
    console.print("\n");
    print_series(*record.series, console);
  }
  if (!record.published.empty()) {
    rows = {{"", record.published_by, "here"}};
    for (const PublishedFigure& figure : record.published)
      rows.push_back(
          {figure.name, fmt::format("{:.6g}", figure.published), fmt::format("{:.6g}", figure.here)});
    console.print("\n");
    console.table(rows);
  }
  // Two curves of error against tetrahedra are in the folder besides these pictures.
  const std::size_t pictures = record.input_pictures.size() + record.mesh_pictures.size() +
                               record.slices.size() + record.series_pictures.size() + 2;
  console.print("\n  {}: report.html, metrics.json and {} pictures\n", folder, pictures);
}

void run(ExperimentArguments& arguments, Session& session) {
  const ExperimentOptions options = to_experiment_options(arguments);
  options.check();
  Console& console = session.console;
  for (const SeriesEntry& step : options.steps) session.outputs.protect(step.file);
  protect_inputs(arguments.input, with_main_file(arguments.input).path, session.outputs);
  session.outputs.protect_other(arguments.output);
  session.outputs.check_outside("-o", arguments.output);
  OutputFolder folder("an experiment", arguments.output, arguments.overwrite);
  const ExperimentRecord record = run_experiment(options, folder, console);
  Figures figures = experiment_figures(record);
  figures["seconds"] = console.seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
  folder.fill([&] { write_figures(folder.file("metrics.json"), figures); });
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  console.check();
  print_record(record, arguments.output, console);
  console.flush();
  folder.commit();
  session.commit();
  if (record.series) record.series->note_left_out(console);
}

}  // namespace

void add_experiment(const Command& app, Session& session) {
  const auto options = std::make_shared<ExperimentArguments>();
  const Command command = add_command(app, session, "experiment",
                                      "A resampling experiment from one file, with pictures and a report",
                                      "adamas experiment -c datasets/impact.toml -o impact\n"
                                      "  adamas experiment run.pvd --plane z=0 --film film.mp4 -o run",
                                      [options, &session] { run(*options, session); });
  add_experiment_options(command, *options);
}

}  // namespace adamas::cli
