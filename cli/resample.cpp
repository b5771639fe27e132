#include "adamas/resample.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/mesh_files.h"
#include "adamas/picture.h"
#include "adamas/probe.h"
#include "adamas/report_text.h"
#include "adamas/resample_series.h"
#include "adamas/select.h"
#include "adamas/series.h"
#include "adamas/simplify.h"
#include "adamas/steps.h"
#include "adamas/text.h"
#include "adamas/verify.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/input_options.h"
#include "cli/ledger.h"
#include "cli/memory_limit.h"
#include "cli/mesh_outputs.h"
#include "cli/option_values.h"
#include "cli/resample_figures.h"
#include "cli/resampling_options.h"
#include "cli/series_figures.h"
#include "cli/series_options.h"
#include "cli/side_set_options.h"
#include "cli/simplification_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  std::vector<std::string> inputs;
  InputOptions input;
  std::optional<std::size_t> memory;
  ResampleOptions resampling;
  MeshOutputs outputs;
  SimplifyOptions simplify;
  std::string save, side_sets, verifier;
  std::vector<std::string> curves;
  SeriesFilmOptions film;
};

/// Names the body whose volume is farthest off: of many bodies none may be lost, and each far too small.
void print_worst_body(const ResampleReport& report, Console& console) {
  if (!report.worst_volume) return;
  const ResampleReport::Body& body = report.bodies[*report.worst_volume];
  const double whole = *body.volume_input;
  console.print("  worst body volume: {:.4g}% of {}, a body of '{}' at {}\n",
                whole > 0 ? 100 * body.volume_mesh / whole : 0.0, volume_text(whole),
                report.materials[body.material].name, place_text(body.place));
}

/// Tells how many bodies have their volumes in the input.
std::string conserved_text(const ResampleReport& report) {
  const auto count = std::ranges::count_if(report.bodies, [&report](const ResampleReport::Body& body) {
    return body.volume_input && report.is_conserved(body);
  });
  return fmt::format("{} of {}", count, report.bodies.size());
}

void print_mesh(const ResampleReport& report, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"tetrahedra", std::to_string(report.tetrahedra)},
      {"vertices", std::to_string(report.vertices)},
      {"interface tetrahedra", std::to_string(report.interface_tetrahedra)},
      {"interface error wanted", fmt::format("{:.4g}", report.interface_error_target)}};
  const auto add_distance = [&](const std::string& name, const std::optional<MeasuredDistance>& d) {
    if (!d) return;
    rows.push_back({name + " certified", length_text(d->certified)});
    rows.push_back({name + " found", length_text(d->found)});
  };
  add_distance("interface error", report.interface_error);
  // With two materials the boundary of each consists of all interfaces.
  if (report.materials.size() > 2)
    add_distance("interface error per material", report.interface_error_per_material);
  add_distance("junction error", report.junction_error);
  if (report.volume_error_target)
    rows.push_back(
        {"volume error of bodies wanted", fmt::format("{:.4g}%", 100 * *report.volume_error_target)});
  if (report.worst_volume)
    rows.push_back({"greatest volume error of a body",
                    fmt::format("{:.4g}%", 100 * report.bodies[*report.worst_volume].volume_error())});
  if (report.conservation_tolerance)
    rows.push_back({"bodies that have their volumes", conserved_text(report)});
  rows.push_back({"lost interfaces", std::to_string(report.lost_interfaces)});
  const auto count = [&](bool ResampleReport::Body::*what) {
    return std::to_string(std::ranges::count_if(report.bodies, what));
  };
  rows.push_back({"bodies, lost, torn", std::to_string(report.bodies.size()) + ", " +
                                            count(&ResampleReport::Body::lost) + ", " +
                                            count(&ResampleReport::Body::changed)});
  rows.push_back({"contacts the input has not", std::to_string(report.contacts.size())});
  if (report.flagged_vertices > 0)
    rows.push_back({"vertices of doubtful material", std::to_string(report.flagged_vertices)});
  console.table(rows);
  print_worst_body(report, console);
}

