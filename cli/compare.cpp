#include "adamas/compare.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "adamas/comparison_picture.h"
#include "adamas/files.h"
#include "adamas/report_text.h"
#include "adamas/verify.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/resample_figures.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

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

std::vector<std::string> text_row(const ComparisonRow& row) {
  std::vector<std::string> result{mesh_name(row.kind),
                                  row.interface_error ? short_number(*row.interface_error) : "-"};
  if (!row.failure.empty()) {
    result.resize(std::size(kTable), "-");
    return result;
  }
  result.insert(
      result.end(),
      {std::to_string(row.tetrahedra), std::to_string(row.vertices), fmt::format("{:.3f}", row.seconds),
       bytes_text(static_cast<double>(row.peak_memory_bytes)),
       fmt::format("{:.1f} - {:.1f}", row.dihedral_min, row.dihedral_max), short_number(row.condition_number),
       short_number(row.distance_to_input), short_number(row.distance_from_input),
       percent(row.field_max_error) + " / " + percent(row.field_mean_error),
       percent(row.field_interface_max_error) + " / " + percent(row.field_interface_mean_error),
       percent(row.volume_error)});
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

/// The text; null where it is empty.
Figures text_figure(const std::string& text) { return text.empty() ? Figures(nullptr) : Figures(text); }

Figures field_figures(const ComparisonRow& row) {
  Figures figures = Figures::object();
  for (const ResampleReport::Field& field : row.fields) figures[field.name] = field_error_figures(field);
  return figures;
}

Figures row_figures(const ComparisonRow& row) {
  Figures figures;
  figures["name"] = mesh_name(row.kind);
  figures["interface_error_target"] = figure(row.interface_error);
  figures["failure"] = text_figure(row.failure);
  figures["note"] = text_figure(row.note);
  figures["switches"] = text_figure(row.switches);
  figures["trials"] = row.trials;
  figures["matched"] = row.matched;
  const bool made = row.failure.empty();
  const auto when_made = [&](auto value) { return made ? Figures(value) : Figures(nullptr); };
  figures["tetrahedra"] = when_made(row.tetrahedra);
  figures["vertices"] = when_made(row.vertices);
  figures["seconds"] = when_made(row.seconds);
  figures["seconds_certifying"] = when_made(row.certifying_seconds);
  figures["seconds_fields"] = when_made(row.field_seconds);
  figures["peak_memory_bytes"] = when_made(row.peak_memory_bytes);
  figures["dihedral_min"] = when_made(row.dihedral_min);
  figures["dihedral_max"] = when_made(row.dihedral_max);
  figures["condition_number"] = when_made(row.condition_number);
  figures["hausdorff_to_input"] = when_made(row.distance_to_input);
  figures["hausdorff_from_input"] = when_made(row.distance_from_input);
  figures["field_max_error"] = figure(row.field_max_error);
  figures["field_mean_error"] = figure(row.field_mean_error);
  figures["field_interface_max_error"] = figure(row.field_interface_max_error);
  figures["field_interface_mean_error"] = figure(row.field_interface_mean_error);
  figures["fields"] = field_figures(row);
  figures["materials"] = volume_figures(row.materials);
  return figures;
}

void print_plan(const CompareOptions& options, bool labels, Console& console) {
  const std::size_t errors = std::max<std::size_t>(options.interface_errors.size(), 1);
  const double seconds = options.time_limit;
  std::string others;
  if (options.tetgen)
    others += "TetGen with the input's interfaces, with ours, and with the input's simplified";
  if (options.mesh3)
    others += fmt::format(
        "{}Mesh_3, in up to {} trials of its size, once more with its optimisers, and from the input's "
        "simplified{}",
        options.tetgen ? "; " : "", kMostSizingTrials, labels ? " and its labels" : "");
  const std::size_t meshes = options.reference_count(labels);
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

void print_comparison_row(const ComparisonRow& row, Console& console) {
  print_line(text_row(row), console);
  std::string remarks;
  const auto add = [&remarks](const std::string& text) { remarks += (remarks.empty() ? "" : "; ") + text; };
  if (!row.failure.empty()) add("failed: " + row.failure);
  if (!row.note.empty()) add(row.note);
  if (row.kind == MeshKind::kOwn)
    add(fmt::format("{:.3f} s of it to certify the distance", row.certifying_seconds));
  const bool sized = row.kind == MeshKind::kMesh3 || row.kind == MeshKind::kMesh3Optimised ||
                     row.kind == MeshKind::kMesh3Simplified || row.kind == MeshKind::kMesh3Labels;
  if (sized && !row.matched && row.failure.empty())
    add(fmt::format("the distance was not matched within {:g}%", 100 * kSizingTolerance));
  if (!row.switches.empty()) add(row.switches);
  if (row.trials > 0) add(counted(row.trials, "trial"));
  if (!remarks.empty()) console.print("      {}\n", remarks);
  for (const UnreachedError& error : row.unreached) console.note_incomplete("{}", unreached_text(error));
  console.flush();
}

Figures comparison_figures(const std::vector<ComparisonRow>& rows) {
  Figures figures = Figures::array();
  for (const ComparisonRow& row : rows) figures.push_back(row_figures(row));
  return figures;
}

std::string comparison_csv(const std::vector<ComparisonRow>& rows) {
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
  for (const ComparisonRow& row : rows) {
    const Figures figures = row_figures(row);
    for (const char* column : kColumns) {
      const Figures& value = figures[column];
      if (value.is_string()) {
        csv += csv_text(value.get<std::string>());
      } else if (!value.is_null()) {
        csv += value.dump();
      }
      csv += ",";
    }
    const auto volume = row.volume_error;
    csv += (volume ? fmt::format("{}", *volume) : "") + "\n";
  }
  return csv;
}

struct Options {
  InputOptions input;
  CompareOptions comparison;
  std::string picture, csv;
};

void choose_references(const std::string& option, const std::string& text, CompareOptions& options) {
  options.tetgen = options.mesh3 = false;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    bool& chosen = word == "tetgen" ? options.tetgen : options.mesh3;
    if ((word != "tetgen" && word != "mesh3") || chosen)
      wrong_usage("{}: expected tetgen, mesh3 or both with a comma between them, found '{}'", option, text);
    chosen = true;
  }
  if (!(options.tetgen || options.mesh3) || text.ends_with(','))
    wrong_usage("{}: expected tetgen, mesh3 or both with a comma between them, found '{}'", option, text);
}

/// Returns a text that names the files with the rows that were finished before the user stopped the run.
std::string where_kept(const Options& options, const std::string& json) {
  std::string files;
  for (const std::string& file : {options.csv, json}) {
    if (!file.empty()) files += (files.empty() ? "they are in " : " and ") + file;
  }
  return files.empty() ? "--csv and --json keep them" : files;
}

void run(const Options& options, Session& session) {
  Console& console = session.console;
  const CompareOptions& comparison = options.comparison;
  comparison.check();
  find_reference_program("compare");
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.declare("-o", options.picture, {".png", ".svg", ".pdf"});
  session.outputs.declare("--csv", options.csv, {".csv"});
  print_plan(comparison, !options.input.data.labels.empty() && !has_given_interfaces(options.input), console);
  const ResampleOptions& resampling = comparison.resampling;
  const Input input =
      read_input(options.input, {resampling.smooth_labels, resampling.fractions, {}}, console);
  const MeshComparison meshes(input, comparison, console);
  print_comparison_header(console);
  // The files are written again after each row, so that finished rows are kept when a later one fails.
  std::vector<ComparisonRow> rows;
  const auto keep = [&](bool whole) {
    session.outputs.publish(options.csv, [&](const auto& path) { write_text(path, comparison_csv(rows)); });
    session.outputs.publish(session.json, [&](const auto& path) {
      Figures figures{{"finished", whole}, {"meshes", comparison_figures(rows)}};
      add_costs(figures, console);
      write_figures(path, figures);
    });
  };
  const auto finished = [&](const ComparisonRow& row) {
    rows.push_back(row);
    print_comparison_row(row, console);
    keep(false);
  };
  try {
    static_cast<void>(meshes.run(finished, console));
  } catch (const Cancelled&) {
    if (!rows.empty())
      console.note("stopped after {} rows; {}", rows.size(), where_kept(options, session.json));
    throw;
  }
  session.outputs.write(options.picture, [&](const auto& path) {
    write_comparison_picture(path, rows, std::filesystem::path(meshes.name()).stem().string());
  });
  keep(true);
  session.outputs.commit(options.picture);
}

}  // namespace

