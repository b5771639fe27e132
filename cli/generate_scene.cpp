#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_writer.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"

namespace adamas {

namespace {

struct Options {
  std::string name, dimensions, seed, box, interfaces, resolution, output;
};

std::uint64_t parse_seed(const std::string& text) {
  return text.empty() ? 0 : parse_count("--seed", text, 0);
}

/// The size of triangles where none is given: that of the grid's cells, or 1/64 of the shortest side.
double interface_resolution(const Options& options, const Box3& box) {
  if (!options.resolution.empty()) return parse_positive("--resolution", options.resolution);
  const Vec3 size = box.size();
  if (options.dimensions.empty()) return std::min({size.x, size.y, size.z}) / 64;
  const auto cells = parse_dimensions("--dimensions", options.dimensions);
  return std::min({size.x / static_cast<double>(cells[0]), size.y / static_cast<double>(cells[1]),
                   size.z / static_cast<double>(cells[2])});
}

void print_volumes(const Scene& scene, const SceneIntegral* sampled, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  if (sampled != nullptr) rows[0].insert(rows[0].end(), {"on the grid", "integration error"});
  figures["materials"] = Figures::array();
  for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
    Figures figure{
        {"name", scene.materials()[m]}, {"volume", scene.volume(m)}, {"volume_error", scene.volume_error(m)}};
    rows.push_back({scene.materials()[m], volume_text(scene.volume(m))});
    if (sampled != nullptr) {
      figure["volume_sampled"] = sampled->volumes[m];
      figure["integration_error"] = sampled->errors[m];
      rows.back().insert(rows.back().end(),
                         {volume_text(sampled->volumes[m]), fmt::format("{:.2g}", sampled->errors[m])});
    }
    figures["materials"].push_back(std::move(figure));
  }
  console.table(rows);
}

void write_grid(const Scene& scene, const Options& options, Session& session, Figures& figures) {
  const auto cells = parse_dimensions("--dimensions", options.dimensions);
  SceneIntegral integral;
  const MultiMaterialData data = sample_scene(scene, cells, {}, session.console, &integral);
  session.console.step("writing " + options.output, -1);
  session.outputs.write(options.output, [&data](const auto& path) { write_multi_material_data(path, data); });
  figures["dimensions"] = cells;
  figures["bytes"] = session.outputs.bytes(options.output);
  session.console.print("Scene {} on {} x {} x {} cells, {}\n", scene.name(), cells[0], cells[1], cells[2],
                        bytes_text(static_cast<double>(session.outputs.bytes(options.output))));
  print_volumes(scene, &integral, session.console, figures);
}

void run(const Options& options, Session& session) {
  if (options.output.empty() && options.interfaces.empty()) {
    wrong_usage("expected -o or --interfaces, found neither");
  }
  if (!options.resolution.empty() && options.interfaces.empty()) {
    wrong_usage("--resolution: expected --interfaces as well");
  }
  if (!options.output.empty() && options.dimensions.empty()) {
    wrong_usage("-o: expected --dimensions X,Y,Z as well");
  }
  SceneOptions where;
  if (!options.box.empty()) where.box = to_box(parse_bounds("--box", options.box));
  const Scene scene = make_scene(options.name, parse_seed(options.seed), where);
  const double resolution = interface_resolution(options, scene.box());
  session.outputs.declare("-o", options.output, {".vtr", ".vti"});
  session.outputs.declare("--interfaces", options.interfaces,
                          {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  Figures figures{{"dimensions", nullptr}, {"bytes", nullptr}, {"scene", scene.name()}};
  figures["seed"] = parse_seed(options.seed);
  figures["box"] = box_figures(scene.box());
  if (options.output.empty()) {
    session.console.print("Scene {}\n", scene.name());
    print_volumes(scene, nullptr, session.console, figures);
  } else {
    write_grid(scene, options, session, figures);
  }
  if (!options.interfaces.empty()) {
    const InterfaceMesh mesh = scene_interfaces(scene, resolution, session.console);
    session.outputs.write(options.interfaces,
                          [&mesh](const auto& path) { write_interface_mesh(path, mesh); });
    session.console.print("Interfaces: {} triangles\n", mesh.triangles.size());
    figures["triangles"] = mesh.triangles.size();
  }
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

}  // namespace

void add_generate_scene(const Command& generate, Session& session) {
  const std::string example = "adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr";
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(generate, session, "scene", "Analytic materials with known volumes, and fields", example,
                  [options, &session] { run(*options, session); });
  command.add_option("name", options->name, "The scene").required().type_name("NAME").one_of(scene_names());
  command.add_option("--dimensions", options->dimensions, "Numbers of cells").type_name("X,Y,Z");
  command.add_option("--seed", options->seed, "Which of the scenes of a kind (voronoi10, random)")
      .type_name("N");
  command.add_option("--box", options->box, "Where the scene lies (default: the unit cube)")
      .type_name("x0,x1,y0,y1,z0,z1");
  command
      .add_option("--interfaces", options->interfaces,
                  "Write the true interfaces too (.vtp, .ply, .obj, .off, .stl, .arec)")
      .type_name("FILE");
  command
      .add_option("--resolution", options->resolution,
                  "Size of their triangles on curved interfaces (default: a cell)")
      .type_name("H");
  command.add_option("-o,--output", options->output, "The data: .vtr or .vti").type_name("FILE");
}

}  // namespace adamas