/// Prints over how many elements of each kind the errors are taken; once where that is the same for all
/// fields.
void print_elements(const ResampleReport& report, Console& console) {
  std::vector<std::string> texts;
  for (const ResampleReport::Field& field : report.fields)
    texts.push_back(fmt::format("{} pure, {} mixed, {} minority; {} of them displaced; {} without a value",
                                field.pure, field.mixed, field.minority, field.displaced,
                                field.without_value));
  if (std::ranges::all_of(texts, [&](const std::string& text) { return text == texts[0]; })) {
    console.print("  elements: {}\n", texts[0]);
    return;
  }
  for (std::size_t f = 0; f < texts.size(); ++f)
    console.print("  elements of {}: {}\n", report.fields[f].name, texts[f]);
}

void print_fields(const ResampleReport& report, Console& console) {
  if (report.fields.empty()) return;
  const auto text = [](double value) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.4g}", value);
  };
  std::vector<std::vector<std::string>> rows{
      {"field error", "wanted", "greatest", "mean", "at interfaces", "mean there"}};
  for (const ResampleReport::Field& field : report.fields)
    rows.push_back({field.unit.empty() ? field.name : field.name + " [" + field.unit + "]",
                    field.target ? fmt::format("{:.4g}", *field.target) : "-",
                    text(field.everywhere.max_error), text(field.everywhere.mean_error),
                    text(field.at_interfaces.max_error), text(field.at_interfaces.mean_error)});
  console.print("\n");
  console.table(rows);
  print_elements(report, console);
}

void print_materials(const ResampleReport& report, Console& console) {
  constexpr std::size_t kMost = 40;
  const bool stated = !report.materials.empty() && report.materials.front().volume_input;
  std::vector<std::vector<std::string>> rows{{"material", "volume", "mesh", "difference"}};
  if (!stated) rows[0] = {"material", "volume in the mesh"};
  for (std::size_t m = 0; m < std::min(report.materials.size(), kMost); ++m) {
    const auto& [name, volume_input, found, lost] = report.materials[m];
    if (stated) {
      rows.push_back(
          {name, volume_text(*volume_input), volume_text(found), difference_text(*volume_input, found)});
    } else {
      rows.push_back({name, volume_text(found)});
    }
  }
  console.print("\n");
  console.table(rows);
  if (report.materials.size() > kMost) console.print("  ... and {} more\n", report.materials.size() - kMost);
}

/// Prints what a run of the resampler came to, and notes what it did not reach.
void print_resampled(const ResampleReport& report, Console& console) {
  if (report.fractions) print_findings(*report.fractions, material_names(report), report.input, console);
  print_mesh(report, console);
  print_fields(report, console);
  print_materials(report, console);
  note_resampled(report, console);
}

/// Throws Error, before the work, where this build or installation is without the program that verifies.
void check_verifier(const std::string& name) {
  if (!name.empty()) find_reference_program("--verify-by");
}

/// Measures the distance between the input's interfaces and those that the mesh shows by CGAL, prints it
/// beside the certified one, and adds it to the figures (`interface_error_by_cgal`). Notes a contradiction,
/// which makes the result incomplete.
void verify_interface_error(const AdaptiveMesh& mesh, const InterfaceTriangles& shown, Figures& figures,
                            Console& console) {
  const ResampleReport& report = mesh.report();
  VerifyOptions options;
  options.domain = mesh.domain();
  const CgalVerdict verdict = verify_by_cgal(
      mesh.input_interfaces(), shown, kVerifyPrecision * report.interface_error_target, options, console);
  figures["interface_error_by_cgal"] = {{"lower", verdict.lower},
                                        {"upper", verdict.upper},
                                        {"seconds", verdict.seconds},
                                        {"processor_seconds", verdict.processor_seconds}};
  if (!report.interface_error) return console.print("\n  interface error by CGAL: {}\n", verdict.text());
  const MeasuredDistance& ours = *report.interface_error;
  console.print("\n  interface error {} (certified), CGAL: {}\n", length_text(ours.certified),
                verdict.text());
  if (const auto contradiction = verdict.contradiction(ours.found, ours.certified))
    console.note_incomplete("{}", *contradiction);
}

