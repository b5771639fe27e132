#include "adamas/reconstruct.h"

#include <utility>

#include "adamas/files.h"
#include "adamas/material_colours.h"
#include "adamas/notes.h"
#include "adamas/picture.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/fraction_report.h"
#include "cli/input_options.h"
#include "cli/interface_figures.h"
#include "cli/memory_limit.h"
#include "cli/picture_options.h"
#include "cli/side_set_options.h"
#include "cli/simplification_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  InputOptions input;
  std::optional<std::size_t> memory;
  ReconstructOptions reconstruction;
  PictureOptions picture;
  std::string output, side_sets;
};

Figures print_volumes(const ReconstructedInterfaces& result, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume", "reconstructed", "difference"}};
  for (const auto& [name, input, found] : result.materials) {
    rows.push_back({name, volume_text(*input), volume_text(*found), difference_text(*input, *found)});
    figures.push_back({{"name", name}, {"volume_input", *input}, {"volume_reconstructed", *found}});
  }
  console.table(rows);
  return figures;
}

/// How well the volumes in the cells agree with the volume fractions there; prints what others get of cells
/// that one material fills.
Figures print_agreement(const CellAgreement& agreement, Console& console) {
  if (agreement.full_cells_off > 0) {
    console.print("  others get more than 0.1% of {} of the cells that one material fills, at most {:.2g}%\n",
                  agreement.full_cells_off, 100 * agreement.greatest_in_full_cell);
  }
  return {{"number", agreement.mixed_cells},
          {"off", agreement.cells_off},
          {"greatest_difference", agreement.greatest_difference},
          {"mean_difference", agreement.mean_difference},
          {"full_off", agreement.full_cells_off},
          {"full_greatest_difference", agreement.greatest_in_full_cell}};
}

/// Notes the materials and places of the volume fractions that the interfaces do not show, except those that
/// are no more than a step of the stored numbers.
void note_losses(const ReconstructedInterfaces& result, Figures& figures, Console& console) {
  std::vector<std::pair<double, std::string>> of_materials, of_places;
  Figures materials = Figures::array(), bodies = Figures::array();
  for (const LostMaterial& lost : result.lost_materials) {
    const std::string& name = result.materials[lost.material].name;
    materials.push_back({{"name", name}, {"volume", lost.volume}});
    if (lost.within_one_step) continue;
    of_materials.emplace_back(
        lost.volume, fmt::format("{}: the interfaces show nothing of '{}', whose volume is {}", result.input,
                                 name, volume_text(lost.volume)));
  }
  for (const LostPlace& lost : result.lost_places) {
    const std::string& name = result.materials[lost.material].name;
    const Vec3& place = lost.place;
    bodies.push_back({{"material", name},
                      {"volume", lost.volume},
                      {"cells", lost.cells},
                      {"greatest_fraction", lost.greatest_fraction},
                      {"place", place_figures(place)}});
    if (lost.within_one_step) continue;
    of_places.emplace_back(
        lost.volume,
        fmt::format("{}: the interfaces show nothing of '{}' round {:.6g},{:.6g},{:.6g}, where {} {}",
                    result.input, name, place.x, place.y, place.z,
                    lost.cells == 1 ? "1 cell holds" : fmt::format("{} cells hold", lost.cells),
                    volume_text(lost.volume)));
  }
  note_several(worst_first(std::move(of_materials)), {"material", "materials"}, console);
  note_several(worst_first(std::move(of_places)), {"place", "places"}, console);
  figures["lost_materials"] = materials;
  figures["lost_bodies"] = bodies;
}

