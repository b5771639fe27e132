#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/series.h"
#include "cli/command.h"
#include "cli/data_summary.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/network_figures.h"
#include "cli/store_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "cli/volume_reading.h"
#include "core/io/array_names.h"
#include "core/io/file_summary.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/library/interface_areas.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/check.h"
#include "interfaces/selection/selection.h"
#include "workflow/input/saved_hierarchy.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

using Rows = std::vector<std::vector<std::string>>;

struct Options {
  InputArguments input;
  VolumeInput volume;
};

void print_volumes(const IdVector<MaterialId, std::string>& names, const IdVector<MaterialId, double>& of,
                   Console& console, Figures& figures) {
  double whole = 0;
  for (const double v : of) whole += v;
  figures["materials"] = Figures::array();
  Rows rows{{"material", "volume", "part"}};
  for (MaterialId m(0); m.value < names.size(); ++m.value) {
    figures["materials"].push_back({{"name", names[m]}, {"volume", of[m]}});
    rows.push_back(
        {names[m], volume_text(of[m]), fmt::format("{:.3f}%", whole > 0 ? 100 * of[m] / whole : 0)});
  }
  console.table(rows);
}

/// The least and the greatest value over all materials; of vectors, those of their lengths.
std::pair<double, double> range_of(const Field& field) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto add = [&](const FieldValues& values) {
    const auto n = static_cast<std::size_t>(field.components);
    for (std::size_t i = 0; i + n <= values.size(); i += n) {
      double value = values[i];
      if (n > 1) {
        value = 0;
        for (std::size_t c = 0; c < n; ++c) value = std::hypot(value, values[i + c]);
      }
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  add(field.values);
  for (const auto& values : field.material_values) add(values);
  return {low, high};
}

void print_fields(const MultiMaterialData& data, Console& console, Figures& figures) {
  figures["fields"] = Figures::array();
  Rows rows{{"field", "unit", "components", "of", "from", "to"}};
  for (const Field& field : data.fields) {
    const auto [low, high] = range_of(field);
    figures["fields"].push_back({{"name", field.name},
                                 {"unit", field.unit},
                                 {"components", field.components},
                                 {"per_material", field.per_material()},
                                 {"min", low},
                                 {"max", high}});
    rows.push_back({field.name, field.unit.empty() ? "-" : field.unit, std::to_string(field.components),
                    field.per_material() ? "each material" : "all", fmt::format("{:.6g}", low),
                    fmt::format("{:.6g}", high)});
  }
  if (rows.size() > 1) console.table(rows);
}

void print_data(const InputArguments& options, Console& console, Figures& figures) {
  const MultiMaterialData data = load_data(options, console);
  console.print("\n");
  print_volumes(data.materials, data.volumes(), console, figures);
  if (data.labels.empty()) {
    figures["fraction_sum_min"] = data.report.sum_min;
    figures["fraction_sum_max"] = data.report.sum_max;
  }
  console.print("\n");
  print_fields(data, console, figures);
}

void print_resampled(const ResampledMesh& mesh, Console& console, Figures& figures) {
  std::map<int, std::size_t> levels;
  for (const auto& cell : mesh.cells) ++levels[cell.level];
  Rows rows{{"level", "tetrahedra"}};
  figures["levels"] = Figures::array();
  for (const auto& [level, count] : levels) {
    rows.push_back({std::to_string(level), std::to_string(count)});
    figures["levels"].push_back({{"level", level}, {"tetrahedra", count}});
  }
  figures["bodies"] = mesh.table.body_count();
  figures["interfaces"] = mesh.table.interface_count();
  console.print("  {} bodies, {} interfaces, resampled from {}\n\n", mesh.table.body_count(),
                mesh.table.interface_count(), mesh.source);
  console.table(rows);
  const auto of = material_volumes(mesh.table, mesh.cell_set(), mesh.materials.size());
  console.print("\n");
  print_volumes(mesh.materials, of, console, figures);
  rows = {{"field", "unit", "components", "from", "to", "greatest error"}};
  figures["fields"] = Figures::array();
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    double worst = 0;
    for (const double e : mesh.field_errors[f]) worst = std::max(worst, e);
    figures["fields"].push_back({{"name", info.name},
                                 {"unit", info.unit},
                                 {"components", info.components},
                                 {"min", info.min},
                                 {"max", info.max},
                                 {"max_error", worst}});
    rows.push_back({info.name, info.unit.empty() ? "-" : info.unit, std::to_string(info.components),
                    fmt::format("{:.6g}", info.min), fmt::format("{:.6g}", info.max),
                    fmt::format("{:.4g}", worst)});
  }
  console.print("\n");
  if (rows.size() > 1) console.table(rows);
}