void add_compare(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "compare", "The mesh beside meshes of other generators at equal interface error",
      "adamas compare cells.vtr --interface-error 2% --interface-error 1% -o comparison.png", run);
  CompareOptions& comparison = options.comparison;
  command.add_file("input", "FILE",
                   "What to mesh: " + grid_files() + ", or a labelled network (.vtp, .ply, .arec, .txt)",
                   options.input.path);
  command.add_values(
      "--interface-error", "E|E%|Evoxels",
      "Greatest distance between the interfaces and their approximation: a length, in % of the "
      "domain's diagonal, or in voxels of the input's grid; repeatable, a group of rows each "
      "(default: 1%)",
      comparison.interface_errors, parse_distance);
  add_other_resampling_options(command, comparison.resampling);
  command.add_converted(
      "--reference", "NAME,NAME",
      std::string("Other generators: tetgen, mesh3 or both") +
          (ADAMAS_WITH_TETGEN ? "" : " (this build is without TetGen)"),
      [&comparison = comparison](const std::string& option, const std::string& text) {
        choose_references(option, text, comparison);
      },
      "tetgen,mesh3");
  command
      .add_option("--tetgen-switches", "SWITCHES", "How TetGen meshes; z and p are needed",
                  comparison.tetgen_switches)
      .show_default();
  command.add_value("--time-limit", "S",
                    "Seconds that one mesh of another generator may take, all trials together",
                    comparison.time_limit, parse_positive, fmt::format("{}", comparison.time_limit));
  command.add_value("--memory-limit", "BYTES", "Address space in bytes that another generator may take",
                    comparison.memory_limit, parse_count_from_0, fmt::format("{}", comparison.memory_limit));
  command.add_option("-o,--output", "FILE",
                     "Tetrahedra and seconds against measured distance: .png, .svg or .pdf", options.picture);
  command.add_option("--csv", "FILE", "The table: .csv", options.csv);
  add_input_options(command, options.input, comparison.resampling.smooth_labels,
                    comparison.resampling.fractions);
}

}  // namespace adamas::cli
