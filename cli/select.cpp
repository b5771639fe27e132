#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/mesh_outputs.h"
#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"
#include "core/base/loop_progress.h"
#include "interfaces/selection/selection.h"
#include "workflow/input/saved_hierarchy.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

struct Options {
  std::string path;
  std::optional<ErrorTarget> interface_error;
  FieldErrorTargets field_errors;
  std::optional<std::size_t> max_tetrahedra;
  MeshOutputs outputs;
};

/// The options in the units of the hierarchy.
SelectionTargets targets_of(const Options& options, const SavedHierarchy& hierarchy) {
  const ResampledMesh& tree = hierarchy.tree;
  SelectionTargets targets;
  const InputFacts facts{options.path, tree.box, tree.fields, hierarchy.voxel};
  if (options.interface_error)
    targets.interface_error = interface_error_of("--interface-error", *options.interface_error, facts);
  targets.field_errors = field_errors_of(options.field_errors, facts);
  targets.max_tetrahedra = options.max_tetrahedra;
  return targets;
}

/// Sums of the errors that were measured in the cells of a mesh.
std::vector<FieldError> measured_errors(const Selection& selection) {
  const SavedHierarchy& hierarchy = selection.hierarchy();
  std::vector<FieldError> errors(hierarchy.tree.fields.size());
  for (const std::uint32_t cell : selection.cells()) {
    for (std::size_t f = 0; f < errors.size(); ++f) errors[f].add(hierarchy.measured[f][cell]);
  }
  return errors;
}

/// Notes which of the errors asked for the mesh does not reach.
void note_shortfalls(const Selection& selection, const SelectionTargets& targets, Console& console) {
  const SavedHierarchy& hierarchy = selection.hierarchy();
  const std::string why =
      selection.budget_spent()
          ? fmt::format("the mesh may have no more than {} tetrahedra", *targets.max_tetrahedra)
          : std::string("the hierarchy that was saved goes no further");
  const auto note = [&](const std::string& what, double found, double wanted) {
    if (found <= wanted) return;
    console.note_incomplete("{} was not reached: {} instead of {:.4g}: {}", what, length_text(found), wanted,
                            why);
  };
  if (const auto& wanted = targets.interface_error) {
    const InterfaceCertificate* found = selection.certificate();
    const std::string what = "the interface error wanted";
    const double error = found != nullptr ? found->networks.upper : selection.interface_error();
    const bool goes_further = found == nullptr && !selection.is_whole() && !selection.budget_spent();
    if (goes_further && error > *wanted) {
      console.note(
          "the interface error is not known, since nothing is measured here: it is estimated at {:.4g}",
          error);
    } else {
      note(what, error, *wanted);
    }
    if (found != nullptr && hierarchy.tree.materials.size() > 2)
      note(fmt::format("{} for the boundary of '{}'", what, hierarchy.tree.materials[found->worst_material]),
           found->materials.upper, *wanted);
    if (found != nullptr && found->junctions)
      note(what + " for the lines where three materials meet", found->junctions->upper, *wanted);
  }
  for (std::size_t f = 0; f < targets.field_errors.size(); ++f) {
    if (targets.field_errors[f])
      note(fmt::format("the error wanted of the field '{}'", hierarchy.tree.fields[f].name),
           selection.field_error(f), *targets.field_errors[f]);
  }
}

/// Adds what is known of the interfaces' distance: certified, or estimated where the mesh was not measured.
void add_interface_errors(const Selection& selection, std::vector<std::vector<std::string>>& rows,
                          Figures& figures) {
  figures["interface_error_estimate"] = nullptr;
  for (const char* key : {"interface_error", "interface_error_per_material", "junction_error"}) {
    figures[key] = nullptr;
    figures[key + std::string("_measured")] = nullptr;
  }
  const InterfaceCertificate* certificate = selection.certificate();
  if (certificate == nullptr) {
    rows.push_back({"interface error estimated", length_text(selection.interface_error())});
    figures["interface_error_estimate"] = selection.interface_error();
    return;
  }
  const auto add = [&](const std::string& name, const std::string& key, const InterfaceDistance& distance) {
    rows.push_back({name + " certified", length_text(distance.upper)});
    rows.push_back({name + " found", length_text(distance.lower)});
    figures[key] = distance.upper;
    figures[key + "_measured"] = distance.lower;
  };
  add("interface error", "interface_error", certificate->networks);
  if (selection.hierarchy().tree.materials.size() > 2)
    add("interface error per material", "interface_error_per_material", certificate->materials);
  if (certificate->junctions) add("junction error", "junction_error", *certificate->junctions);
}

