#include "workflow/experiments/experiment_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "adamas/file_names.h"
#include "adamas/report_text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/picture/html_report.h"
#include "core/picture/plot.h"
#include "workflow/series/series_report.h"

namespace adamas::workflow {

using namespace picture;

namespace {

constexpr const char* kErrorPlot = "interface-error.png";
constexpr const char* kFieldPlot = "field-error.png";

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }
/// Replaces the NaN of an error at places that do not exist by 0.
double or_zero(double value) { return std::isnan(value) ? 0 : value; }
std::string digits(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "-"; }

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void add_pictures(HtmlReport& report, const std::vector<ExperimentPicture>& pictures,
                  const std::filesystem::path& folder) {
  for (const auto& [file, caption] : pictures) {
    const std::string bytes = read_bytes(folder / file);
    if (file.ends_with(".html")) {
      report.page(bytes, caption);
    } else {
      report.picture(bytes, PictureFormat::kPng, caption);
    }
  }
}

double upper(const ExperimentRun& run) {
  const auto& distance = run.report.interface_error;
  return distance ? distance->certified : std::numeric_limits<double>::quiet_NaN();
}

double lower(const ExperimentRun& run) {
  return run.report.interface_error ? run.report.interface_error->found : 0;
}

Plot interface_plot(const std::vector<ExperimentRun>& runs) {
  Plot plot;
  plot.x = {"tetrahedra", AxisKind::kLogarithmic};
  plot.y = {"interface error", AxisKind::kLogarithmic};
  plot.series = {{.name = "wanted", .markers = false, .dashed = true},
                 {.name = "certified"},
                 {.name = "attained (lower bound)"}};
  for (const ExperimentRun& run : runs) {
    for (PlotSeries& series : plot.series) series.x.push_back(static_cast<double>(run.report.tetrahedra));
    plot.series[0].y.push_back(run.report.interface_error_target);
    plot.series[1].y.push_back(upper(run));
    plot.series[2].y.push_back(lower(run));
  }
  return plot;
}

/// Plots a curve for each field: its mean error in cells with an interface, as a part of the field's range.
Plot field_plot(const std::vector<ExperimentRun>& runs, const std::vector<FieldRange>& fields) {
  Plot plot;
  plot.x = {"tetrahedra", AxisKind::kLogarithmic};
  plot.y = {"mean field error in cells with interfaces / range", AxisKind::kLogarithmic};
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const double range = fields[f].max - fields[f].min;
    PlotSeries series{.name = fields[f].name};
    for (const ExperimentRun& run : runs) {
      series.x.push_back(static_cast<double>(run.report.tetrahedra));
      series.y.push_back(range > 0 ? or_zero(run.report.fields[f].at_interfaces.mean_error) / range : 0);
    }
    // The errors of a field that the mesh reproduces exactly are round-off, which would stretch the axis.
    if (*std::max_element(series.y.begin(), series.y.end()) > 1e-12) plot.series.push_back(std::move(series));
  }
  return plot;
}

TextTable runs_table(const ExperimentRecord& record, const std::vector<ExperimentRun>& runs,
                     const std::string& caption) {
  TextTable table{caption,
                  {"interface error wanted", "certified", "attained", "tetrahedra", "with interfaces",
                   "vertices", "seconds"},
                  {}};
  const bool fields = !record.fields.empty();
  if (fields) {
    const std::string& name = record.fields[record.shown].name;
    for (const char* what : {"greatest error of ", "mean error of "}) table.header.push_back(what + name);
  }
  for (const ExperimentRun& run : runs) {
    table.rows.push_back({number(run.report.interface_error_target), number(upper(run)), number(lower(run)),
                          std::to_string(run.report.tetrahedra),
                          std::to_string(run.report.interface_tetrahedra),
                          std::to_string(run.report.vertices), fmt::format("{:.2f}", run.seconds)});
    if (!fields) continue;
    const ResampleReport::Errors& errors = run.report.fields[record.shown].everywhere;
    table.rows.back().push_back(number(errors.max_error));
    table.rows.back().push_back(number(errors.mean_error));
  }
  return table;
}

