#include "cli/compare_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "adamas/report_text.h"
#include "cli/figures.h"
#include "cli/resample_figures.h"
#include "core/picture/plot.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/reference/sizing_search.h"

namespace adamas::cli {

using namespace interfaces;
using namespace picture;

namespace {

/// The greatest error of all fields, each as a part of the range of its field.
struct RelativeErrors {
  std::optional<double> max, mean, interface_max, interface_mean;
};

RelativeErrors relative_errors(const ComparedMesh& row, const ResamplingSource& source) {
  RelativeErrors result;
  const auto raise = [](std::optional<double>& to, double value) { to = std::max(to.value_or(0), value); };
  for (std::size_t f = 0; f < row.figures.fields.size(); ++f) {
    const FieldInfo& info = source.fields->fields()[f];
    const double range = info.max - info.min;
    const auto& [all, near] = row.figures.fields[f];
    if (!(range > 0) || all.count() == 0) continue;
    raise(result.max, all.max / range);
    raise(result.mean, all.mean() / range);
    if (near.count() == 0) continue;
    raise(result.interface_max, near.max / range);
    raise(result.interface_mean, near.mean() / range);
  }
  return result;
}

/// The greatest relative difference between a material's volume in the mesh and in the input.
std::optional<double> volume_error(const ComparedMesh& row, const ResamplingSource& source) {
  std::optional<double> result;
  for (MaterialId m(0); m.value < source.volumes.size(); ++m.value) {
    if (!(source.volumes[m] > 0)) continue;
    const double error = std::abs(row.figures.volumes[m] / source.volumes[m] - 1);
    result = std::max(result.value_or(0), error);
  }
  return result;
}

std::string percent(const std::optional<double>& part) {
  return part ? fmt::format("{:.3g}", 100 * *part) : "-";
}

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "none";
}

/// A column of the table. Rows are printed one by one, so that its width is fixed: that of the widest usual
/// entry.
struct Column {
  const char* name;
  std::size_t width;
};
constexpr Column kTable[] = {{"mesh", 22},
                             {"error wanted", 12},
                             {"tetrahedra", 10},
                             {"vertices", 8},
                             {"seconds", 8},
                             {"memory", 9},
                             {"dihedral angles", 15},
                             {"condition", 9},
                             {"to input", 10},
                             {"from input", 10},
                             {"field error % max / mean", 24},
                             {"at interfaces", 16},
                             {"volume %", 8}};

std::vector<std::string> text_row(const ComparedMesh& row, const ResamplingSource& source) {
  std::vector<std::string> result{mesh_name(row.kind),
                                  row.interface_error ? short_number(*row.interface_error) : "-"};
  if (!row.failure.empty()) {
    result.resize(std::size(kTable), "-");
    return result;
  }
  const MeshFigures& f = row.figures;
  const RelativeErrors errors = relative_errors(row, source);
  result.insert(result.end(),
                {std::to_string(f.tetrahedra), std::to_string(f.vertices), fmt::format("{:.3f}", row.seconds),
                 bytes_text(static_cast<double>(row.peak_memory_bytes)),
                 fmt::format("{:.1f} - {:.1f}", f.dihedral.min, f.dihedral.max),
                 short_number(f.condition_number), short_number(f.distance.to_input),
                 short_number(f.distance.from_input), percent(errors.max) + " / " + percent(errors.mean),
                 percent(errors.interface_max) + " / " + percent(errors.interface_mean),
                 percent(volume_error(row, source))});
  return result;
}

void print_line(const std::vector<std::string>& cells, Console& console) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c)
    line += c == 0 ? fmt::format("  {:<{}}", cells[c], kTable[c].width)
                   : fmt::format("  {:>{}}", cells[c], kTable[c].width);
  line.erase(line.find_last_not_of(' ') + 1);
  console.print("{}\n", line);
}

Figures optional_figure(const std::optional<double>& value) {
  return value ? Figures(*value) : Figures(nullptr);
}

Figures field_figures(const ComparedMesh& row, const ResamplingSource& source) {
  Figures figures = Figures::object();
  for (std::size_t f = 0; f < row.figures.fields.size(); ++f)
    figures[source.fields->fields()[f].name] =
        field_error_figures(field_report(source.fields->fields()[f], row.figures.fields[f]));
  return figures;
}

