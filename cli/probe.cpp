#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/network_figures.h"
#include "cli/option_values.h"
#include "cli/point_table.h"
#include "cli/usage.h"
#include "core/io/output_stream.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/probe/material_integrals.h"
#include "workflow/slices/slice_loading.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace workflow;

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

/// The value of a field: a number, or a list of numbers for vectors.
Figures components(const std::vector<double>& row, const FieldInfo& info) {
  // A number that is not finite is written as null.
  if (info.components == 1) return row[info.offset];
  Figures list = Figures::array();
  for (int c = 0; c < info.components; ++c) list.push_back(row[info.offset + static_cast<std::size_t>(c)]);
  return list;
}

std::string components_text(const std::vector<double>& row, const FieldInfo& info) {
  std::string text;
  for (int c = 0; c < info.components; ++c) {
    const double value = row[info.offset + static_cast<std::size_t>(c)];
    text +=
        (text.empty() ? "" : " ") + (std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("-"));
  }
  return text;
}

void report_integrals(const IdVector<MaterialId, MaterialIntegral>& integrals,
                      const IdVector<MaterialId, std::string>& materials,
                      const std::vector<FieldInfo>& fields, bool print, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  for (const FieldInfo& f : fields) {
    rows[0].push_back("integral of " + f.name);
    rows[0].push_back("mean of " + f.name);
  }
  figures["materials"] = Figures::array();
  for (MaterialId m(0); m.value < materials.size(); ++m.value) {
    Figures figure{{"name", materials[m]}, {"volume", integrals[m].volume}, {"fields", Figures::object()}};
    rows.push_back({materials[m], volume_text(integrals[m].volume)});
    for (const FieldInfo& f : fields) {
      figure["fields"][f.name] = {{"integral", components(integrals[m].integral, f)},
                                  {"mean", components(integrals[m].mean, f)}};
      rows.back().push_back(components_text(integrals[m].integral, f));
      rows.back().push_back(components_text(integrals[m].mean, f));
    }
    figures["materials"].push_back(std::move(figure));
  }
  if (print) console.table(rows);
}

/// Prints the volumes and areas of given interfaces.
void report_network(const ResamplingSource& source, bool print, Console& console, Figures& figures) {
  if (print) console.print("  domain {}\n", box_text(source.box));
  figures["materials"] = print_network_volumes(source, "volume", print, console);
  figures["interfaces"] = print_interface_areas(source, print, console);
}

/// Notes how many points are outside of the domain: that they have no values is easily overlooked in a table.
void note_points_outside(const PointTable& table, const Box3& domain, Console& console) {
  const auto outside = std::count_if(table.samples.begin(), table.samples.end(),
                                     [](const ProbeSample& sample) { return !sample.inside; });
  if (outside == 0) return;
  console.note("{} of {} points {} outside of the domain {}", outside, table.samples.size(),
               outside == 1 ? "lies" : "lie", box_text(domain));
}

/// Throws Error (kUsage) at options that mean nothing for a mesh.
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
  PointTable table;
  const bool to_stdout = options.output.empty() && !points.empty();
  if (meshed) {
    const ResampledMesh mesh = load_resampled_mesh(options.input.path, console);
    console.step("probing", -1);
    table = {mesh.materials, mesh.fields, probe(mesh, points)};
    note_points_outside(table, mesh.box, console);
    console.check();
    report_integrals(material_integrals(mesh), mesh.materials, mesh.fields, points.empty(), console, figures);
  } else {
    const workflow::LoadedInput input = load_input(options.input, console);
    const std::vector<FieldInfo> fields =
        input.source.fields ? input.source.fields->fields() : std::vector<FieldInfo>();
    console.step("probing", -1);
    table = {input.source.materials, fields, probe(input.source, points)};
    note_points_outside(table, input.source.box, console);
    console.check();
    if (input.data && !(input.data->fractions.empty() && input.data->labels.empty())) {
      report_integrals(material_integrals(*input.data), input.data->materials, field_infos(*input.data),
                       points.empty(), console, figures);
    } else {
      report_network(input.source, points.empty(), console, figures);
    }
  }
  if (to_stdout) console.write(table.csv());
  session.outputs.write(options.output, [&](const auto& path) {
    OutputStream stream(path);
    stream.write(table.csv());
    stream.finish();
  });
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
