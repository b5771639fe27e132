#include "adamas/resample.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "adamas/mesh_files.h"
#include "adamas/picture.h"
#include "adamas/probe.h"
#include "adamas/select.h"
#include "adamas/series.h"
#include "adamas/simplify.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/ledger.h"
#include "cli/mesh_outputs.h"
#include "cli/resample_figures.h"
#include "cli/resample_report.h"
#include "cli/resample_series.h"
#include "cli/resampling_options.h"
#include "cli/simplification_options.h"
#include "cli/usage.h"
#include "cli/verify_by.h"

namespace adamas::cli {

namespace {

struct Options {
  std::vector<std::string> inputs;
  InputArguments input;
  ResampleOptions resampling;
  MeshOutputs outputs;
  SimplifyOptions simplify;
  std::string save, verifier;
  std::vector<std::string> curves;
  FilmOptions film;
};

/// Returns the interfaces of the mesh, simplified, and prints the report about that.
InterfaceTriangles simplified_interfaces(const AdaptiveMesh& mesh, const SimplifyOptions& options,
                                         Figures& figures, Console& console) {
  SimplifiedInterfaces found = simplify(mesh, options, console);
  print_simplification(found.report, console);
  figures["simplification"] = simplification_figures(found.report);
  console.note(
      "the simplified interfaces are within {:.4g} of those of the mesh, and so within the interface error "
      "and "
      "that of the input's",
      found.report.distances.interfaces.certified);
  return std::move(found.mesh);
}

/// Verifies the interface error and writes interfaces, as far as that is asked for.
void finish_interfaces(const Options& options, const AdaptiveMesh& mesh, Figures& figures, Session& session) {
  Console& console = session.console;
  const bool written = options.outputs.need_interfaces(), simpler = options.simplify.error.has_value();
  InterfaceTriangles shown;
  if (!options.verifier.empty() || (written && !simpler)) shown = mesh.interfaces(console);
  if (!options.verifier.empty()) verify_interface_error(mesh, shown, figures, console);
  if (!written) return;
  if (simpler) {
    shown = {};
    shown = simplified_interfaces(mesh, options.simplify, figures, console);
  }
  write_interfaces(options.outputs, shown, mesh, session);
}

/// Writes the hierarchy and the meshes that are asked for; returns the ledgers of the input and of all meshes
/// that were written.
std::vector<Ledger> write_outputs(const Options& options, const AdaptiveMesh& mesh, Figures& figures,
                                  Session& session) {
  Console& console = session.console;
  session.outputs.write(options.save, [&](const auto& path) {
    console.step("measuring all cells of the hierarchy", -1);
    const MultiresolutionMesh hierarchy = multiresolution_mesh(mesh, console);
    console.step("writing " + options.save, -1);
    write_hierarchy(path, hierarchy);
  });
  std::vector<Ledger> ledgers;
  if (std::vector<MaterialTotals> totals = input_totals(mesh); !totals.empty())
    ledgers.push_back({"input", std::move(totals)});
  if (!options.outputs.need_mesh()) return ledgers;
  console.step("completing fields", -1);
  figures["cut_mesh"] = write_meshes(options.outputs, mesh, ledgers, session);
  return ledgers;
}

/// Returns the given option that only a single data set can have; empty where there is none.
std::string single_option(const Options& options) {
  if (!options.outputs.interfaces.empty()) return "--interfaces-out";
  if (!options.outputs.cut.file.empty()) return "--cut-mesh";
  if (!options.outputs.ledger.empty()) return "--ledger";
  if (!options.outputs.picture.file.empty()) return "--picture";
  if (!options.save.empty()) return "--save";
  if (!options.verifier.empty()) return "--verify-by";
  return options.input.interfaces.empty() ? options.input.interface_option() : "--interface";
}

/// Returns the given option that only a series can have; empty where there is none.
std::string series_option(const Options& options) {
  if (!options.curves.empty()) return "--curves";
  if (!options.film.file.empty()) return "--film";
  if (!options.film.frame_rate.empty()) return "--frame-rate";
  if (!options.film.plane.empty()) return "--plane";
  return options.film.show.empty() ? "" : "--show";
}

void run_series(const Options& options, const std::vector<SeriesEntry>& steps, Session& session) {
  if (const std::string option = single_option(options); !option.empty())
    wrong_usage("{}: expected one data set, found a series of {}", option, steps.size());
  if (options.outputs.mesh.empty() && options.curves.empty() && options.film.file.empty() &&
      session.json.empty())
    wrong_usage("nothing to write: expected -o, --curves, --film or --json, found none");
  if (options.film.file.empty() && !(options.film.plane.empty() && options.film.show.empty()))
    wrong_usage("--{}: expected --film as well", options.film.plane.empty() ? "show" : "plane");
  protect_inputs(options.input, options.inputs.front(), session.outputs);
  resample_series(options.input, steps, options.resampling,
                  {options.inputs.front(), options.outputs.mesh, options.curves, options.film}, session);
}

/// Reads the input, checks the options that depend on it, and resamples.
AdaptiveMesh resample_input(const Options& options, Console& console) {
  Input input = read_input(options.input, console);
  ResampleOptions resampling = options.resampling;
  resampling.smooth_labels = options.input.smooth_labels;
  resampling.fractions = fraction_options(options.input);
  check(resampling, input);
  check(options.simplify, input);
  check_fraction_options(options.input, input, input.name());
  check_shown_interfaces(options.outputs.picture.drawing.shown, input.materials(), input.source());
  return resample(std::move(input), resampling, console);
}

void run(Options& options, Session& session) {
  const std::vector<SeriesEntry> steps = series_steps(options.inputs);
  if (!steps.empty()) return run_series(options, steps, session);
  if (const std::string option = series_option(options); !option.empty())
    wrong_usage("{}: expected a series (a .pvd or several files)", option);
  if (!options.inputs.empty()) options.input.path = options.inputs.front();
  Console& console = session.console;
  check_simplification(options.simplify);
  if (options.simplify.error && !options.outputs.need_interfaces())
    wrong_usage("--simplify: expected --interfaces-out or --picture beside it, found none");
  if (!options.outputs.need_mesh() && !options.outputs.need_interfaces() && options.save.empty() &&
      session.json.empty()) {
    wrong_usage(
        "nothing to write: expected -o, --interfaces-out, --cut-mesh, --ledger, --picture, --save or --json, "
        "found none");
  }
  check_verifier(options.verifier);
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  options.outputs.declare(session.outputs);
  session.outputs.declare("--save", options.save, {".h5"});
  const AdaptiveMesh mesh = resample_input(options, console);
  print_resampled(mesh.report(), console);
  Figures figures = resample_json(mesh.report());
  finish_interfaces(options, mesh, figures, session);
  const std::vector<Ledger> ledgers = write_outputs(options, mesh, figures, session);
  figures["ledger"] = ledger_figures(ledgers, mesh.fields());
  figures["seconds"] = console.seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  console.print("\n  {:.2f} s, {} of memory at most\n", console.seconds(),
                bytes_text(static_cast<double>(peak_memory_bytes())));
  session.commit();
}

}  // namespace

void add_resample(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "resample", "An adaptive tetrahedral mesh with sharp material interfaces",
                  "adamas resample cth.vtr --interface-error 0.5% --field-error Pressure=5% -o mesh.vtu\n"
                  "  adamas resample run.pvd --interface-error 1% -o meshes.pvd --curves curves.png",
                  [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->inputs,
          "What to resample: " + grid_files() +
              ", or a labelled network (.vtp, .ply, .arec, .txt). Or a series of data on one grid: a .pvd, "
              "several files, or a pattern of their names in quotes, as \"run_%04d.vti\"")
      .type_name("FILE...");
  add_resampling_options(command, options->resampling);
  add_mesh_output_options(command, options->outputs, true);
  command
      .add_option("--curves", options->curves,
                  "Of a series: errors, volumes and masses over time, as figures (.csv) or curves (.png, "
                  ".svg, .pdf); "
                  "repeatable")
      .type_name("FILE")
      .one_value_each();
  add_film_options(command, options->film);
  command.add_option("--plane", options->film.plane, "The plane of the film")
      .type_name("x=N|y=N|z=N")
      .group("Film");
  command
      .add_option("--show", options->film.show,
                  "The field that the film shows, or NAME:x for a component; without it, the materials")
      .type_name("NAME")
      .group("Film");
  add_simplification_options(
      command, options->simplify,
      "the approximated interfaces that --interfaces-out and --picture show, on top of the interface error");
  command
      .add_option("--save", options->save,
                  "The hierarchy, from which adamas select takes meshes of other errors: .h5")
      .type_name("FILE");
  command
      .add_option(
          "--verify-by", options->verifier,
          "Have the interface error measured by another program as well, adamas-reference, which uses "
          "CGAL's AABB trees")
      .one_of({"cgal"});
  add_material_options(command, options->input);
  add_raw_options(command, options->input.raw, "--origin,--first-sample", "a raw file");
  add_reconstruction_options(command, options->input);
  add_interface_options(command, options->input);
}

}  // namespace adamas::cli