Figures row_figures(const ComparedMesh& row, const ResamplingSource& source) {
  Figures figures;
  figures["name"] = mesh_name(row.kind);
  figures["interface_error_target"] = optional_figure(row.interface_error);
  figures["failure"] = row.failure.empty() ? Figures(nullptr) : Figures(row.failure);
  figures["note"] = row.note.empty() ? Figures(nullptr) : Figures(row.note);
  figures["switches"] = row.switches.empty() ? Figures(nullptr) : Figures(row.switches);
  figures["trials"] = row.trials;
  figures["matched"] = row.matched;
  const bool made = row.failure.empty();
  const auto when_made = [&](auto value) { return made ? Figures(value) : Figures(nullptr); };
  const MeshFigures& f = row.figures;
  figures["tetrahedra"] = when_made(f.tetrahedra);
  figures["vertices"] = when_made(f.vertices);
  figures["seconds"] = when_made(row.seconds);
  figures["seconds_certifying"] = when_made(row.certifying_seconds);
  figures["seconds_fields"] = when_made(row.field_seconds);
  figures["peak_memory_bytes"] = when_made(row.peak_memory_bytes);
  figures["dihedral_min"] = when_made(f.dihedral.min);
  figures["dihedral_max"] = when_made(f.dihedral.max);
  figures["condition_number"] = when_made(f.condition_number);
  figures["hausdorff_to_input"] = when_made(f.distance.to_input);
  figures["hausdorff_from_input"] = when_made(f.distance.from_input);
  const RelativeErrors errors = made ? relative_errors(row, source) : RelativeErrors{};
  figures["field_max_error"] = optional_figure(errors.max);
  figures["field_mean_error"] = optional_figure(errors.mean);
  figures["field_interface_max_error"] = optional_figure(errors.interface_max);
  figures["field_interface_mean_error"] = optional_figure(errors.interface_mean);
  figures["fields"] = made ? field_figures(row, source) : Figures::object();
  figures["materials"] =
      made ? volume_figures(material_reports(source, row.figures.volumes)) : Figures::array();
  return figures;
}

constexpr std::array kJoined{MeshKind::kOwn,
                             MeshKind::kOwnCut,
                             MeshKind::kTetGen,
                             MeshKind::kMesh3,
                             MeshKind::kMesh3Optimised,
                             MeshKind::kTetGenSimplified,
                             MeshKind::kMesh3Simplified,
                             MeshKind::kMesh3Labels};

/// One diagram: a line for each generator with a measured distance, a horizontal line for one without.
Plot make_plot(const std::vector<ComparedMesh>& rows, const std::string& title, const std::string& label,
               double (*value)(const ComparedMesh&)) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "measured two-sided distance of interfaces", .kind = AxisKind::kLogarithmic};
  plot.y = {.label = label, .kind = AxisKind::kLogarithmic};
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const MeshKind kind : kJoined) {
    PlotSeries series{.name = mesh_name(kind)};
    for (const ComparedMesh& row : rows) {
      const double distance = row.figures.distance.greatest();
      if (row.kind != kind || !row.failure.empty() || !std::isfinite(distance) || !(distance > 0)) continue;
      series.x.push_back(distance);
      series.y.push_back(value(row));
      nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
    }
    if (!series.x.empty()) plot.series.push_back(series);
  }
  for (const ComparedMesh& row : rows) {
    if (row.kind != MeshKind::kTetGenUntouched || !row.failure.empty() || !(farthest > 0)) continue;
    plot.series.push_back({.name = mesh_name(row.kind) + ", distance 0",
                           .x = {nearest, farthest},
                           .y = {value(row), value(row)},
                           .markers = false,
                           .dashed = true});
  }
  return plot;
}

}  // namespace

