#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/surface_picture.h"
#include "cli/usage_error.h"
#include "core/io/interface_mesh_io.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

namespace {

struct Options {
  InputOptions input;
  std::string output, picture;
};

Figures print_materials(const MultiMaterialData& data, const Reconstruction& result, Console& console) {
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

Figures print_interfaces(const InterfaceMesh& mesh, Console& console) {
  std::map<std::pair<MaterialId, MaterialId>, std::size_t> counts;
  for (const InterfaceTriangle& t : mesh.triangles) ++counts[std::minmax(t.front, t.back)];
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"interface", "triangles"}};
  for (const auto& [pair, count] : counts) {
    const std::string &a = mesh.materials[pair.first], &b = mesh.materials[pair.second];
    if (rows.size() <= 40) rows.push_back({a + " | " + b, std::to_string(count)});
    figures.push_back({{"materials", {a, b}}, {"triangles", count}});
  }
  console.table(rows);
  if (counts.size() > 40) console.print("  ... and {} more\n", counts.size() - 40);
  return figures;
}

void run(const Options& options, Session& session) {
  protect_inputs(options.input, options.input.path, session.outputs);
  session.outputs.declare("-o", options.output, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  session.outputs.declare("--picture", options.picture, {".png", ".svg", ".pdf"});
  Console& console = session.console;
  const MultiMaterialData data = load_data(options.input, console);
  const Reconstruction result(data, console);
  Figures figures;
  figures["materials"] = print_materials(data, result, console);
  figures["interfaces"] = print_interfaces(result.mesh(), console);
  figures["triangles"] = result.mesh().triangles.size();
  figures["bodies"] = result.body_materials().size();
  console.step("writing", -1);
  session.outputs.write(options.output, [&](const auto& path) { write_interface_mesh(path, result.mesh()); });
  console.check();
  session.outputs.write(options.picture, [&](const auto& path) {
    write_surface_picture(path, result.mesh(), data.grid.domain());
  });
  figures["seconds"] = console.seconds();
  figures["peak_memory_bytes"] = peak_memory_bytes();
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

}  // namespace

void add_reconstruct(CLI::App& app, Session& session) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = add_command(app, session, "reconstruct", "Interface meshes from volume fractions",
                                  "adamas reconstruct cth.vtr -o interfaces.vtp --picture interfaces.png",
                                  [options, &session] { run(*options, session); });
  command->add_option("input", options->input.path, std::string("What to reconstruct: ") + kGridFiles)
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", options->output, "The interfaces: .vtp, .ply, .obj, .off, .stl or .arec")
      ->required()
      ->type_name("FILE");
  command->add_option("--picture", options->picture, "A picture of them: .png, .svg or .pdf")
      ->type_name("FILE");
  add_material_options(*command, options->input);
}

}  // namespace adamas