/// Makes a table of the errors that were wanted and not reached, mesh by mesh.
TextTable unreached_table(const ExperimentRecord& record) {
  TextTable table{"Errors that were not reached", {"mesh", "what, and why"}, {}};
  for (const auto& [mesh, run] : record.wanted_runs()) {
    for (const std::string& line : unreached_lines(run->report)) table.rows.push_back({mesh, line});
  }
  if (!record.series) return table;
  for (const ResampledStep& step : record.series->steps) {
    for (const std::string& line : unreached_lines(step.report))
      table.rows.push_back({"step " + std::to_string(step.number), line});
  }
  return table;
}

TextTable triangles_table(const ExperimentRecord& record) {
  TextTable table{"Interfaces of the input", {"between", "triangles"}, {}};
  for (const auto& [pair, count] : record.triangles) table.rows.push_back({pair, std::to_string(count)});
  return table;
}

TextTable fields_table(const ExperimentRecord& record) {
  TextTable table{"Field errors at the input's own values",
                  {"field", "unit", "range", "wanted", "greatest", "mean", "greatest at interfaces",
                   "mean at interfaces"},
                  {}};
  const ExperimentRun& run = record.last();
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    const FieldRange& info = record.fields[f];
    const ResampleReport::Field& field = run.report.fields[f];
    const std::optional<double>& wanted = field.target;
    table.rows.push_back({info.name, info.unit, number(info.min) + " to " + number(info.max),
                          wanted ? number(*wanted) : "-", number(field.everywhere.max_error),
                          number(field.everywhere.mean_error), number(field.at_interfaces.max_error),
                          number(field.at_interfaces.mean_error)});
  }
  return table;
}

TextTable nested_table(const ExperimentRecord& record) {
  TextTable table{
      "Field errors of tetrahedra that were split, made monotone",
      {"field", "tetrahedra", "greatest", "mean", "greatest, D 3.1", "mean, D 3.1", "undefined, D 3.1"},
      {}};
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    const NestedFieldErrors& nested = record.last().nested[f];
    table.rows.push_back({record.fields[f].name, std::to_string(nested.tetrahedra), number(nested.greatest),
                          number(nested.mean), number(nested.corrected_greatest),
                          number(nested.corrected_mean), std::to_string(nested.undefined)});
  }
  return table;
}

TextTable published_table(const ExperimentRecord& record) {
  TextTable table{"Figures beside those of " + record.published_by, {"", "published", "here", "ratio"}, {}};
  for (const PublishedFigure& figure : record.published)
    table.rows.push_back(
        {figure.name, digits(figure.published), digits(figure.here), number(figure.here / figure.published)});
  return table;
}

std::string difference(double before, double after) {
  return std::isfinite(after - before) ? difference_text(before, after) : "-";
}

TextTable ledger_table(const ExperimentRecord& record) {
  TextTable table{"What the files hold, material by material",
                  {"material", "volume, input", "volume, mesh", "difference"},
                  {}};
  const bool masses = !record.density.empty();
  if (masses) table.header.insert(table.header.end(), {"mass, input", "mass, mesh", "difference"});
  MaterialBalance all{.material = "all"};
  const auto add_row = [&](const MaterialBalance& row) {
    table.rows.push_back({row.material, digits(row.volume_input), digits(row.volume_mesh),
                          difference(row.volume_input, row.volume_mesh)});
    if (masses)
      table.rows.back().insert(table.rows.back().end(), {digits(row.mass_input), digits(row.mass_mesh),
                                                         difference(row.mass_input, row.mass_mesh)});
  };
  for (const MaterialBalance& row : record.balance) {
    add_row(row);
    all.volume_input += row.volume_input, all.volume_mesh += row.volume_mesh;
    if (!std::isfinite(row.mass_input + row.mass_mesh)) continue;
    all.mass_input += row.mass_input, all.mass_mesh += row.mass_mesh;
  }
  add_row(all);
  return table;
}

void add_curves(HtmlReport& report, const ExperimentRecord& record, const std::filesystem::path& folder) {
  report.heading("Error against tetrahedra");
  const auto add = [&](const char* file, const Plot& plot, const char* caption) {
    if (plot.series.empty()) return;
    const std::string png = draw_plot(plot, PictureFormat::kPng);
    write_bytes(folder / file, png);
    report.picture(png, PictureFormat::kPng, caption);
  };
  add(kErrorPlot, interface_plot(record.curve),
      "Two-sided distance between the interfaces of input and mesh: no point is farther than the certified "
      "error.");
  add(kFieldPlot, field_plot(record.curve, record.fields),
      "Mean field errors in the cells with interfaces, as parts of each field's range; those at round-off "
      "are left out.");
  report.table(runs_table(record, record.curve, "Refined for interfaces alone, from coarse to fine"));
}