void print_plan(const ComparisonOptions& options, Console& console) {
  const std::size_t errors = options.interface_errors.size();
  const double seconds = options.mesher.limits.seconds;
  std::string others;
  if (options.tetgen)
    others += "TetGen with the input's interfaces, with ours, and with the input's simplified";
  if (options.mesh3)
    others += fmt::format(
        "{}Mesh_3, in up to {} trials of its size, once more with its optimisers, and from the input's "
        "simplified{}",
        options.tetgen ? "; " : "", SizingOptions().most_trials, options.image ? " and its labels" : "");
  const std::size_t meshes = reference_count(options);
  console.print(
      "Comparing at {} interface error{}: adamas; {}. {} mesh{} of other generators, at most {:g} s each and "
      "{:g} s in all, beside measuring them.\n\n",
      errors, errors == 1 ? "" : "s", others, meshes, meshes == 1 ? "" : "es", seconds,
      seconds * static_cast<double>(meshes));
  console.flush();
}

void print_comparison_header(Console& console) {
  std::vector<std::string> names;
  for (const Column& column : kTable) names.emplace_back(column.name);
  print_line(names, console);
  console.flush();
}

void print_comparison_row(const ComparedMesh& row, const ResamplingSource& source, Console& console) {
  print_line(text_row(row, source), console);
  std::string said;
  const auto add = [&said](const std::string& text) { said += (said.empty() ? "" : "; ") + text; };
  if (!row.failure.empty()) add("failed: " + row.failure);
  if (!row.note.empty()) add(row.note);
  if (row.kind == MeshKind::kOwn)
    add(fmt::format("{:.3f} s of it to certify the distance", row.certifying_seconds));
  const bool sized = row.kind == MeshKind::kMesh3 || row.kind == MeshKind::kMesh3Optimised ||
                     row.kind == MeshKind::kMesh3Simplified || row.kind == MeshKind::kMesh3Labels;
  if (sized && !row.matched && row.failure.empty())
    add(fmt::format("the distance was not matched within {:g}%", 100 * SizingOptions().tolerance));
  if (!row.switches.empty()) add(row.switches);
  if (row.trials > 0) add(counted(row.trials, "trial"));
  if (!said.empty()) console.print("      {}\n", said);
  for (const UnreachedError& error : row.unreached) console.note_incomplete("{}", unreached_text(error));
  console.flush();
}

Figures comparison_figures(const std::vector<ComparedMesh>& rows, const ResamplingSource& source) {
  Figures figures = Figures::array();
  for (const ComparedMesh& row : rows) figures.push_back(row_figures(row, source));
  return figures;
}

std::string comparison_csv(const std::vector<ComparedMesh>& rows, const ResamplingSource& source) {
  constexpr const char* kColumns[] = {"name",
                                      "interface_error_target",
                                      "tetrahedra",
                                      "vertices",
                                      "seconds",
                                      "seconds_certifying",
                                      "seconds_fields",
                                      "peak_memory_bytes",
                                      "dihedral_min",
                                      "dihedral_max",
                                      "condition_number",
                                      "hausdorff_to_input",
                                      "hausdorff_from_input",
                                      "field_max_error",
                                      "field_mean_error",
                                      "field_interface_max_error",
                                      "field_interface_mean_error",
                                      "trials",
                                      "matched",
                                      "switches",
                                      "failure",
                                      "note"};
  std::string csv;
  for (const char* column : kColumns) csv += (csv.empty() ? "" : ",") + std::string(column);
  csv += ",volume_error\n";
  for (const ComparedMesh& row : rows) {
    const Figures figures = row_figures(row, source);
    for (const char* column : kColumns) {
      const Figures& value = figures[column];
      if (value.is_string()) {
        csv += csv_text(value.get<std::string>());
      } else if (!value.is_null()) {
        csv += value.dump();
      }
      csv += ",";
    }
    const auto volume = row.failure.empty() ? volume_error(row, source) : std::nullopt;
    csv += (volume ? fmt::format("{}", *volume) : "") + "\n";
  }
  return csv;
}

void write_comparison_picture(const std::filesystem::path& path, const std::vector<ComparedMesh>& rows,
                              const std::string& title) {
  const std::array plots{
      make_plot(rows, title + ": tetrahedra", "tetrahedra",
                [](const ComparedMesh& row) { return static_cast<double>(row.figures.tetrahedra); }),
      make_plot(rows, title + ": seconds", "seconds", [](const ComparedMesh& row) { return row.seconds; })};
  write_bytes(path, draw_plots(plots, picture_format(path), {.width = 1000, .height = 800}));
}

}  // namespace adamas::cli
