#include "adamas/select.h"

#include <utility>

#include "adamas/mesh_files.h"
#include "adamas/picture.h"
#include "adamas/probe.h"
#include "adamas/report_text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/ledger.h"
#include "cli/mesh_outputs.h"
#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  std::string path;
  SelectOptions selection;
  MeshOutputs outputs;
};

/// Notes the errors that were asked for and that the mesh does not reach.
void note_shortfalls(const SelectReport& report, Console& console) {
  const bool goes_further = !report.certificate && !report.whole_hierarchy && !report.limited;
  if (goes_further && report.interface_error_target &&
      report.interface_error_estimate > *report.interface_error_target)
    console.note(
        "the interface error is not known, since nothing is measured here: it is estimated at {:.4g}",
        report.interface_error_estimate);
  for (const SelectReport::Unreached& error : report.unreached)
    console.note_incomplete("{} was not reached: {} instead of {:.4g}: {}", error.what,
                            length_text(error.found), error.wanted, report.reason);
}

/// Adds the distance of the interfaces: certified, or estimated where the mesh was not measured.
void add_interface_errors(const SelectReport& report, std::vector<std::vector<std::string>>& rows,
                          Figures& figures) {
  figures["interface_error_estimate"] = nullptr;
  for (const char* key : {"interface_error", "interface_error_per_material", "junction_error"}) {
    figures[key] = nullptr;
    figures[key + std::string("_measured")] = nullptr;
  }
  if (!report.certificate) {
    rows.push_back({"interface error estimated", length_text(report.interface_error_estimate)});
    figures["interface_error_estimate"] = report.interface_error_estimate;
    return;
  }
  const auto add = [&](const std::string& name, const std::string& key, const CertifiedDistance& distance) {
    rows.push_back({name + " certified", length_text(distance.certified)});
    rows.push_back({name + " found", length_text(distance.found)});
    figures[key] = distance.certified;
    figures[key + "_measured"] = distance.found;
  };
  add("interface error", "interface_error", report.certificate->interfaces);
  if (report.materials.size() > 2)
    add("interface error per material", "interface_error_per_material", report.certificate->per_material);
  if (report.certificate->junctions) add("junction error", "junction_error", *report.certificate->junctions);
}

void print_fields(const SelectReport& report, Figures& figures, Console& console) {
  if (report.fields.empty()) return;
  std::vector<std::vector<std::string>> rows{
      {"field error", "wanted", "greatest", "mean", "that smaller cells lower"}};
  for (const SelectReport::Field& field : report.fields) {
    rows.push_back({field.unit.empty() ? field.name : field.name + " [" + field.unit + "]",
                    field.target ? fmt::format("{:.4g}", *field.target) : "-",
                    fmt::format("{:.4g}", field.max_error), fmt::format("{:.4g}", field.mean_error),
                    fmt::format("{:.4g}", field.reducible_max_error)});
    Figures& figure = figures["fields"][field.name];
    figure = {{"max_error", field.max_error},
              {"mean_error", field.mean_error},
              {"reducible_max_error", field.reducible_max_error},
              {"elements", field.elements}};
    if (field.target) figure["target"] = *field.target;
  }
  console.print("\n");
  console.table(rows);
}

void print_materials(const SelectReport& report, Figures& figures, Console& console) {
  std::vector<std::vector<std::string>> rows{{"material", "volume in the input", "mesh"}};
  for (const auto& [name, input, found] : report.materials) {
    rows.push_back({name, input ? volume_text(*input) : "-", volume_text(found)});
    figures["materials"].push_back({{"name", name}, {"volume_mesh", found}});
    if (input) figures["materials"].back()["volume_input"] = *input;
  }
  console.print("\n");
  console.table(rows);
}

Figures print_report(const SelectReport& report, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"tetrahedra", std::to_string(report.tetrahedra)},
      {"vertices", std::to_string(report.vertices)},
      {"interface error wanted", report.interface_error_target
                                     ? fmt::format("{:.4g}", *report.interface_error_target)
                                     : std::string("-")}};
  Figures figures{{"input", report.input},
                  {"tetrahedra", report.tetrahedra},
                  {"vertices", report.vertices},
                  {"changed_tetrahedra", report.changed_tetrahedra},
                  {"whole_hierarchy", report.whole_hierarchy},
                  {"fields", Figures::object()},
                  {"materials", Figures::array()}};
  if (report.interface_error_target) figures["interface_error_target"] = *report.interface_error_target;
  add_interface_errors(report, rows, figures);
  console.table(rows);
  print_fields(report, figures, console);
  print_materials(report, figures, console);
  note_shortfalls(report, console);
  return figures;
}

void run(Options& options, Session& session) {
  Console& console = session.console;
  if (!options.outputs.need_mesh() && !options.outputs.need_interfaces() && session.json.empty()) {
    wrong_usage(
        "nothing to write: expected -o, --interfaces-out, --cut-mesh, --ledger, --picture or --json, found "
        "none");
  }
  session.outputs.protect(options.path);
  options.outputs.declare(session.outputs);
  const MultiresolutionMesh hierarchy = read_hierarchy(options.path, console);
  check(options.selection, hierarchy);
  check_shown_interfaces(options.outputs.picture.drawing.shown, hierarchy.materials(), options.path);
  console.step("selecting", -1);
  const SelectedMesh selected = hierarchy.select(options.selection, console);
  const AdaptiveMesh& mesh = selected.mesh;
  options.outputs.colours = find_material_colours({.path = options.path});
  Figures figures = print_report(selected.report, console);
  if (options.outputs.need_interfaces())
    write_interfaces(options.outputs, mesh.interfaces(console), mesh, session);
  std::vector<Ledger> ledgers;
  if (std::vector<MaterialTotals> totals = input_totals(mesh); !totals.empty())
    ledgers.push_back({"input", std::move(totals)});
  if (options.outputs.need_mesh())
    figures["cut_mesh"] = write_meshes(options.outputs, mesh, ledgers, session);
  figures["ledger"] = ledger_figures(ledgers, mesh.fields());
  add_costs(figures, console);
  write_figures(figures, session);
  print_costs(console);
  session.commit();
}

}  // namespace

void add_select(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "select", "A mesh of another error or size, from a hierarchy that resample has saved",
      "adamas select mesh.h5 --interface-error 2% -o coarse.vtu", run);
  command.add_option("input", "FILE", "What adamas resample --save has written: .h5", options.path)
      .required();
  command.add_value("--interface-error", "E|E%|Evoxels",
                    "Greatest distance of the interfaces: a length, in % of the domain's diagonal, or in "
                    "voxels of the input's grid (default: all that was saved)",
                    options.selection.interface_error, parse_distance);
  add_field_error_option(command, options.selection.field_errors);
  command.add_value("--max-tetrahedra", "N", "Stop at this size, whatever the errors",
                    options.selection.max_tetrahedra, parse_count);
  add_mesh_output_options(command, options.outputs);
}

}  // namespace adamas::cli