/// Prints the result. `given`: interfaces were given, and not reconstructed.
Figures print_result(const ReconstructedInterfaces& result, bool given, Console& console) {
  const std::vector<std::string>& materials = result.mesh.materials;
  Figures figures;
  if (given) {
    EnclosedVolumes volumes;
    for (const auto& [name, input, found] : result.materials) volumes.emplace_back(name, found);
    figures["materials"] =
        print_enclosed_volumes(volumes, "volume_reconstructed", result.input, true, console);
  } else {
    figures["materials"] = print_volumes(result, console);
    if (result.fractions) {
      print_findings(*result.fractions, materials, result.input, console);
      figures["fractions"] = finding_figures(*result.fractions, materials);
    }
    figures["mixed_cells"] = print_agreement(*result.agreement, console);
    note_losses(result, figures, console);
  }
  if (!result.simplification)
    figures["interfaces"] = print_interfaces(result.interfaces, materials, given, true, console);
  figures["bodies"] = result.bodies;
  if (!result.simplification) return figures;
  print_simplification(*result.simplification, console);
  figures["simplification"] = simplification_figures(*result.simplification);
  console.print("\n");
  figures["interfaces"] = print_interfaces(result.interfaces, materials, true, true, console);
  return figures;
}

ReconstructedInterfaces reconstruct_input(const Options& options, bool given, Session& session) {
  Console& console = session.console;
  Input input =
      read_input(given ? options.input : needed_main_file(options.input), options.reconstruction, console);
  check(options.reconstruction.simplify, input);
  check_shown_interfaces(options.picture.drawing.shown, input.materials(), input.source());
  write_side_sets(options.side_sets, input, session);
  return adamas::reconstruct(std::move(input), options.reconstruction, console);
}

void run(Options& options, Session& session) {
  options.input.memory = begin_memory_limit(options.memory, session);
  if (options.output.empty() && options.side_sets.empty() && options.picture.file.empty() &&
      session.json.empty())
    wrong_usage("nothing to write: expected -o, --side-sets, --picture or --json, found none");
  check_simplification(options.reconstruction.simplify);
  protect_inputs(options.input, with_main_file(options.input).path, session.outputs);
  session.outputs.declare("-o", options.output, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  declare_side_sets(options.side_sets, session);
  session.outputs.declare("--picture", options.picture.file, {".png", ".svg", ".pdf", ".html"});
  options.picture.check();
  Console& console = session.console;
  const bool given = has_given_interfaces(options.input);
  if (!given && !options.input.interface_option().empty())
    wrong_usage("{}: expected given interfaces as INPUT", options.input.interface_option());
  const ReconstructedInterfaces result = reconstruct_input(options, given, session);
  Figures figures = print_result(result, given, console);
  figures["triangles"] = result.mesh.triangles.size();
  console.step("writing", -1);
  MaterialColours colours;
  if (!options.output.empty() || !options.picture.file.empty())
    colours = find_material_colours(options.input);
  session.outputs.write(options.output, [&](const auto& path) { write_mesh(path, result.mesh, colours); });
  console.check();
  session.outputs.write(options.picture.file, [&](const auto& path) {
    DrawingOptions drawing = options.picture.drawing;
    drawing.domain = result.domain;
    drawing.colours = colours;
    write_picture(path, result.mesh, drawing);
  });
  add_costs(figures, console);
  write_figures(figures, session);
  print_costs(console);
  session.commit();
}

}  // namespace

void add_reconstruct(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "reconstruct", "Interface meshes from volume fractions, or of a network",
      "adamas reconstruct cth.vtr --simplify 0.5% -o interfaces.vtp --picture interfaces.png", run);
  command.add_file("input", "FILE",
                   "What to reconstruct: " + grid_files() + ", " + mesh_files() +
                       ", or a network to check and write anew (.vtp, .ply, .arec, .txt)",
                   options.input.path);
  command.add_option(
      "-o,--output", "FILE",
      "The interfaces: .vtp, .ply, .obj, .off, .stl or .arec (at least one of this, --picture, "
      "--side-sets and --json)",
      options.output);
  add_side_sets_option(command, options.side_sets);
  ReconstructOptions& reconstruction = options.reconstruction;
  add_simplification_options(command, reconstruction.simplify, "the interfaces");
  add_surface_picture_options(command, options.picture);
  add_memory_limit(command, options.memory);
  add_input_options(command, options.input, reconstruction.smooth_labels, reconstruction.fractions);
}

}  // namespace adamas::cli