/// Prints the size of a saved hierarchy, the error for which it was built, and its finest mesh.
Figures print_hierarchy(const std::string& path, Session& session) {
  Console& console = session.console;
  const SavedHierarchy hierarchy = workflow::load_saved_hierarchy(path, console);
  Figures figures{{"file", path},
                  {"kind", "saved hierarchy"},
                  {"tetrahedra_of_the_tree", hierarchy.tree.cells.size()},
                  {"diamonds", hierarchy.diamond_count()},
                  {"interface_error_target", hierarchy.interface_target}};
  console.print(
      "{}: saved hierarchy of {} tetrahedra, {} of them leaves, built for an interface error of {:.4g}\n",
      path, hierarchy.tree.cells.size(), hierarchy.root_count + hierarchy.split_cells.size(),
      hierarchy.interface_target);
  print_resampled(whole_mesh(hierarchy), console, figures);
  return figures;
}

/// Prints the interfaces, and whether their mesh is sound.
void print_network(const InterfaceMesh& mesh, Console& console, Figures& figures) {
  figures["materials"] = Figures::array();
  for (const std::string& name : mesh.materials) figures["materials"].push_back({{"name", name}});
  figures["interfaces"] = print_interfaces(
      interface_areas(mesh), {mesh.materials.begin(), mesh.materials.end()}, false, true, console);
  InterfaceMeshReport report;
  try {
    report = check_interface_mesh(mesh, nullptr, {true, true});
  } catch (const Error& e) {
    figures["unsound"] = e.what();
    console.print("  not usable: {}\n", e.what());
    return;
  }
  figures["degenerate_triangles"] = report.degenerate_triangles;
  figures["junction_edges"] = report.junction_edges;
  figures["open_border_edges"] = report.open_border_edges;
  figures["flipped_edges"] = report.flipped_edges;
  figures["intersections"] = report.intersections;
  console.table({{"triangles without area", std::to_string(report.degenerate_triangles)},
                 {"edges where more than two meet", std::to_string(report.junction_edges)},
                 {"open border edges", std::to_string(report.open_border_edges)},
                 {"edges round which materials do not match", std::to_string(report.flipped_edges)},
                 {"pairs of triangles that intersect", std::to_string(report.intersections)}});
}

bool has_data(const FileSummary& s, const InputArguments& options) {
  return !options.material_option().empty() ||
         std::any_of(s.arrays.begin(), s.arrays.end(),
                     [](const auto& a) { return fraction_material(a.name).has_value(); });
}

/// Whether the polygons of a file are interfaces: they have materials on both sides.
bool is_network(const FileSummary& s, const InputArguments& options) {
  if (file_extension(options.path) != ".vtp") return true;
  const auto front = [](const ArraySummary& a) { return a.location == "cells" && a.name == "front"; };
  return std::any_of(s.arrays.begin(), s.arrays.end(), front);
}

void print_details(const FileSummary& s, const InputArguments& options, Console& console, Figures& figures) {
  switch (input_kind(options.path)) {
    case InputKind::kGrid:
      print_arrays(s, console, figures);
      if (has_data(s, options)) print_data(options, console, figures);
      return;
    case InputKind::kMesh: {
      const UnstructuredMesh mesh = read_unstructured_mesh(options.path);
      if (is_resampled_mesh(mesh)) {
        figures["kind"] = "resampled mesh";
        return print_resampled(from_unstructured_mesh(mesh, options.path), console, figures);
      }
      return print_arrays(s, console, figures);
    }
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      if (is_network(s, options))
        return print_network(workflow::read_given_interfaces(to_input_options(options)), console, figures);
      return print_arrays(s, console, figures);
    case InputKind::kSurface:
      break;
  }
}

