#include "adamas/probe.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/files.h"
#include "adamas/mesh_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/interface_figures.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  InputArguments input;
  std::string points, line, output;
  std::vector<std::string> single;
};

/// Parses a line of points, "x,y,z..x,y,z,n".
std::vector<Vec3> parse_line(const std::string& text) {
  const std::size_t dots = text.find("..");
  const std::size_t comma = text.rfind(',');
  if (dots == std::string::npos ||
      std::count(text.begin() + static_cast<std::ptrdiff_t>(dots), text.end(), ',') != 3) {
    wrong_usage("--line: expected x,y,z..x,y,z,n with the number of points at the end, found '{}'", text);
  }
  const std::size_t count = parse_count("--line", text.substr(comma + 1));
  if (count < 2 || count > 100'000'000) {
    wrong_usage("--line: expected 2 to 100000000 points, found {}", count);
  }
  return line_points(parse_vector("--line", text.substr(0, dots)),
                     parse_vector("--line", text.substr(dots + 2, comma - dots - 2)), count);
}

std::vector<Vec3> wanted_points(const Options& options) {
  std::vector<Vec3> points;
  for (const std::string& text : options.single) points.push_back(parse_vector("--point", text));
  if (!options.line.empty()) {
    const auto line = parse_line(options.line);
    points.insert(points.end(), line.begin(), line.end());
  }
  if (!options.points.empty()) {
    const auto file = read_points(options.points);
    points.insert(points.end(), file.begin(), file.end());
  }
  return points;
}

/// Returns the components of a field at `first` in a row as a number, or for vectors as a list of numbers; a
/// number that is not finite is written as null.
Figures components(const std::vector<double>& row, std::size_t first, int count) {
  if (count == 1) return row[first];
  Figures list = Figures::array();
  for (int c = 0; c < count; ++c) list.push_back(row[first + static_cast<std::size_t>(c)]);
  return list;
}

std::string components_text(const std::vector<double>& row, std::size_t first, int count) {
  std::string text;
  for (int c = 0; c < count; ++c) {
    const double value = row[first + static_cast<std::size_t>(c)];
    text +=
        (text.empty() ? "" : " ") + (std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("-"));
  }
  return text;
}

void report_integrals(const std::vector<MaterialTotals>& totals, const std::vector<FieldDescription>& fields,
                      bool print, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  for (const FieldDescription& f : fields) {
    rows[0].push_back("integral of " + f.name);
    rows[0].push_back("mean of " + f.name);
  }
  figures["materials"] = Figures::array();
  for (const MaterialTotals& of : totals) {
    Figures figure{{"name", of.name}, {"volume", of.volume}, {"fields", Figures::object()}};
    rows.push_back({of.name, volume_text(of.volume)});
    std::size_t first = 0;
    for (const FieldDescription& f : fields) {
      figure["fields"][f.name] = {{"integral", components(of.integrals, first, f.components)},
                                  {"mean", components(of.means, first, f.components)}};
      rows.back().push_back(components_text(of.integrals, first, f.components));
      rows.back().push_back(components_text(of.means, first, f.components));
      first += static_cast<std::size_t>(f.components);
    }
    figures["materials"].push_back(std::move(figure));
  }
  if (print) console.table(rows);
}

/// Prints the volumes that given interfaces enclose, where they are closed; returns a list of materials.
Figures print_enclosed_volumes(const Input& input, const InputProbe& probed, bool print, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  const bool known = !probed.totals.empty();
  for (std::size_t m = 0; m < input.materials().size(); ++m) {
    const std::string& name = input.materials()[m];
    figures.push_back(
        {{"name", name}, {"volume", known ? Figures(probed.totals[m].volume) : Figures(nullptr)}});
    rows.push_back({name, known ? volume_text(probed.totals[m].volume) : "-"});
  }
  if (print) console.table(rows);
  if (!known) console.note("{}: the interfaces are not closed, so that volumes are not known", input.name());
  return figures;
}

