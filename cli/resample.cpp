#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/series.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/mesh_outputs.h"
#include "cli/resample_figures.h"
#include "cli/resample_report.h"
#include "cli/resample_series.h"
#include "cli/resampling_options.h"
#include "cli/simplification_options.h"
#include "cli/usage.h"
#include "cli/verification.h"
#include "core/base/loop_progress.h"
#include "core/io/array_file.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/selection/saved_hierarchy_file.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

struct Options {
  std::vector<std::string> inputs;
  InputArguments input;
  ResampleOptions resampling;
  MeshOutputs outputs;
  SimplifyOptions simplification;
  std::string save, verifier;
  std::vector<std::string> curves;
  FilmOptions film;
};

/// The interfaces of the mesh, simplified where the options ask for it.
InterfaceMesh shown_interfaces(const Resampler& resampler, const SimplifyOptions& simplification,
                               Figures& figures, Console& console) {
  if (!simplification.wanted()) return approximated_interfaces(resampler, console);
  const ResamplingSource shown = source_of_approximated_interfaces(resampler, console);
  SimplifiedInterfaces found = simplify_and_print(shown, simplification, figures, console);
  console.note(
      "the simplified interfaces are within {:.4g} of those of the mesh, and so within the interface error "
      "and "
      "that of the input's",
      found.certificate.networks.upper);
  return std::move(found.mesh);
}

/// Writes what is asked for; returns the ledgers of the input and of all meshes that were written.
std::vector<Ledger> write_outputs(const Options& options, const workflow::LoadedInput& input,
                                  Resampler& resampler, const SimplifyOptions& simplification,
                                  Figures& figures, Session& session) {
  Console& console = session.console;
  if (options.outputs.need_interfaces())
    write_interfaces(
        options.outputs, shown_interfaces(resampler, simplification, figures, console),
        resampler.source().box, [&resampler] { return resampled_mesh(resampler); }, session);
  session.outputs.write(options.save, [&](const auto& path) {
    console.step("measuring all cells of the hierarchy", -1);
    const SavedHierarchy hierarchy = take_hierarchy(resampler, console);
    console.step("writing " + options.save, -1);
    write_array_file(path, {kHierarchyFormat, kHierarchyVersion, to_arrays(hierarchy)});
  });
  std::vector<Ledger> ledgers;
  // Where interfaces are given, the grid needs no materials.
  if (input.data && !(input.data->fractions.empty() && input.data->labels.empty())) {
    ledgers.push_back({"input", material_integrals(*input.data)});
  } else if (!input.source.volumes.empty()) {
    ledgers.push_back(volume_ledger("input", input.source.volumes));
  }
  if (!options.outputs.need_mesh()) return ledgers;
  console.step("completing fields", -1);
  figures["cut_mesh"] =
      write_mesh(options.outputs, resampled_mesh(resampler), resampler.options().interface_error,
                 &resampler.source(), ledgers, session);
  return ledgers;
}

/// The option given that is about one data set alone; empty where there is none.
std::string single_option(const Options& options) {
  if (!options.outputs.interfaces.empty()) return "--interfaces-out";
  if (!options.outputs.cut.file.empty()) return "--cut-mesh";
  if (!options.outputs.ledger.empty()) return "--ledger";
  if (!options.outputs.picture.file.empty()) return "--picture";
  if (!options.save.empty()) return "--save";
  if (!options.verifier.empty()) return "--verify-by";
  return options.input.interfaces.empty() ? options.input.interface_option() : "--interface";
}

/// The option given that is about a series alone; empty where there is none.
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

void run(Options& options, Session& session) {
  const LoopProgress loops(session.console);
  const std::vector<SeriesEntry> steps = series_steps(options.inputs);
  if (!steps.empty()) return run_series(options, steps, session);
  if (const std::string option = series_option(options); !option.empty())
    wrong_usage("{}: expected a series (a .pvd or several files)", option);
  if (!options.inputs.empty()) options.input.path = options.inputs.front();
  Console& console = session.console;
  const SimplifyOptions& simplification = options.simplification;
  simplification.check();
  if (simplification.wanted() && !options.outputs.need_interfaces())
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
  const workflow::LoadedInput input = load_input(options.input, console, [&](const InputFacts& found) {
    check_options(options.resampling, found);
    simplification.check(found);
  });
  check_shown_interfaces(options.outputs.picture.drawing.shown, input.source.materials, input.source.name);
  Resampler resampler(input.source, to_resampling_options(options.resampling, input.source), console);
  resampler.refine();
  console.step("measuring", -1);
  const ResampleReport report = report_of(resampler, console);
  print_resampled(report, console);
  Figures figures = resample_json(report);
  verify_interface_error(options.verifier, resampler, figures, console);
  const std::vector<Ledger> ledgers =
      write_outputs(options, input, resampler, simplification, figures, session);
  figures["ledger"] =
      ledger_figures(ledgers, input.source.materials,
                     input.source.fields ? input.source.fields->fields() : std::vector<FieldInfo>());
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
      command, options->simplification,
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