/// The interfaces of the mesh, simplified, and what is told of that.
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
    write_hierarchy(path, hierarchy, options.outputs.colours);
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
  if (!options.side_sets.empty()) return "--side-sets";
  if (!options.verifier.empty()) return "--verify-by";
  if (options.input.data.time) return "--time";
  return options.input.surfaces.empty() ? options.input.interface_option() : "--interface";
}

/// Returns the given option that only a series can have; empty where there is none.
std::string series_option(const Options& options) {
  if (!options.curves.empty()) return "--curves";
  if (!options.film.file.empty()) return "--film";
  if (options.film.frames_per_second) return "--frame-rate";
  if (options.film.plane) return "--plane";
  return options.film.field.empty() ? "" : "--show";
}

/// Resamples the steps of a series, each from the mesh of the one before, and tells what comes of it.
void run_series(const Options& options, const std::vector<SeriesEntry>& steps, Session& session) {
  if (const std::string option = single_option(options); !option.empty())
    wrong_usage("{}: expected one data set, found a series of {}", option, steps.size());
  if (options.outputs.mesh.empty() && options.curves.empty() && options.film.file.empty() &&
      session.json.empty())
    wrong_usage("nothing to write: expected -o, --curves, --film or --json, found none");
  Console& console = session.console;
  const std::filesystem::path name = options.inputs.front();
  protect_inputs(options.input, name, session.outputs);
  for (const std::string& file : options.curves)
    session.outputs.declare("--curves", file, {".csv", ".png", ".svg", ".pdf"});
  const ResampledSeries series = resample_series(steps,
                                                 {.input = options.input,
                                                  .resampling = options.resampling,
                                                  .name = name.filename().string(),
                                                  .meshes = options.outputs.mesh,
                                                  .film = options.film},
                                                 session.outputs, console);
  print_series(series, console);
  for (const std::string& file : options.curves)
    session.outputs.write(file, [&series](const auto& path) { write_series_curves(path, series); });
  Figures figures{{"steps", series_figures(series)}, {"damaged_steps", damaged_steps(series.left_out)}};
  add_costs(figures, console);
  write_figures(figures, session);
  print_costs(console, counted(series.steps.size(), "step"));
  session.commit();
  note_left_out(series.left_out, console);
}

/// Reads the input, checks the options that depend on it, and resamples.
AdaptiveMesh resample_input(const Options& options, Session& session) {
  Console& console = session.console;
  const ResampleOptions& resampling = options.resampling;
  Input input = read_input(options.input, {resampling.smooth_labels, resampling.fractions, {}}, console);
  check(resampling, input);
  check(options.simplify, input);
  check_shown_interfaces(options.outputs.picture.drawing.shown, input.materials(), input.source());
  write_side_sets(options.side_sets, input, session);
  return resample(std::move(input), resampling, console);
}

