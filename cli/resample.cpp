#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/mesh_outputs.h"
#include "cli/resample_figures.h"
#include "cli/resampling_options.h"
#include "cli/simplification_options.h"
#include "cli/usage_error.h"
#include "core/io/array_file.h"
#include "interfaces/resampling/output.h"
#include "interfaces/resampling/shortfall.h"
#include "interfaces/selection/saved_hierarchy_file.h"

namespace adamas {

namespace {

/// The text of a distance between interfaces, which is infinite where the mesh shows none.
std::string shown_length(double length) {
  return std::isinf(length) ? "none shown" : fmt::format("{:.4g}", length);
}

struct Options {
  InputOptions input;
  ResamplingText text;
  MeshOutputs outputs;
  SimplificationText simplification;
  std::string save;
};

/// Notes which of the distances are greater than the interface error, and why.
void note_shortfalls(const InterfaceCertificate& certificate, const Resampler& resampler, Console& console) {
  const auto note = [&](const std::string& what, const InterfaceDistance& distance) {
    const auto shortfall = interface_shortfall(resampler, distance);
    if (!shortfall) return false;
    console.note("{} was not reached: {} instead of {:.4g}, at {}: {}", what, shown_length(distance.upper),
                 resampler.options().interface_error, place_text(shortfall->place), shortfall->reason);
    return true;
  };
  if (!note("the interface error wanted", certificate.networks))
    note(fmt::format("the interface error wanted for the boundary of '{}'",
                     resampler.source().materials[certificate.worst_material]),
         certificate.materials);
  if (certificate.junctions)
    note("the interface error wanted for the lines where three materials meet", *certificate.junctions);
}

/// Notes the materials and bodies of the input that the mesh shows changed or not at all.
void note_bodies(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  constexpr std::size_t kMost = 10;
  for (const MaterialId material : lost_materials(m, source)) {
    const bool known = !source.volumes.empty();
    console.note("the mesh shows nothing of the material '{}'{}", source.materials[material],
                 known ? fmt::format(" of volume {}", volume_text(source.volumes[material])) : "");
  }
  std::size_t noted = 0;
  for (const BodyFigures& body : m.bodies) {
    if (!body.lost && !body.changed) continue;
    if (++noted > kMost) continue;
    const std::string volume =
        body.volume_input ? fmt::format(" of volume {}", volume_text(*body.volume_input)) : "";
    const std::string what = fmt::format("a body of '{}'{} at {}", source.materials[body.material], volume,
                                         place_text(body.place));
    if (body.lost) {
      console.note("the mesh shows nothing of {}", what);
    } else {
      console.note(
          "the mesh shows {} in {} piece{}, and its boundary has the Euler characteristic {} instead of {}",
          what, body.topology_mesh.pieces, body.topology_mesh.pieces == 1 ? "" : "s",
          body.topology_mesh.euler, body.topology_input.euler);
    }
  }
  if (noted > kMost) console.note("... and {} more bodies that are lost or torn", noted - kMost);
  if (m.contacts.empty()) return;
  std::string pairs;
  for (std::size_t i = 0; i < std::min(m.contacts.size(), kMost); ++i) {
    const auto& [a, b] = m.contacts[i];
    pairs += fmt::format("{}'{}' and '{}'", i == 0 ? "" : ", ", source.materials[m.bodies[a.value].material],
                         source.materials[m.bodies[b.value].material]);
  }
  console.note("{} pairs of bodies touch in the mesh and not in the input: {}{}", m.contacts.size(), pairs,
               m.contacts.size() > kMost ? ", ..." : "");
}

void print_mesh(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  const double target = resampler.options().interface_error;
  std::vector<std::vector<std::string>> rows{{"tetrahedra", std::to_string(m.tetrahedra)},
                                             {"vertices", std::to_string(m.vertices)},
                                             {"interface tetrahedra", std::to_string(m.interface_tetrahedra)},
                                             {"interface error wanted", fmt::format("{:.4g}", target)}};
  const auto& certificate = resampler.certificate();
  const auto add_distance = [&](const std::string& name, const InterfaceDistance& d) {
    rows.push_back({name + " certified", shown_length(d.upper)});
    rows.push_back({name + " found", shown_length(d.lower)});
  };
  if (certificate) {
    add_distance("interface error", certificate->networks);
    // With two materials the boundary of each consists of all interfaces.
    if (resampler.source().materials.size() > 2)
      add_distance("interface error per material", certificate->materials);
    if (certificate->junctions) add_distance("junction error", *certificate->junctions);
  }
  rows.push_back({"lost interfaces", std::to_string(m.lost_interfaces)});
  const auto count = [&](bool BodyFigures::*what) {
    return std::to_string(
        std::count_if(m.bodies.begin(), m.bodies.end(), [what](const auto& b) { return b.*what; }));
  };
  rows.push_back({"bodies, lost, torn", std::to_string(m.bodies.size()) + ", " + count(&BodyFigures::lost) +
                                            ", " + count(&BodyFigures::changed)});
  rows.push_back({"contacts the input has not", std::to_string(m.contacts.size())});
  if (m.flagged_vertices > 0)
    rows.push_back({"vertices of doubtful material", std::to_string(m.flagged_vertices)});
  console.table(rows);
  if (certificate) note_shortfalls(*certificate, resampler, console);
  note_bodies(m, resampler.source(), console);
}

/// Prints over how many elements of each kind the errors are taken; once where that is the same for all
/// fields.
void print_elements(const ResampleFigures& m, const FieldSource& source, Console& console) {
  std::vector<std::string> texts;
  for (const FieldFigures& field : m.fields) {
    const FieldError& e = field.all;
    texts.push_back(fmt::format("{} pure, {} mixed, {} minority; {} of them displaced; {} without a value",
                                e.counts[0], e.counts[1], e.counts[2], e.displaced, e.without_value));
  }
  if (std::all_of(texts.begin(), texts.end(), [&](const std::string& text) { return text == texts[0]; })) {
    console.print("  elements: {}\n", texts[0]);
    return;
  }
  for (std::size_t f = 0; f < texts.size(); ++f)
    console.print("  elements of {}: {}\n", source.fields()[f].name, texts[f]);
}

void print_fields(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  if (m.fields.empty()) return;
  const auto text = [](const FieldError& e, double value) {
    return e.count() > 0 ? fmt::format("{:.4g}", value) : std::string("-");
  };
  std::vector<std::vector<std::string>> rows{
      {"field error", "wanted", "greatest", "mean", "at interfaces", "mean there"}};
  for (std::size_t f = 0; f < m.fields.size(); ++f) {
    const FieldInfo& info = resampler.source().fields->fields()[f];
    const auto& target = resampler.options().field_errors[f];
    const auto& [all, near] = m.fields[f];
    rows.push_back({info.unit.empty() ? info.name : info.name + " [" + info.unit + "]",
                    target ? fmt::format("{:.4g}", *target) : "-", text(all, all.max), text(all, all.mean()),
                    text(near, near.max), text(near, near.mean())});
  }
  console.print("\n");
  console.table(rows);
  print_elements(m, *resampler.source().fields, console);
  for (std::size_t f = 0; f < m.fields.size(); ++f) {
    const FieldError& all = m.fields[f].all;
    const auto shortfall = field_shortfall(resampler, f, all);
    if (!shortfall) continue;
    console.note("the error wanted of the field '{}' was not reached: {:.4g} instead of {:.4g}, at {}: {}",
                 resampler.source().fields->fields()[f].name, all.max, *resampler.options().field_errors[f],
                 place_text(shortfall->place), shortfall->reason);
  }
}

/// Prints whether volumes are conserved, where the options ask for it.
void print_conservation(const ResampleFigures& m, const Resampler& resampler, Console& console) {
  if (!resampler.options().conserve) return;
  const BodyFigures* worst = nullptr;
  for (const BodyFigures& body : m.bodies) {
    if (body.volume_input && (worst == nullptr || body.missing() > worst->missing())) worst = &body;
  }
  const double whole = resampler.source().box.volume();
  if (worst == nullptr || worst->missing() <= kConserved * whole) return;
  console.note(
      "volumes were not conserved: a body of '{}' at {} has {} instead of {}; interfaces may "
      "not move by more than the interface error",
      resampler.source().materials[worst->material], place_text(worst->place), volume_text(worst->volume),
      volume_text(*worst->volume_input));
}

void print_materials(const ResampleFigures& m, const ResamplingSource& source, Console& console) {
  constexpr std::size_t kMost = 40;
  const bool stated = !source.volumes.empty();
  std::vector<std::vector<std::string>> rows{{"material", "volume", "mesh", "difference"}};
  if (!stated) rows[0] = {"material", "volume in the mesh"};
  for (MaterialId i(0); i.value < std::min(source.materials.size(), kMost); ++i.value) {
    const std::string& name = source.materials[i];
    const double found = m.volumes[i];
    if (stated) {
      rows.push_back({name, volume_text(source.volumes[i]), volume_text(found),
                      difference_text(source.volumes[i], found)});
    } else {
      rows.push_back({name, volume_text(found)});
    }
  }
  console.print("\n");
  console.table(rows);
  if (source.materials.size() > kMost) console.print("  ... and {} more\n", source.materials.size() - kMost);
}

/// The interfaces of the mesh, simplified where the options ask for it.
InterfaceMesh shown_interfaces(const Resampler& resampler, const SimplificationRequest& request,
                               Figures& figures, Console& console) {
  if (!request.wanted()) return approximated_interfaces(resampler, console);
  const ResamplingSource shown = source_of_approximated_interfaces(resampler, console);
  SimplifiedInterfaces found = simplify_and_print(shown, request, figures, console);
  console.note(
      "the simplified interfaces are within {:.4g} of those of the mesh, and so within the interface error "
      "and "
      "that of the input's",
      found.certificate.networks.upper);
  return std::move(found.mesh);
}

/// Writes what is asked for; returns the ledgers of the input and of all meshes that were written.
std::vector<Ledger> write_outputs(const Options& options, const Input& input, Resampler& resampler,
                                  const SimplificationRequest& request, Figures& figures, Session& session) {
  Console& console = session.console;
  if (options.outputs.need_interfaces())
    write_interfaces(
        options.outputs, shown_interfaces(resampler, request, figures, console), resampler.source().box,
        [&resampler] { return resampled_mesh(resampler); }, session);
  session.outputs.write(options.save, [&](const auto& path) {
    console.step("measuring all cells of the hierarchy", -1);
    const SavedHierarchy hierarchy = take_hierarchy(resampler);
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

void run(const Options& options, Session& session) {
  Console& console = session.console;
  const ResamplingRequest request(options.text);
  const SimplificationRequest simplification(options.simplification);
  if (simplification.wanted() && !options.outputs.need_interfaces())
    wrong_usage("--simplify: expected --interfaces-out or --picture beside it, found none");
  if (!options.outputs.need_mesh() && !options.outputs.need_interfaces() && options.save.empty() &&
      session.json.empty()) {
    wrong_usage(
        "nothing to write: expected -o, --interfaces-out, --cut-mesh, --ledger, --picture, --save or --json, "
        "found none");
  }
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  options.outputs.declare(session.outputs);
  session.outputs.declare("--save", options.save, {".h5"});
  const Input input = load_input(options.input, console, [&](const InputFacts& found) {
    request.check(found);
    simplification.check(found);
  });
  options.outputs.picture.check_materials(input.source.materials, input.source.name);
  Resampler resampler(input.source, request.options(input.source), console);
  resampler.refine();
  console.step("measuring", -1);
  const ResampleFigures measured = measure(resampler, console);
  print_mesh(measured, resampler, console);
  print_fields(measured, resampler, console);
  print_materials(measured, input.source, console);
  print_conservation(measured, resampler, console);
  Figures figures = resample_json(measured, resampler);
  const std::vector<Ledger> ledgers =
      write_outputs(options, input, resampler, simplification, figures, session);
  figures["ledger"] =
      ledger_figures(ledgers, input.source.materials,
                     input.source.fields ? input.source.fields->fields() : std::vector<FieldInfo>());
  figures["seconds"] = console.seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
  console.print("\n  {:.2f} s, {} of memory at most\n", console.seconds(),
                bytes_text(static_cast<double>(peak_memory_bytes())));
}

}  // namespace

void add_resample(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "resample", "An adaptive tetrahedral mesh with sharp material interfaces",
                  "adamas resample cth.vtr --interface-error 0.5% --field-error Pressure=5% -o mesh.vtu",
                  [options, &session] { run(*options, session); });
  command
      .add_option("input", options->input.path,
                  "What to resample: " + grid_files() + ", or a labelled network (.vtp, .ply, .arec, .txt)")
      .type_name("FILE");
  add_resampling_options(command, options->text);
  add_mesh_output_options(command, options->outputs);
  add_simplification_options(
      command, options->simplification,
      "the approximated interfaces that --interfaces-out and --picture show, on top of the interface error");
  command
      .add_option("--save", options->save,
                  "The hierarchy, from which adamas select takes meshes of other errors: .h5")
      .type_name("FILE");
  add_material_options(command, options->input);
  add_smoothing_option(command, options->input);
  add_interface_options(command, options->input);
}

}  // namespace adamas