/// Adds the section about the series, and draws its curves into the folder.
void add_series(HtmlReport& report, ExperimentRecord& experiment, const std::filesystem::path& folder) {
  const ResampledSeries& series = *experiment.series;
  report.heading("Over time");
  report.paragraph(
      fmt::format("{} steps, each resampled from the mesh of the one before. mesh.pvd has the meshes, "
                  "series.csv the figures.",
                  series.steps.size()));
  for (const LeftOutStep& step : series.left_out) report.paragraph(step.text());
  if (!experiment.film.empty())
    report.film(io::read_file(folder / experiment.film), file_extension(experiment.film),
                "The mesh in a plane over time: " + experiment.film + ".");
  for (const SeriesCurve& curve : series_curves(series)) {
    const std::string png = draw_plot(curve.plot, PictureFormat::kPng);
    write_bytes(folder / (curve.name + ".png"), png);
    write_bytes(folder / (curve.name + ".svg"), draw_plot(curve.plot, PictureFormat::kSvg));
    for (const char* ending : {".png", ".svg"})
      experiment.series_pictures.push_back({curve.name + ending, curve.caption});
    report.picture(png, PictureFormat::kPng, curve.caption);
  }
  for (const TextTable& table : series_tables(series)) report.table(table);
}

void add_key_figures(HtmlReport& report, const ExperimentRecord& record) {
  const ExperimentRun& run = record.last();
  std::vector<KeyFigure> figures{{"tetrahedra", std::to_string(run.report.tetrahedra), ""},
                                 {"certified interface error", number(upper(run)), ""}};
  if (!record.fields.empty()) {
    const FieldRange& shown = record.fields[record.shown];
    figures.push_back({"greatest error of " + shown.name,
                       number(run.report.fields[record.shown].everywhere.max_error), shown.unit});
  }
  const auto& worst = run.report.worst_volume;
  if (run.report.volume_error_target && worst) {
    const double error = run.report.bodies[*worst].volume_error();
    figures.push_back({"greatest volume error of a body", number(100 * error) + "%", ""});
  }
  figures.push_back({"time", fmt::format("{:.2f}", run.seconds), "s"});
  report.key_figures(figures);
}

}  // namespace

void write_experiment_report(ExperimentRecord& record, const std::filesystem::path& folder) {
  HtmlReport report(record.title, record.input);
  add_key_figures(report, record);
  report.heading("The input and its interfaces");
  add_pictures(report, record.input_pictures, folder);
  report.table(triangles_table(record));
  report.heading("The mesh");
  add_pictures(report, record.mesh_pictures, folder);
  report.table(runs_table(record, {record.interfaces}, "Refined for interfaces alone"));
  if (record.with_fields)
    report.table(runs_table(record, {*record.with_fields}, "Refined for interfaces and fields"));
  if (const TextTable unreached = unreached_table(record); !unreached.rows.empty()) report.table(unreached);
  if (!record.fields.empty()) {
    report.table(fields_table(record));
    report.paragraph(
        "A tetrahedron's error must not be less than those of its parts. The greatest error below is the "
        "tightest such bound; vertex corrections (D 3.1) add up what each new vertex changes.");
    report.table(nested_table(record));
  }
  if (!record.slices.empty()) {
    report.heading("Slices");
    add_pictures(report, record.slices, folder);
  }
  add_curves(report, record, folder);
  if (record.series) add_series(report, record, folder);
  if (!record.published.empty()) {
    report.heading("Beside published figures");
    report.table(published_table(record));
  }
  report.heading("Ledger");
  report.paragraph(
      "Recomputed from the files: sums over the cells of the input, and integrals of the linear fields over "
      "each material's part of the cells of mesh.vtu.");
  report.table(ledger_table(record));
  report.write(folder / "report.html");
}

}  // namespace adamas::workflow