void check_options(const Options& all) {
  const InputArguments& options = all.input;
  const InputKind kind = input_kind(options.path);
  const std::string of_volume = all.volume.option();
  if (!of_volume.empty() && (is_store(options.path) || kind == InputKind::kMesh)) {
    wrong_usage("{}: expected a volume as INPUT, found {}", of_volume, options.path);
  }
  if (!of_volume.empty() && !options.grid_option().empty())
    wrong_usage("{} and {}: expected one of them", of_volume, options.grid_option());
  if ((kind != InputKind::kGrid || is_store(options.path)) && !options.grid_option().empty()) {
    wrong_usage("{}: expected data on a grid as INPUT", options.grid_option());
  }
  if (kind != InputKind::kNetwork && !options.region_names.empty()) {
    wrong_usage("--region-names: expected a labelled network (.arec, .txt) as INPUT");
  }
}

/// Prints what is in one file, or in one time of it.
Figures print_one(const Options& all, Session& session) {
  const InputArguments& options = all.input;
  protect_inputs(options, options.path, session.outputs);
  check_options(all);
  if (!all.volume.stack) check_input_file(options.path);
  if (is_store(options.path)) return print_store(options.path, session);
  if (workflow::is_saved_hierarchy(options.path)) return print_hierarchy(options.path, session);
  session.console.step("reading " + options.path, -1);
  if (auto volume = find_volume(options, all.volume, session))
    return print_volume(std::move(*volume), options.path, all.volume.array, session);
  // Unless an option says otherwise, labels and fractions belong to cells.
  const std::optional<RawVolume> raw = raw_volume(options.raw);
  const FileSummary summary = summarize_file(
      options.path, options.centering(), options.names_materials() ? Centering::kCells : Centering::kPoints,
      raw ? &*raw : nullptr);
  Figures figures{{"file", options.path}, {"kind", summary.kind}};
  session.console.print("{}: {}\n", options.path, summary.kind);
  print_grid(summary, session.console, figures);
  print_details(summary, options, session.console, figures);
  if (!summary.remark.empty() && !has_data(summary, options))
    session.console.note("{}: {}", options.path, summary.remark);
  return figures;
}

/// The steps of a series of files, or of the series that one file is; none where the input is none.
std::vector<VolumeInputStep> steps_of(const Options& all) {
  const InputArguments& options = all.input;
  std::vector<VolumeInputStep> steps;
  if (all.volume.stack || is_store(options.path)) return steps;
  VolumeInput volume = all.volume;
  for (const SeriesEntry& entry : series_steps({options.path})) {
    volume.path = entry.file;
    steps.push_back({entry.time, entry.file, volume});
  }
  if (!steps.empty() || !options.grid_option().empty() || workflow::is_saved_hierarchy(options.path))
    return steps;
  check_input_file(options.path);
  steps = find_volume_steps({options.path}, volume).steps;
  if (steps.size() == 1) steps.clear();
  return steps;
}

/// Prints how many steps a series has and when they are, and what the first one is.
Figures print_series(const Options& all, const std::vector<VolumeInputStep>& steps, Session& session) {
  std::vector<double> times;
  for (const VolumeInputStep& step : steps) {
    session.outputs.protect(step.input.path);
    times.push_back(step.time);
  }
  const std::string& path = all.input.path;
  session.console.print("{}: series of {}\n\nthe first of them, ", path, times_text(times));
  Options first{all.input, steps.front().input};
  first.input.path = steps.front().input.path;
  Figures figures{{"file", path}, {"kind", "series"}, {"steps", times.size()}, {"times", times}};
  figures["first_step"] = print_one(first, session);
  return figures;
}

void run(const Options& given, Session& session) {
  Options all{with_needed_main_file(given.input, "a FILE"), given.volume};
  give_raw_options(all.volume, all.input);
  session.outputs.protect(all.input.path);
  const std::vector<VolumeInputStep> steps = steps_of(all);
  const Figures figures = steps.empty() ? print_one(all, session) : print_series(all, steps, session);
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_info(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(app, session, "info", "What is in a file", "adamas info cth.vtr",
                                      [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->input.path,
          "Any file that can be read: " + grid_files() +
              ", a mesh (.vtu), a saved hierarchy (.h5), interfaces (.vtp, .ply, .arec, .txt), a surface "
              "(.obj, .off, .ply, .stl) or a store (.adm). Or a series: a .pvd, a pattern of names in "
              "quotes, "
              "as \"run_%04d.vti\", or a file with several times")
      .type_name("FILE");
  add_material_options(command, options->input);
  command
      .add_option("--region-names", options->input.region_names,
                  "Names of a network's labels, LABEL NAME a line")
      .type_name("FILE")
      .group("Input");
  add_volume_options(command, options->volume, "--origin,--first-sample");
}

}  // namespace adamas::cli
