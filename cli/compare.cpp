#include "adamas/compare.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "adamas/files.h"
#include "adamas/verify.h"
#include "cli/command.h"
#include "cli/compare_report.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  InputArguments input;
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
  CompareOptions comparison = options.comparison;
  comparison.check();
  find_reference_program("compare");
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.declare("-o", options.picture, {".png", ".svg", ".pdf"});
  session.outputs.declare("--csv", options.csv, {".csv"});
  print_plan(comparison, !options.input.labels.empty() && !has_given_interfaces(options.input), console);
  comparison.resampling.smooth_labels = options.input.smooth_labels;
  comparison.resampling.fractions = fraction_options(options.input);
  const Input input = read_input(options.input, console);
  check_fraction_options(options.input, input, input.name());
  const MeshComparison meshes(input, comparison, console);
  print_comparison_header(console);
  // The files are written again after each row, so that finished rows are kept when a later one fails.
  std::vector<ComparisonRow> rows;
  const auto keep = [&](bool whole) {
    session.outputs.publish(options.csv, [&](const auto& path) { write_text(path, comparison_csv(rows)); });
    session.outputs.publish(session.json, [&](const auto& path) {
      write_figures(
          path, {{"finished", whole}, {"meshes", comparison_figures(rows)}, {"seconds", console.seconds()}});
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
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      app, session, "compare", "The mesh beside meshes of other generators at equal interface error",
      "adamas compare cells.vtr --interface-error 2% --interface-error 1% -o comparison.png",
      [options, &session] { run(*options, session); });
  command
      .add_option("input", options->input.path,
                  "What to mesh: " + grid_files() + ", or a labelled network (.vtp, .ply, .arec, .txt)")
      .type_name("FILE");
  command
      .add_converted_each(
          "--interface-error",
          "Greatest distance between the interfaces and their approximation: a length, in % of the "
          "domain's diagonal, or in voxels of the input's grid; repeatable, a group of rows each "
          "(default: 1%)",
          [options = options.get()](const std::string& option, const std::string& text) {
            options->comparison.interface_errors.push_back(parse_error_target(option, text, true));
          })
      .type_name("E|E%|Evoxels");
  add_other_resampling_options(command, options->comparison.resampling);
  CompareOptions& comparison = options->comparison;
  command
      .add_converted(
          "--reference",
          std::string("Other generators: tetgen, mesh3 or both") +
              (ADAMAS_WITH_TETGEN ? "" : " (this build is without TetGen)"),
          [&comparison](const std::string& option, const std::string& text) {
            choose_references(option, text, comparison);
          },
          "tetgen,mesh3")
      .type_name("NAME,NAME")
      .show_default();
  command.add_option("--tetgen-switches", comparison.tetgen_switches, "How TetGen meshes; z and p are needed")
      .type_name("SWITCHES")
      .show_default();
  command
      .add_converted(
          "--time-limit", "Seconds that one mesh of another generator may take, all trials together",
          [&comparison](const std::string& option, const std::string& text) {
            comparison.time_limit = parse_positive(option, text);
          },
          fmt::format("{}", comparison.time_limit))
      .type_name("S")
      .show_default();
  command
      .add_converted(
          "--memory-limit", "Address space in bytes that another generator may take",
          [&comparison](const std::string& option, const std::string& text) {
            comparison.memory_limit = parse_count(option, text, kLeastMesherMemory);
          },
          fmt::format("{}", comparison.memory_limit))
      .type_name("BYTES")
      .show_default();
  command
      .add_option("-o,--output", options->picture,
                  "Tetrahedra and seconds against measured distance: .png, .svg or .pdf")
      .type_name("FILE");
  command.add_option("--csv", options->csv, "The table: .csv").type_name("FILE");
  add_material_options(command, options->input);
  add_raw_options(command, options->input.raw, "--origin,--first-sample", "a raw file");
  add_reconstruction_options(command, options->input);
  add_interface_options(command, options->input);
}

}  // namespace adamas::cli