Figures report(const Selection& selection, const SelectionTargets& targets, const ResampledMesh& mesh,
               Session& session) {
  const SavedHierarchy& hierarchy = selection.hierarchy();
  Console& console = session.console;
  std::vector<std::vector<std::string>> rows{
      {"tetrahedra", std::to_string(mesh.cells.size())},
      {"vertices", std::to_string(mesh.points.size())},
      {"interface error wanted",
       targets.interface_error ? fmt::format("{:.4g}", *targets.interface_error) : std::string("-")}};
  Figures figures{{"input", hierarchy.tree.source},
                  {"tetrahedra", mesh.cells.size()},
                  {"vertices", mesh.points.size()},
                  {"changed_tetrahedra", selection.changed()},
                  {"whole_hierarchy", selection.is_whole()},
                  {"fields", Figures::object()},
                  {"materials", Figures::array()}};
  if (targets.interface_error) figures["interface_error_target"] = *targets.interface_error;
  add_interface_errors(selection, rows, figures);
  console.table(rows);
  const std::vector<FieldError> errors = measured_errors(selection);
  if (!errors.empty()) {
    rows = {{"field error", "wanted", "greatest", "mean", "that smaller cells lower"}};
    for (std::size_t f = 0; f < errors.size(); ++f) {
      const FieldInfo& info = mesh.fields[f];
      const auto& target = targets.field_errors[f];
      rows.push_back({info.unit.empty() ? info.name : info.name + " [" + info.unit + "]",
                      target ? fmt::format("{:.4g}", *target) : "-", fmt::format("{:.4g}", errors[f].max),
                      fmt::format("{:.4g}", errors[f].mean()), fmt::format("{:.4g}", errors[f].reducible)});
      figures["fields"][info.name] = {{"max_error", errors[f].max},
                                      {"mean_error", errors[f].mean()},
                                      {"reducible_max_error", errors[f].reducible},
                                      {"elements", errors[f].count()}};
      if (target) figures["fields"][info.name]["target"] = *target;
    }
    console.print("\n");
    console.table(rows);
  }
  const auto volumes = material_volumes(mesh.table, mesh.cell_set(), mesh.materials.size());
  rows = {{"material", "volume in the input", "mesh"}};
  for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
    const bool known = !hierarchy.input_volumes.empty();
    rows.push_back(
        {mesh.materials[m], known ? volume_text(hierarchy.input_volumes[m]) : "-", volume_text(volumes[m])});
    figures["materials"].push_back({{"name", mesh.materials[m]}, {"volume_mesh", volumes[m]}});
    if (known) figures["materials"].back()["volume_input"] = hierarchy.input_volumes[m];
  }
  console.print("\n");
  console.table(rows);
  note_shortfalls(selection, targets, console);
  return figures;
}

void run(const Options& options, Session& session) {
  const LoopProgress loops(session.console);
  Console& console = session.console;
  if (!options.outputs.need_mesh() && !options.outputs.need_interfaces() && session.json.empty()) {
    wrong_usage(
        "nothing to write: expected -o, --interfaces-out, --cut-mesh, --ledger, --picture or --json, found "
        "none");
  }
  session.outputs.protect(options.path);
  options.outputs.declare(session.outputs);
  const SavedHierarchy hierarchy = workflow::load_saved_hierarchy(options.path, console);
  const SelectionTargets targets = targets_of(options, hierarchy);
  check_shown_interfaces(options.outputs.picture.drawing.shown, hierarchy.tree.materials, options.path);
  console.step("selecting", -1);
  Selection selection(hierarchy);
  selection.select(targets);
  const ResampledMesh mesh = selection.mesh();
  Figures figures = report(selection, targets, mesh, session);
  if (options.outputs.need_interfaces()) {
    InterfaceMesh interfaces = extract_interfaces(mesh.table, mesh.cell_set(), mesh.box, console).mesh;
    interfaces.materials = mesh.materials;
    interfaces.source = options.path;
    write_interfaces(
        options.outputs, interfaces, mesh.box, [&mesh] { return mesh; }, session);
  }
  std::vector<Ledger> ledgers;
  if (!hierarchy.input_volumes.empty()) ledgers.push_back(volume_ledger("input", hierarchy.input_volumes));
  if (options.outputs.need_mesh()) {
    // As where the mesh is made anew, the error that was wanted says how closely it is cut.
    const double error =
        targets.interface_error.value_or(std::max(selection.interface_error(), hierarchy.interface_target));
    figures["cut_mesh"] = write_mesh(options.outputs, mesh, error, nullptr, ledgers, session);
  }
  figures["ledger"] = ledger_figures(ledgers, mesh.materials, mesh.fields);
  figures["seconds"] = console.seconds();
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_select(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      app, session, "select", "A mesh of another error or size, from a hierarchy that resample has saved",
      "adamas select mesh.h5 --interface-error 2% -o coarse.vtu",
      [options, &session] { run(*options, session); });
  command.add_option("input", options->path, "What adamas resample --save has written: .h5")
      .type_name("FILE")
      .required();
  command
      .add_converted(
          "--interface-error",
          "Greatest distance of the interfaces: a length, in % of the domain's diagonal, or in voxels of "
          "the input's grid (default: all that was saved)",
          [options = options.get()](const std::string& option, const std::string& text) {
            options->interface_error = parse_error_target(option, text, true);
          })
      .type_name("E|E%|Evoxels");
  add_field_error_option(command, options->field_errors);
  command
      .add_converted("--max-tetrahedra", "Stop at this size, whatever the errors",
                     [options = options.get()](const std::string& option, const std::string& text) {
                       options->max_tetrahedra = parse_count(option, text);
                     })
      .type_name("N");
  add_mesh_output_options(command, options->outputs);
}

}  // namespace adamas::cli