/// Prints the volumes and areas of given interfaces.
void report_network(const Input& input, const InputProbe& probed, bool print, Console& console,
                    Figures& figures) {
  if (print) console.print("  domain {}\n", box_text(input.domain()));
  figures["materials"] = print_enclosed_volumes(input, probed, print, console);
  figures["interfaces"] = print_interfaces(*probed.interfaces, input.materials(), true, print, console);
}

/// Samples a mesh and integrates over it.
PointSamples probe_mesh(const std::string& path, const std::vector<Vec3>& points, Console& console,
                        Figures& figures) {
  const AdaptiveMesh mesh = read_adaptive_mesh(path, console);
  PointSamples samples = probe(mesh, points, console);
  console.check();
  report_integrals(material_totals(mesh), samples.fields, points.empty(), console, figures);
  return samples;
}

/// Samples an input other than a mesh and integrates over it.
PointSamples probe_input(const InputArguments& options, const std::vector<Vec3>& points, Console& console,
                         Figures& figures) {
  const Input input = read_input(options, console);
  check_fraction_options(options, input, input.name());
  InputProbe probed =
      probe_and_integrate(input, points, {options.smooth_labels, fraction_options(options)}, console);
  if (probed.interfaces)
    report_network(input, probed, points.empty(), console, figures);
  else
    report_integrals(probed.totals, probed.samples.fields, points.empty(), console, figures);
  return std::move(probed.samples);
}

/// Throws Error (kUsage) at options that have no effect on a mesh.
void check_mesh_options(const InputArguments& input) {
  const std::string material = input.grid_option(), interface = input.interface_option();
  if (!material.empty()) wrong_usage("{}: expected data on a grid as INPUT", material);
  if (!interface.empty()) wrong_usage("{}: expected given interfaces as INPUT", interface);
  if (!input.interfaces.empty()) wrong_usage("--interface: expected data on a grid as INPUT");
}

void run(const Options& options, Session& session) {
  Console& console = session.console;
  const std::string main = with_main_file(options.input).path;
  const bool meshed = !main.empty() && input_kind(main) == InputKind::kMesh;
  if (meshed) check_mesh_options(options.input);
  protect_inputs(options.input, main, session.outputs);
  if (!options.points.empty()) session.outputs.protect(options.points);
  session.outputs.declare("-o", options.output, {".csv", ".txt"});
  const std::vector<Vec3> points = wanted_points(options);
  if (points.empty() && !options.output.empty()) {
    wrong_usage("-o: expected --points-file, --point or --line as well");
  }
  Figures figures{{"points", points.size()}};
  const PointSamples samples = meshed ? probe_mesh(options.input.path, points, console, figures)
                                      : probe_input(options.input, points, console, figures);
  if (options.output.empty() && !points.empty()) console.write(to_csv(samples));
  session.outputs.write(options.output, [&](const auto& path) { write_text(path, to_csv(samples)); });
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_probe(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "probe", "Values and materials at points, and integrals per material",
                  "adamas probe mesh.vtu --line=-7,0,0..3.5,0,0,200 -o line.csv",
                  [options, &session] { run(*options, session); });
  command
      .add_option("input", options->input.path,
                  "What to probe: " + grid_files() +
                      ", interfaces (.vtp, .ply, .arec, .txt), or a mesh from adamas resample (.vtu)")
      .type_name("FILE");
  command.add_option("--points-file", options->points, "Points, x,y,z a line").type_name("FILE");
  command.add_option("--point", options->single, "A point; repeatable").type_name("x,y,z").one_value_each();
  command.add_option("--line", options->line, "n points from one point to another")
      .type_name("x,y,z..x,y,z,n");
  command
      .add_option("-o,--output", options->output,
                  "The samples: .csv (default: stdout). Integrals are printed where there are no points")
      .type_name("FILE");
  add_material_options(command, options->input);
  add_raw_options(command, options->input.raw, "--origin,--first-sample", "a raw file");
  add_reconstruction_options(command, options->input);
  add_interface_options(command, options->input);
}

}  // namespace adamas::cli