void run(Options& options, Session& session) {
  options.input.memory = begin_memory_limit(options.memory, session);
  if (options.input.stack && options.inputs.size() > 1)
    wrong_usage("--stack: expected one pattern in quotes, found {} inputs", options.inputs.size());
  std::vector<SeriesEntry> steps;
  if (!options.input.stack) steps = series_steps(options.inputs);
  // A file of cells with several times is a series where one is asked for.
  const bool as_series = !series_option(options).empty() || file_extension(options.outputs.mesh) == ".pvd";
  if (steps.empty() && as_series && options.inputs.size() == 1 && !options.input.stack &&
      !options.input.data.time)
    steps = mesh_steps(options.inputs.front());
  if (!steps.empty()) return run_series(options, steps, session);
  if (as_series && options.inputs.size() == 1 && input_kind(options.inputs.front()) == InputKind::kCells)
    fail("{}: expected several times for a series, found one", options.inputs.front());
  if (const std::string option = series_option(options); !option.empty())
    wrong_usage("{}: expected a series (a .pvd, several files, or a file of cells with several times)",
                option);
  if (!options.inputs.empty()) options.input.path = options.inputs.front();
  Console& console = session.console;
  check_simplification(options.simplify);
  if (options.simplify.error && !options.outputs.need_interfaces())
    wrong_usage("--simplify: expected --interfaces-out or --picture beside it, found none");
  if (!options.outputs.need_mesh() && !options.outputs.need_interfaces() && options.save.empty() &&
      options.side_sets.empty() && session.json.empty()) {
    wrong_usage(
        "nothing to write: expected -o, --interfaces-out, --cut-mesh, --ledger, --picture, --save, "
        "--side-sets or --json, found none");
  }
  check_verifier(options.verifier);
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  options.outputs.declare(session.outputs);
  session.outputs.declare("--save", options.save, {".h5"});
  declare_side_sets(options.side_sets, session);
  const AdaptiveMesh mesh = resample_input(options, session);
  if (options.outputs.need_mesh() || options.outputs.need_interfaces() || !options.save.empty())
    options.outputs.colours = find_material_colours(options.input);
  print_resampled(mesh.report(), console);
  Figures figures = resample_json(mesh.report());
  finish_interfaces(options, mesh, figures, session);
  const std::vector<Ledger> ledgers = write_outputs(options, mesh, figures, session);
  figures["ledger"] = ledger_figures(ledgers, mesh.fields());
  add_costs(figures, console);
  write_figures(figures, session);
  print_costs(console);
  session.commit();
}

}  // namespace

void add_resample(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "resample", "An adaptive tetrahedral mesh with sharp material interfaces",
                  "adamas resample cth.vtr --interface-error 0.5% --field-error Pressure=5% -o mesh.vtu\n"
                  "  adamas resample run.pvd --interface-error 1% -o meshes.pvd --curves curves.png",
                  run);
  command.add_option(
      "input", "FILE...",
      "What to resample: " + grid_files() + ", " + mesh_files() +
          ", or a labelled network (.vtp, .ply, .arec, .txt). Or a series of data on one grid: a .pvd, "
          "several files, or a pattern of their names in quotes, as \"run_%04d.vti\"",
      options.inputs);
  add_resampling_options(command, options.resampling);
  add_mesh_output_options(command, options.outputs, true);
  command
      .add_option("--curves", "FILE",
                  "Of a series: errors, volumes and masses over time, as figures (.csv) or curves (.png, "
                  ".svg, .pdf); repeatable",
                  options.curves)
      .one_value_each();
  add_film_options(command, options.film.file, options.film.frames_per_second);
  const Command film = command.in_group("Film");
  film.add_value("--plane", "x=N|y=N|z=N", "The plane of the film", options.film.plane, parse_plane_option);
  film.add_option("--show", "NAME",
                  "The field that the film shows, or NAME:x for a component; without it, the materials",
                  options.film.field);
  add_simplification_options(
      command, options.simplify,
      "the approximated interfaces that --interfaces-out and --picture show, on top of the interface error");
  command.add_option("--save", "FILE",
                     "The hierarchy, from which adamas select takes meshes of other errors: .h5",
                     options.save);
  add_side_sets_option(command, options.side_sets);
  command
      .add_option(
          "--verify-by", {},
          "Have the interface error measured by another program as well, adamas-reference, which uses "
          "CGAL's Polygon Mesh Processing",
          options.verifier)
      .one_of({"cgal"});
  add_memory_limit(command, options.memory);
  add_input_options(command, options.input, options.resampling.smooth_labels, options.resampling.fractions);
}

}  // namespace adamas::cli
