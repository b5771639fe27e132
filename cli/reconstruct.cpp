#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "adamas/notes.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/input_options.h"
#include "cli/network_figures.h"
#include "cli/simplification_options.h"
#include "cli/surface_picture.h"
#include "cli/usage.h"
#include "core/base/loop_progress.h"
#include "core/io/interface_mesh_io.h"
#include "interfaces/library/interface_areas.h"
#include "interfaces/network/network_mesh.h"
#include "interfaces/reconstruction/dispersed.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "workflow/output/picture_block.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

struct Options {
  InputArguments input;
  PictureOptions picture;
  SimplifyOptions simplification;
  std::string output;
};

Figures print_volumes(const MultiMaterialData& data, const Reconstruction& result, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume", "reconstructed", "difference"}};
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    const double input = result.volume_input()[m], found = result.volume_reconstructed()[m];
    rows.push_back(
        {data.materials[m], volume_text(input), volume_text(found), difference_text(input, found)});
    figures.push_back(
        {{"name", data.materials[m]}, {"volume_input", input}, {"volume_reconstructed", found}});
  }
  console.table(rows);
  return figures;
}

/// Prints the volumes that given interfaces enclose, where they are closed; returns a list of materials.
Figures print_enclosed_volumes(const ResamplingSource& source, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  const bool known = !source.volumes.empty();
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value) {
    figures.push_back({{"name", source.materials[m]},
                       {"volume_reconstructed", known ? Figures(source.volumes[m]) : Figures(nullptr)}});
    rows.push_back({source.materials[m], known ? volume_text(source.volumes[m]) : "-"});
  }
  console.table(rows);
  if (!known) console.note("{}: the interfaces are not closed, so that volumes are not known", source.name);
  return figures;
}

/// Prints the interfaces between materials.
Figures print_areas(const std::vector<InterfaceArea>& areas, const IdVector<MaterialId, std::string>& names,
                    bool with_areas, Console& console) {
  return print_interfaces(areas, {names.begin(), names.end()}, with_areas, true, console);
}

/// How well the volumes in the cells agree with the volume fractions there; prints what others get of cells
/// that one material fills.
Figures print_agreement(const VolumeAgreement& agreement, Console& console) {
  if (agreement.full_cells_off > 0) {
    console.print("  others get more than 0.1% of {} of the cells that one material fills, at most {:.2g}%\n",
                  agreement.full_cells_off, 100 * agreement.greatest_in_full_cell);
  }
  return {{"number", agreement.mixed_cells},
          {"off", agreement.cells_off},
          {"greatest_difference", agreement.greatest},
          {"mean_difference", agreement.mean},
          {"full_off", agreement.full_cells_off},
          {"full_greatest_difference", agreement.greatest_in_full_cell}};
}

bool is_one_step_at_most(MaterialId material, const MultiMaterialData& data) {
  if (data.fractions.empty() || data.report.step == 0) return false;
  const SiteArray<float>& fractions = data.fractions[material];
  return std::all_of(fractions.begin(), fractions.end(),
                     [&](float fraction) { return is_one_step(static_cast<double>(fraction), data.report); });
}

/// Notes what the volume fractions contain but the interfaces do not show, but for what is no more than a
/// step of what was stored.
void note_losses(const MultiMaterialData& data, const Reconstruction& result, Figures& figures,
                 Console& console) {
  std::vector<std::pair<double, std::string>> of_materials, of_bodies;
  Figures materials = Figures::array(), bodies = Figures::array();
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    const double volume = result.volume_input()[m];
    if (volume <= 0 || result.volume_reconstructed()[m] > 0 || is_all_dispersed(result.findings(), m, volume))
      continue;
    materials.push_back({{"name", data.materials[m]}, {"volume", volume}});
    if (is_one_step_at_most(m, data)) continue;
    of_materials.emplace_back(
        volume, fmt::format("{}: the interfaces show nothing of '{}', whose volume is {}", data.source,
                            data.materials[m], volume_text(volume)));
  }
  for (const LostBody& body : result.lost_bodies()) {
    const auto& [x, y, z] = body.place;
    bodies.push_back({{"material", data.materials[body.material]},
                      {"volume", body.volume},
                      {"cells", body.cells},
                      {"greatest_fraction", body.fraction},
                      {"place", {x, y, z}}});
    if (is_one_step(body.fraction, data.report)) continue;
    of_bodies.emplace_back(
        body.volume,
        fmt::format("{}: the interfaces show nothing of '{}' round {:.6g},{:.6g},{:.6g}, where {} {}",
                    data.source, data.materials[body.material], x, y, z,
                    body.cells == 1 ? "1 cell holds" : fmt::format("{} cells hold", body.cells),
                    volume_text(body.volume)));
  }
  note_several(worst_first(std::move(of_materials)), {"material", "materials"}, console);
  note_several(worst_first(std::move(of_bodies)), {"place", "places"}, console);
  figures["lost_materials"] = materials;
  figures["lost_bodies"] = bodies;
}

