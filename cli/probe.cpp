#include "adamas/probe.h"

#include <algorithm>
#include <cmath>

#include "adamas/files.h"
#include "adamas/mesh_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/interface_figures.h"
#include "cli/ledger.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

struct Options {
  InputOptions input;
  ReconstructOptions reconstruction;
  std::vector<Vec3> single, line;
  std::filesystem::path points;
  std::string output;
};

/// Parses a line of points, "x,y,z..x,y,z,n".
std::vector<Vec3> parse_line(const std::string& option, const std::string& text) {
  const std::size_t dots = text.find("..");
  const std::size_t comma = text.rfind(',');
  if (dots == std::string::npos ||
      std::count(text.begin() + static_cast<std::ptrdiff_t>(dots), text.end(), ',') != 3) {
    wrong_usage("{}: expected x,y,z..x,y,z,n with the number of points at the end, found '{}'", option, text);
  }
  const std::size_t count = parse_count(option, text.substr(comma + 1));
  if (count < 2 || count > 100'000'000) {
    wrong_usage("{}: expected 2 to 100000000 points, found {}", option, count);
  }
  return line_points(parse_vector(option, text.substr(0, dots)),
                     parse_vector(option, text.substr(dots + 2, comma - dots - 2)), count);
}

std::vector<Vec3> wanted_points(const Options& options) {
  std::vector<Vec3> points = options.single;
  points.insert(points.end(), options.line.begin(), options.line.end());
  if (options.points.empty()) return points;
  const std::vector<Vec3> file = read_points(options.points);
  points.insert(points.end(), file.begin(), file.end());
  return points;
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
  for (const MaterialTotals& each : totals) {
    Figures figure{{"name", each.name}, {"volume", each.volume}, {"fields", Figures::object()}};
    rows.push_back({each.name, volume_text(each.volume)});
    std::size_t first = 0;
    for (const FieldDescription& f : fields) {
      figure["fields"][f.name] = {{"integral", component_figures(each.integrals, first, f.components)},
                                  {"mean", component_figures(each.means, first, f.components)}};
      rows.back().push_back(components_text(each.integrals, first, f.components));
      rows.back().push_back(components_text(each.means, first, f.components));
      first += static_cast<std::size_t>(f.components);
    }
    figures["materials"].push_back(std::move(figure));
  }
  if (print) console.table(rows);
}

/// Prints the volumes and areas of given interfaces.
void report_network(const Input& input, const InputProbe& probed, bool print, Console& console,
                    Figures& figures) {
  if (print) console.print("  domain {}\n", box_text(input.domain()));
  EnclosedVolumes volumes;
  for (const std::string& name : input.materials()) volumes.emplace_back(name, std::nullopt);
  for (std::size_t m = 0; m < probed.totals.size(); ++m) volumes[m].second = probed.totals[m].volume;
  figures["materials"] = print_enclosed_volumes(volumes, "volume", input.name(), print, console);
  figures["interfaces"] = print_interfaces(*probed.interfaces, input.materials(), true, print, console);
}

/// Samples a mesh, and integrates over it where that is shown.
PointSamples probe_mesh(const std::string& path, const std::vector<Vec3>& points, bool integrate,
                        Console& console, Figures& figures) {
  const AdaptiveMesh mesh = read_adaptive_mesh(path, console);
  PointSamples samples = probe(mesh, points, console);
  console.check();
  if (integrate) report_integrals(material_totals(mesh), samples.fields, points.empty(), console, figures);
  return samples;
}

/// Samples another input and integrates over it.
PointSamples probe_input(const Options& options, const std::vector<Vec3>& points, Console& console,
                         Figures& figures) {
  const Input input = read_input(options.input, options.reconstruction, console);
  InputProbe probed = probe_and_integrate(input, points, options.reconstruction, console);
  if (probed.interfaces)
    report_network(input, probed, points.empty(), console, figures);
  else
    report_integrals(probed.totals, probed.samples.fields, points.empty(), console, figures);
  return std::move(probed.samples);
}

/// Throws Error (kUsage) at options that mean nothing for a mesh.
void check_mesh_options(const Options& options) {
  const std::string grid = options.input.grid_option(options.reconstruction.option());
  const std::string interface = options.input.interface_option();
  if (!grid.empty()) wrong_usage("{}: expected data on a grid as INPUT", grid);
  if (!interface.empty()) wrong_usage("{}: expected given interfaces as INPUT", interface);
  if (!options.input.surfaces.empty()) wrong_usage("--interface: expected data on a grid as INPUT");
}

void run(const Options& options, Session& session) {
  Console& console = session.console;
  const std::filesystem::path main = with_main_file(options.input).path;
  const bool meshed = !main.empty() && input_kind(main) == InputKind::kMesh;
  if (meshed) check_mesh_options(options);
  protect_inputs(options.input, main, session.outputs);
  if (!options.points.empty()) session.outputs.protect(options.points);
  session.outputs.declare("-o", options.output, {".csv", ".txt"});
  const std::vector<Vec3> points = wanted_points(options);
  if (points.empty() && !options.output.empty()) {
    wrong_usage("-o: expected --points-file, --point or --line as well");
  }
  Figures figures{{"points", points.size()}};
  const bool integrate = points.empty() || !session.json.empty();
  const PointSamples samples = meshed ? probe_mesh(options.input.path, points, integrate, console, figures)
                                      : probe_input(options, points, console, figures);
  if (options.output.empty() && !points.empty()) console.write(to_csv(samples));
  session.outputs.write(options.output, [&](const auto& path) { write_text(path, to_csv(samples)); });
  write_figures(figures, session);
  session.commit();
}

}  // namespace

void add_probe(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "probe", "Values and materials at points, and integrals per material",
                  "adamas probe mesh.vtu --line=-7,0,0..3.5,0,0,200 -o line.csv", run);
  command.add_file("input", "FILE",
                   "What to probe: " + grid_files() +
                       ", interfaces (.vtp, .ply, .arec, .txt), or a mesh from adamas resample (.vtu)",
                   options.input.path);
  command.add_file("--points-file", "FILE", "Points, x,y,z a line", options.points);
  command.add_values("--point", "x,y,z", "A point; repeatable", options.single, parse_vector);
  command.add_value("--line", "x,y,z..x,y,z,n", "n points from one point to another", options.line,
                    parse_line);
  command.add_option("-o,--output", "FILE",
                     "The samples: .csv (default: stdout). Integrals are printed where there are no points",
                     options.output);
  add_input_options(command, options.input, options.reconstruction.smooth_labels,
                    options.reconstruction.fractions);
}

}  // namespace adamas::cli
