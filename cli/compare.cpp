#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.h"
#include "cli/compare_report.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/reference_program.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"
#include "core/io/output_stream.h"
#include "interfaces/library/resample_options.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

/// With less address space the other program could not even load its libraries.
constexpr std::size_t kLeastMemory = std::size_t{64} << 20;

struct Options {
  InputArguments input;
  ResampleOptions resampling;
  std::vector<ErrorTarget> interface_errors;
  std::string references = "tetgen,mesh3", time_limit = "300", memory_limit = "8589934592";
  std::string tetgen_switches = ComparisonOptions().tetgen_switches;
  std::string picture, csv;
};

/// The options for each interface error, in the order in which these are given.
std::vector<ResampleOptions> all_runs(const Options& options) {
  std::vector<ResampleOptions> result;
  for (const ErrorTarget& error : options.interface_errors) {
    result.push_back(options.resampling);
    result.back().interface_error = error;
  }
  if (result.empty()) result.push_back(options.resampling);
  return result;
}

void choose_references(const std::string& text, ComparisonOptions& options) {
  options.tetgen = options.mesh3 = false;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    bool& chosen = word == "tetgen" ? options.tetgen : options.mesh3;
    if ((word != "tetgen" && word != "mesh3") || chosen)
      wrong_usage("--reference: expected tetgen, mesh3 or both with a comma between them, found '{}'", text);
    chosen = true;
  }
  if (!(options.tetgen || options.mesh3) || text.ends_with(','))
    wrong_usage("--reference: expected tetgen, mesh3 or both with a comma between them, found '{}'", text);
}

/// TetGen's output can only be read with the switches z and p, and some other switches make it write files.
void check_switches(const std::string& switches) {
  constexpr const char* kKnown = "zpYqaMTXOCDSbVQ0123456789./e-";
  if (switches.find('z') == std::string::npos || switches.find('p') == std::string::npos ||
      switches.find_first_not_of(kKnown) != std::string::npos || switches.size() > 100)
    wrong_usage("--tetgen-switches: expected z, p and others of {}, found '{}'", kKnown, switches);
}

ComparisonOptions comparison_options(const Options& options) {
  ComparisonOptions result;
  choose_references(options.references, result);
  result.mesher.limits.seconds = parse_positive("--time-limit", options.time_limit);
  result.mesher.limits.memory_bytes = parse_count("--memory-limit", options.memory_limit, kLeastMemory);
  check_switches(options.tetgen_switches);
  result.tetgen_switches = options.tetgen_switches;
  return result;
}

/// The coordinates along an axis at which one label ends and the next begins: the nodes, where cells have the
/// labels; the middles between nodes, where the nodes have them.
std::vector<double> walls_of(const RectilinearGrid& grid, int axis) {
  const auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
  if (grid.centering == Centering::kCells) return nodes;
  std::vector<double> walls{nodes.front()};
  for (std::size_t i = 1; i < nodes.size(); ++i) walls.push_back(0.5 * (nodes[i - 1] + nodes[i]));
  walls.push_back(nodes.back());
  return walls;
}

/// The labels of an input; empty where it has fractions or interfaces instead of labels.
std::optional<LabelImage> label_image(const workflow::LoadedInput& input) {
  if (!input.data || input.data->labels.empty()) return std::nullopt;
  const MultiMaterialData& data = *input.data;
  return LabelImage{walls_of(data.grid, 0),
                    walls_of(data.grid, 1),
                    walls_of(data.grid, 2),
                    {data.labels.begin(), data.labels.end()}};
}

/// Says in which files the rows are that were finished before the user stopped the run.
std::string where_kept(const Options& options, const std::string& json) {
  std::string files;
  for (const std::string& file : {options.csv, json}) {
    if (!file.empty()) files += (files.empty() ? "they are in " : " and ") + file;
  }
  return files.empty() ? "--csv and --json keep them" : files;
}

void run(const Options& options, Session& session) {
  Console& console = session.console;
  const std::vector<ResampleOptions> runs = all_runs(options);
  ComparisonOptions comparison = comparison_options(options);
  comparison.mesher.program = find_reference_program("compare");
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.declare("-o", options.picture, {".png", ".svg", ".pdf"});
  session.outputs.declare("--csv", options.csv, {".csv"});
  comparison.interface_errors.resize(runs.size());
  if (!options.input.labels.empty() && !has_given_interfaces(options.input)) comparison.image.emplace();
  print_plan(comparison, console);
  const workflow::LoadedInput input = load_input(options.input, console, [&runs](const InputFacts& found) {
    for (const ResampleOptions& run : runs) check_options(run, found);
  });
  comparison.image = has_given_interfaces(options.input) ? std::nullopt : label_image(input);
  comparison.resampling = to_resampling_options(runs.front(), input.source);
  for (std::size_t i = 0; i < runs.size(); ++i)
    comparison.interface_errors[i] = to_resampling_options(runs[i], input.source).interface_error;
  print_comparison_header(console);
  // The files are written again after each row, so that finished rows are kept when a later one fails.
  std::vector<ComparedMesh> rows;
  const auto keep = [&](bool whole) {
    session.outputs.publish(options.csv, [&](const auto& path) {
      OutputStream stream(path);
      stream.write(comparison_csv(rows, input.source));
      stream.finish();
    });
    session.outputs.publish(session.json, [&](const auto& path) {
      write_figures(path, {{"finished", whole},
                           {"meshes", comparison_figures(rows, input.source)},
                           {"seconds", console.seconds()}});
    });
  };
  comparison.finished = [&](const ComparedMesh& row) {
    rows.push_back(row);
    print_comparison_row(row, input.source, console);
    keep(false);
  };
  try {
    compare_meshes(input.source, comparison, console);
  } catch (const Cancelled&) {
    if (!rows.empty())
      console.note("stopped after {} rows; {}", rows.size(), where_kept(options, session.json));
    throw;
  }
  session.outputs.write(options.picture, [&](const auto& path) {
    write_comparison_picture(path, rows, std::filesystem::path(input.source.name).stem().string());
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
            options->interface_errors.push_back(parse_error_target(option, text, true));
          })
      .type_name("E|E%|Evoxels");
  add_other_resampling_options(command, options->resampling);
  command
      .add_option("--reference", options->references,
                  std::string("Other generators: tetgen, mesh3 or both") +
                      (ADAMAS_WITH_TETGEN ? "" : " (this build is without TetGen)"))
      .type_name("NAME,NAME")
      .show_default();
  command.add_option("--tetgen-switches", options->tetgen_switches, "How TetGen meshes; z and p are needed")
      .type_name("SWITCHES")
      .show_default();
  command
      .add_option("--time-limit", options->time_limit,
                  "Seconds that one mesh of another generator may take, all trials together")
      .type_name("S")
      .show_default();
  command
      .add_option("--memory-limit", options->memory_limit,
                  "Address space in bytes that another generator may take")
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