/// The interfaces of an input, and its domain.
struct Interfaces {
  InterfaceMesh mesh;
  Box3 box;
};

/// Simplifies the interfaces where the options ask for it, and tells how large those are that come of it.
Interfaces simplified(Interfaces&& found, const ResamplingSource& source,
                      const SimplifyOptions& simplification, Figures& figures, Console& console) {
  if (!simplification.wanted()) return std::move(found);
  found.mesh = simplify_and_print(source, simplification, figures, console).mesh;
  console.print("\n");
  figures["interfaces"] = print_areas(interface_areas(found.mesh), found.mesh.materials, true, console);
  return std::move(found);
}

Interfaces reconstruct(const Options& options, const SimplifyOptions& simplification, Figures& figures,
                       Console& console) {
  const MultiMaterialData data = load_data(options.input, console);
  const double voxel = data.grid.least_spacing();
  simplification.check({data.source, data.grid.domain(), {}, voxel});
  check_shown_interfaces(options.picture.drawing.shown, data.materials, data.source);
  Reconstruction result(data, reconstruction_options(options.input, data), console);
  figures["materials"] = print_volumes(data, result, console);
  if (data.labels.empty()) {
    print_findings(result.findings(), data.materials, data.source, console);
    figures["fractions"] = finding_figures(result.findings(), data.materials);
  }
  figures["mixed_cells"] = print_agreement(result.agreement(), console);
  note_losses(data, result, figures, console);
  if (!simplification.wanted())
    figures["interfaces"] = print_areas(interface_areas(result.mesh()), data.materials, false, console);
  figures["bodies"] = result.body_materials().size();
  const Box3 box = data.grid.domain();
  if (!simplification.wanted()) return {result.take_mesh(), box};
  ResamplingSource source =
      source_of_interfaces(result.mesh(), box, result.take_bodies(), result.body_materials());
  source.voxel = voxel;
  return simplified({result.take_mesh(), box}, source, simplification, figures, console);
}

/// Loads given interfaces: they are checked and welded, and triangles with the same material on both sides
/// are left out.
Interfaces take_given(const Options& options, const SimplifyOptions& simplification, Figures& figures,
                      Console& console) {
  const workflow::LoadedInput input = load_input(
      options.input, console, [&simplification](const InputFacts& found) { simplification.check(found); });
  const ResamplingSource& source = input.source;
  check_shown_interfaces(options.picture.drawing.shown, source.materials, source.name);
  figures["materials"] = print_enclosed_volumes(source, console);
  if (!simplification.wanted())
    figures["interfaces"] = print_areas(interface_areas(source), source.materials, true, console);
  figures["bodies"] = source.network->table().body_count();
  return simplified({network_mesh(*source.network, source.materials, source.name), source.box}, source,
                    simplification, figures, console);
}

void run(const Options& options, Session& session) {
  const LoopProgress loops(session.console);
  if (options.output.empty() && options.picture.file.empty() && session.json.empty())
    wrong_usage("nothing to write: expected -o, --picture or --json, found none");
  options.simplification.check();
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.declare("-o", options.output, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  session.outputs.declare("--picture", options.picture.file, {".png", ".svg", ".pdf", ".html"});
  options.picture.check();
  Console& console = session.console;
  Figures figures;
  const bool given = has_given_interfaces(options.input);
  if (!given && !options.input.interface_option().empty())
    wrong_usage("{}: expected given interfaces as INPUT", options.input.interface_option());
  const Interfaces found = given ? take_given(options, options.simplification, figures, console)
                                 : reconstruct(options, options.simplification, figures, console);
  figures["triangles"] = found.mesh.triangles.size();
  console.step("writing", -1);
  session.outputs.write(options.output, [&](const auto& path) { write_interface_mesh(path, found.mesh); });
  console.check();
  session.outputs.write(options.picture.file, [&](const auto& path) {
    workflow::write_surface_picture(path, found.mesh, found.box, options.picture.drawing);
  });
  figures["seconds"] = console.seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_reconstruct(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "reconstruct", "Interface meshes from volume fractions, or of a network",
                  "adamas reconstruct cth.vtr --simplify 0.5% -o interfaces.vtp --picture interfaces.png",
                  [options, &session] { run(*options, session); });
  command
      .add_option("input", options->input.path,
                  "What to reconstruct: " + grid_files() +
                      ", or a network to check and write anew (.vtp, .ply, .arec, .txt)")
      .type_name("FILE");
  command
      .add_option(
          "-o,--output", options->output,
          "The interfaces: .vtp, .ply, .obj, .off, .stl or .arec (at least one of this, --picture and "
          "--json)")
      .type_name("FILE");
  add_simplification_options(command, options->simplification, "the interfaces");
  add_surface_picture_options(command, options->picture);
  add_material_options(command, options->input);
  add_raw_options(command, options->input.raw, "--origin,--first-sample", "a raw file");
  add_reconstruction_options(command, options->input);
  add_interface_options(command, options->input);
}

}  // namespace adamas::cli
