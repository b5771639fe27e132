#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/series.h"
#include "adamas/summary.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/interface_figures.h"
#include "cli/store_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

using Rows = std::vector<std::vector<std::string>>;

struct Options {
  InputOptions input;
  VolumeInput volume;
};

/// Prints a line on the axes where they are not x, y and z in this order, and one on the space, where it has
/// a name.
void print_axes(const VolumeGrid& grid, Console& console) {
  if (!grid.is_straight()) {
    const auto& [i, j, k] = grid.directions;
    console.print("  axes {}, {}, {}, first sample at {}{}\n", place_text(i), place_text(j), place_text(k),
                  place_text(grid.origin), grid.is_left_handed() ? ", left-handed" : "");
  }
  if (!grid.space.empty()) console.print("  coordinates are {}\n", grid.space);
}

/// Prints a line on the units that are known.
void print_units(const VolumeGrid& grid, Console& console) {
  std::vector<std::string> units;
  if (!grid.length_unit.empty()) units.push_back("lengths are in " + grid.length_unit);
  if (!grid.value_unit.empty()) units.push_back("values are in " + grid.value_unit);
  if (!units.empty()) console.print("  {}\n", listed(units));
}

/// Prints a line on the box and the spacing of a volume, and those of print_axes.
void print_places(const VolumeGrid& grid, Console& console) {
  console.print("  {}, spacing {:.6g}, {:.6g}, {:.6g}\n", box_text(grid.box()), grid.spacing.x,
                grid.spacing.y, grid.spacing.z);
  print_axes(grid, console);
  print_units(grid, console);
}

/// Adds `directions` (unit vectors of the axes) and `space` (null where it is not known) to figures.
void add_axes(const VolumeGrid& grid, Figures& figures) {
  figures["directions"] = Figures::array();
  for (const Vec3& direction : grid.directions) figures["directions"].push_back(place_figures(direction));
  figures["space"] = grid.space.empty() ? Figures(nullptr) : Figures(grid.space);
}

/// Adds `length_unit` and `value_unit`, null where they are not known.
void add_units(const VolumeGrid& grid, Figures& figures) {
  const auto unit = [](const std::string& text) { return text.empty() ? Figures(nullptr) : Figures(text); };
  figures["length_unit"] = unit(grid.length_unit);
  figures["value_unit"] = unit(grid.value_unit);
}

/// Adds `box`, `spacing`, `origin` (of the first sample) and the axes to figures.
void add_places(const VolumeGrid& grid, Figures& figures) {
  figures["box"] = box_figures(grid.box());
  figures["spacing"] = place_figures(grid.spacing);
  figures["origin"] = place_figures(grid.origin);
  add_axes(grid, figures);
  add_units(grid, figures);
}

/// Returns a value of an array: whole numbers, such as labels, with all digits.
std::string value_text(const ArraySummary& array, double value) {
  const bool whole = array.type.find("int") != std::string::npos && value == std::round(value);
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.6g}", value);
}

/// Prints the numbers of points and cells, the box, axes and space.
void print_grid(const FileSummary& s, Console& console, Figures& figures) {
  if (s.nodes[0] > 0) {
    figures["nodes"] = s.nodes;
    console.print("  {} x {} x {} nodes\n", s.nodes[0], s.nodes[1], s.nodes[2]);
  }
  figures["points"] = s.points;
  figures["cells"] = s.cells;
  console.print("  {} points, {} cells\n", s.points, s.cells);
  if (s.points > 0) {
    figures["box"] = box_figures(s.box);
    console.print("  {}\n", box_text(s.box));
  }
  VolumeGrid places;
  places.directions = s.directions;
  places.origin = s.origin;
  places.space = s.space;
  places.length_unit = s.length_unit;
  places.value_unit = s.value_unit;
  print_axes(places, console);
  print_units(places, console);
  if (s.nodes[0] > 0) add_units(places, figures);
  if (!places.is_straight() || !s.space.empty()) add_axes(places, figures);
}

/// Prints a line for each array.
void print_arrays(const FileSummary& s, Console& console, Figures& figures) {
  figures["arrays"] = Figures::array();
  std::vector<std::vector<std::string>> rows{{"array", "on", "type", "components", "from", "to"}};
  for (const ArraySummary& a : s.arrays) {
    const bool ranged = a.min <= a.max;
    figures["arrays"].push_back({{"name", a.name},
                                 {"on", a.location},
                                 {"type", a.type},
                                 {"components", a.components},
                                 {"min", ranged ? Figures(a.min) : Figures(nullptr)},
                                 {"max", ranged ? Figures(a.max) : Figures(nullptr)}});
    rows.push_back({a.name, a.location, a.type, std::to_string(a.components),
                    ranged ? value_text(a, a.min) : "-", ranged ? value_text(a, a.max) : "-"});
  }
  if (rows.size() > 1) console.table(rows);
}

/// Prints a line for each side set and node set.
void print_sets(const FileSummary& s, Console& console, Figures& figures) {
  if (s.sets.empty()) return;
  const std::string extent = s.flat ? "length" : "area";
  figures["sets"] = Figures::array();
  Rows rows{{"set", "of", "number", extent}};
  for (const SetSummary& set : s.sets) {
    const std::string of = set.of_nodes ? "nodes" : "sides";
    Figures own{{"name", set.name}, {"of", of}, {"number", set.size}};
    if (set.extent) own[extent] = *set.extent;
    figures["sets"].push_back(std::move(own));
    rows.push_back({set.name, of, std::to_string(set.size), set.extent ? volume_text(*set.extent) : "-"});
  }
  console.print("\n");
  console.table(rows);
}

void print_volumes(const std::vector<MaterialVolume>& materials, Console& console, Figures& figures) {
  double whole = 0;
  for (const MaterialVolume& material : materials) whole += material.volume;
  figures["materials"] = Figures::array();
  Rows rows{{"material", "volume", "part"}};
  for (const auto& [name, volume] : materials) {
    figures["materials"].push_back({{"name", name}, {"volume", volume}});
    rows.push_back({name, volume_text(volume), fmt::format("{:.3f}%", whole > 0 ? 100 * volume / whole : 0)});
  }
  console.table(rows);
}

/// Prints fields of data on a grid, or of a resampled mesh, whose errors are known.
void print_fields(const std::vector<FieldFacts>& fields, bool resampled, Console& console, Figures& figures) {
  figures["fields"] = Figures::array();
  Rows rows{{"field", "unit", "components", "of", "from", "to", "greatest error"}};
  for (const FieldFacts& field : fields) {
    Figures facts{{"name", field.name}, {"unit", field.unit}, {"components", field.components}};
    if (!resampled) facts["per_material"] = field.per_material;
    facts["min"] = field.min;
    facts["max"] = field.max;
    if (resampled) facts["max_error"] = field.max_error;
    figures["fields"].push_back(std::move(facts));
    rows.push_back({field.name, field.unit.empty() ? "-" : field.unit, std::to_string(field.components),
                    field.per_material ? "each material" : "all", fmt::format("{:.6g}", field.min),
                    fmt::format("{:.6g}", field.max), fmt::format("{:.4g}", field.max_error)});
  }
  for (auto& row : rows) row.erase(resampled ? row.begin() + 3 : row.begin() + 6);
  console.print("\n");
  if (rows.size() > 1) console.table(rows);
}

void print_data(const InputOptions& options, Console& console, Figures& figures) {
  const MaterialDataSummary data = summarize_materials(options, console);
  console.print("\n");
  print_volumes(data.materials, console, figures);
  if (data.fraction_sums) {
    figures["fraction_sum_min"] = (*data.fraction_sums)[0];
    figures["fraction_sum_max"] = (*data.fraction_sums)[1];
  }
  print_fields(data.fields, false, console, figures);
}

void print_resampled(const MeshSummary& mesh, Console& console, Figures& figures) {
  Rows rows{{"level", "tetrahedra"}};
  figures["levels"] = Figures::array();
  for (const auto& [level, count] : mesh.levels) {
    rows.push_back({std::to_string(level), std::to_string(count)});
    figures["levels"].push_back({{"level", level}, {"tetrahedra", count}});
  }
  figures["bodies"] = mesh.bodies;
  figures["interfaces"] = mesh.interfaces;
  console.print("  {} bodies, {} interfaces, resampled from {}\n\n", mesh.bodies, mesh.interfaces,
                mesh.source);
  console.table(rows);
  console.print("\n");
  print_volumes(mesh.materials, console, figures);
  print_fields(mesh.fields, true, console, figures);
}

/// Prints the size of a saved hierarchy, the error for which it was built, and its finest mesh.
Figures print_hierarchy(const std::string& path, Session& session) {
  Console& console = session.console;
  const HierarchySummary hierarchy = summarize_hierarchy(path, console);
  Figures figures{{"file", path},
                  {"kind", "saved hierarchy"},
                  {"tetrahedra_of_the_tree", hierarchy.tree_tetrahedra},
                  {"diamonds", hierarchy.diamonds},
                  {"interface_error_target", hierarchy.interface_error_target}};
  console.print(
      "{}: saved hierarchy of {} tetrahedra, {} of them leaves, built for an interface error of {:.4g}\n",
      path, hierarchy.tree_tetrahedra, hierarchy.leaves, hierarchy.interface_error_target);
  print_resampled(hierarchy.finest, console, figures);
  return figures;
}

/// Prints the interfaces, and whether their mesh is sound.
void print_network(const NetworkSummary& network, Console& console, Figures& figures) {
  figures["materials"] = Figures::array();
  for (const std::string& name : network.materials) figures["materials"].push_back({{"name", name}});
  figures["interfaces"] = print_interfaces(network.interfaces, network.materials, false, true, console);
  if (!network.unsound.empty()) {
    figures["unsound"] = network.unsound;
    console.print("  not usable: {}\n", network.unsound);
    return;
  }
  figures["degenerate_triangles"] = network.degenerate_triangles;
  figures["junction_edges"] = network.junction_edges;
  figures["open_border_edges"] = network.open_border_edges;
  figures["flipped_edges"] = network.flipped_edges;
  figures["intersections"] = network.intersections;
  console.table({{"triangles without area", std::to_string(network.degenerate_triangles)},
                 {"edges where more than two meet", std::to_string(network.junction_edges)},
                 {"open border edges", std::to_string(network.open_border_edges)},
                 {"edges round which materials do not match", std::to_string(network.flipped_edges)},
                 {"pairs of triangles that intersect", std::to_string(network.intersections)}});
}

/// Returns how many steps there are and when: "6 steps, times from 0 to 1, 0.2 apart"; times that are not
/// evenly spaced, to a millionth of the mean distance, are named, the first and the last ones of many.
std::string times_text(const std::vector<double>& times) {
  if (times.size() < 2) return fmt::format("1 step, time {:.6g}", times.empty() ? 0 : times.front());
  std::string text =
      fmt::format("{} steps, times from {:.6g} to {:.6g}", times.size(), times.front(), times.back());
  constexpr double kSame = 1e-6;
  if (const auto spacing = even_spacing(times, kSame)) return text + fmt::format(", {:.6g} apart", *spacing);
  constexpr std::size_t kFirst = 4, kLast = 2;
  text += ", not evenly spaced: ";
  for (std::size_t n = 0; n < times.size(); ++n) {
    if (times.size() > kFirst + kLast + 1 && n == kFirst) {
      text += ", ...";
      n = times.size() - kLast;
    }
    text += fmt::format("{}{:.6g}", n > 0 ? ", " : "", times[n]);
  }
  return text;
}

/// Prints a summary of a volume.
Figures print_volume(const VolumeSummary& volume, const std::string& path, Console& console) {
  const FileSummary& summary = volume.file;
  Figures figures{{"file", path}, {"kind", summary.kind}};
  console.print("{}: {}\n", path, summary.kind);
  print_grid(summary, console, figures);
  add_places(volume.grid, figures);
  print_arrays(summary, console, figures);
  if (!volume.conversion.empty())
    console.note(volume.loses_digits ? NoteKind::kLoss : NoteKind::kRemark, volume.conversion);
  return figures;
}

/// Prints the least and the greatest sample of all steps, which the store knows.
void print_range(VolumeStore& store, const std::string& path, Console& console, Figures& figures) {
  if (!store.has_range())
    return console.note_incomplete("{}: what tells the range of values is damaged", path);
  const auto range = store.range();
  if (!range) return;
  const auto [low, high] = *range;
  console.print("  values from {:.6g} to {:.6g}\n", low, high);
  figures["min"] = low;
  figures["max"] = high;
}

struct CodingText {
  const char* name;
  const char* meaning;
};

CodingText coding_text(StoreFacts::Coding coding) {
  switch (coding) {
    case StoreFacts::Coding::kRanks:
      return {"interpolation of ranks",
              "samples have few different values, and the numbers of these are predicted from neighbours"};
    case StoreFacts::Coding::kInterpolation:
      return {"interpolation", "samples are predicted from all neighbours that are known already"};
    case StoreFacts::Coding::kNone:
      return {"none", "samples are in the file as they are"};
    case StoreFacts::Coding::kSplitEdge:
      break;
  }
  return {"split-edge", "samples are predicted from the ends of the edge whose middle they are"};
}

/// Prints what is in a store: its samples, steps, coding and bytes.
Figures print_store(const std::string& path, Session& session) {
  session.outputs.protect(path);
  VolumeStore store = VolumeStore::open(path);
  const StoreFacts facts = store.facts();
  const VolumeGrid& grid = store.grid();
  const auto [nx, ny, nz] = grid.dimensions;
  Console& console = session.console;
  const std::uint64_t before = facts.number_bytes;
  const StoredBytes& bytes = facts.bytes;
  const int lods = store.lods();
  const CodingText coding = coding_text(facts.coding);
  console.print("{}: stored {}\n", path, store.steps() > 1 ? "series of volumes" : "volume");
  console.print("  {} x {} x {} samples, {}\n", nx, ny, nz, type_text(grid.type, store.number_type()));
  if (!store.array().empty()) console.print("  array '{}'\n", store.array());
  if (grid.is_scaled())
    console.print("  values are {:.9g} times the samples plus {:.9g}\n", grid.slope, grid.intercept);
  print_places(grid, console);
  const std::vector<double> times = store.times();
  if (store.steps() > 1) console.print("  {}; in {}\n", times_text(times), counted(facts.blocks, "block"));
  if (facts.unfinished_bytes > 0)
    console.note("{}: {} bytes at its end are of steps that were never finished", path,
                 facts.unfinished_bytes);
  if (facts.group_pages > 1) console.print("  pages in groups of {}, step by step\n", facts.group_pages);
  Figures figures{{"file", path},
                  {"kind", "store"},
                  {"dimensions", grid.dimensions},
                  {"type", sample_name(grid.type)},
                  {"number_type", to_string(store.number_type())},
                  {"array", store.array().empty() ? Figures() : Figures(store.array())},
                  {"slope", grid.slope},
                  {"intercept", grid.intercept},
                  {"steps", store.steps()},
                  {"blocks", facts.blocks},
                  {"group_pages", facts.group_pages},
                  {"times", times},
                  {"levels", lods},
                  {"pages", facts.pages},
                  {"coding", coding.name},
                  {"gradients", facts.gradients},
                  {"bytes_input", before},
                  {"bytes_data", bytes.samples},
                  {"bytes_errors", bytes.bounds},
                  {"bytes_remainders", bytes.remainders},
                  {"bytes_gradients", bytes.gradients},
                  {"bytes_file", facts.file_bytes}};
  add_places(grid, figures);
  print_range(store, path, console, figures);
  const std::uint64_t pages = facts.pages;
  const std::string coarsest =
      lods > 1 ? fmt::format(" to one in {} along each axis", std::uint64_t{1} << (lods - 1)) : "";
  console.print("  LODs 0 to {}, all samples{}; {}{}\n", lods - 1, coarsest, counted(pages, "page"),
                store.steps() > 1 ? fmt::format(" a step, {} in all", pages * store.steps()) : "");
  console.print("  coding {}, {} gradients: {}\n\n", coding.name, facts.gradients ? "with" : "without",
                coding.meaning);
  print_store_bytes(before, bytes, facts.file_bytes, console);
  return figures;
}

bool has_data(const FileSummary& s, const InputOptions& options) {
  return !options.material_option().empty() || s.blocks > 1 ||
         std::any_of(s.arrays.begin(), s.arrays.end(),
                     [](const ArraySummary& a) { return a.fraction_of.has_value(); });
}

/// Whether the polygons of a file are interfaces: they have materials on both sides.
bool is_network(const FileSummary& s, const InputOptions& options) {
  if (file_extension(options.path) != ".vtp") return true;
  const auto front = [](const ArraySummary& a) { return a.location == "cells" && a.name == "front"; };
  return std::any_of(s.arrays.begin(), s.arrays.end(), front);
}

void print_details(const FileSummary& s, const InputOptions& options, Console& console, Figures& figures) {
  switch (input_kind(options.path)) {
    case InputKind::kGrid:
      print_arrays(s, console, figures);
      if (has_data(s, options)) print_data(options, console, figures);
      return;
    case InputKind::kMesh:
      if (const auto mesh = summarize_mesh(options.path)) {
        figures["kind"] = "resampled mesh";
        return print_resampled(*mesh, console, figures);
      }
      return print_arrays(s, console, figures);
    case InputKind::kCells:
      print_arrays(s, console, figures);
      print_sets(s, console, figures);
      if (s.kind != "polygons" && s.kind != "lines" && has_data(s, options))
        print_data(options, console, figures);
      return;
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      if (is_network(s, options)) return print_network(summarize_interfaces(options), console, figures);
      return print_arrays(s, console, figures);
    case InputKind::kSurface:
      break;
  }
}

void check_options(const Options& all) {
  const InputOptions& options = all.input;
  const InputKind kind = input_kind(options.path);
  const std::string of_volume = all.volume.option(), of_grid = options.grid_option();
  if (!of_volume.empty() && (is_store(options.path) || kind == InputKind::kMesh || kind == InputKind::kCells))
    wrong_usage("{}: expected a volume as INPUT, found {}", of_volume, options.path.string());
  if (!of_volume.empty() && !of_grid.empty())
    wrong_usage("{} and {}: expected one of them", of_volume, of_grid);
  const bool with_materials = kind == InputKind::kGrid || kind == InputKind::kCells;
  if ((!with_materials || is_store(options.path)) && !of_grid.empty())
    wrong_usage("{}: expected data on a grid as INPUT", of_grid);
  check_region_names(options);
}

/// Prints a summary of one file, or of one time of it.
Figures print_one(const Options& all, Session& session) {
  const InputOptions& options = all.input;
  const std::string path = options.path.string();
  protect_inputs(options, path, session.outputs);
  check_options(all);
  if (!all.volume.stack) check_readable(path);
  if (is_store(path)) return print_store(path, session);
  if (is_hierarchy_file(path)) return print_hierarchy(path, session);
  session.console.step("reading " + path, -1);
  VolumeInput volume = all.volume;
  volume.path = path;
  if (const auto found =
          summarize_volume(volume, !options.grid_option().empty(), session.outputs, session.console))
    return print_volume(*found, path, session.console);
  // Unless an option says otherwise, labels and fractions belong to cells.
  const FileSummary summary = summarize_file(
      path, options.data.centering, names_materials(options) ? Centering::kCells : Centering::kPoints,
      raw_volume(options.raw), options.data.time);
  Figures figures{{"file", path}, {"kind", summary.kind}};
  session.console.print("{}: {}\n", path, summary.kind);
  print_grid(summary, session.console, figures);
  if (summary.times.size() > 1) {
    session.console.print("  {}; this is number {} (--time)\n", times_text(summary.times),
                          options.data.time.value_or(summary.times.size() - 1));
    figures["times"] = summary.times;
  }
  print_details(summary, options, session.console, figures);
  if (!summary.remark.empty() && !has_data(summary, options))
    session.console.note("{}: {}", path, summary.remark);
  return figures;
}

/// Returns the steps of a series of files, or of the series in one file; empty where the input is no series.
std::vector<VolumeInputStep> steps_of(const Options& all) {
  const std::string path = all.input.path.string();
  std::vector<VolumeInputStep> steps;
  if (all.volume.stack || is_store(path)) return steps;
  VolumeInput volume = all.volume;
  for (const SeriesEntry& entry : series_steps({path})) {
    volume.path = entry.file;
    steps.push_back({entry.time, entry.file, volume});
  }
  if (!steps.empty() || !all.input.grid_option().empty() || is_hierarchy_file(path)) return steps;
  check_readable(path);
  if (input_kind(path) == InputKind::kCells) return steps;
  steps = find_volume_steps({path}, volume).steps;
  if (steps.size() == 1) steps.clear();
  return steps;
}

/// Prints the number and the times of the steps of a series, and a summary of the first one.
Figures print_series(const Options& all, const std::vector<VolumeInputStep>& steps, Session& session) {
  std::vector<double> times;
  for (const VolumeInputStep& step : steps) {
    session.outputs.protect(step.input.path);
    times.push_back(step.time);
  }
  const std::string path = all.input.path.string();
  session.console.print("{}: series of {}\n\nthe first of them, ", path, times_text(times));
  Options first{all.input, steps.front().input};
  first.input.path = steps.front().input.path;
  Figures figures{{"file", path}, {"kind", "series"}, {"steps", times.size()}, {"times", times}};
  figures["first_step"] = print_one(first, session);
  return figures;
}

/// Prints the series of a folder that has several, and for each the command that reads it; returns no figures
/// where it has not, or where one is chosen.
Figures print_folder_series(const Options& all, Session& session) {
  const std::string path = all.input.path.string();
  if (!all.volume.array.empty() || names_materials(all.input)) return {};
  const std::vector<SeriesSummary> series = folder_series(path);
  if (series.size() < 2) return {};
  Figures figures{{"file", path}, {"kind", "DICOM"}};
  session.console.print("{}: DICOM, {} series; one of them by\n\n", path, series.size());
  std::vector<std::string> commands;
  std::size_t widest = 0;
  for (const SeriesSummary& one : series) {
    commands.push_back(fmt::format("adamas info {} --array {}", as_argument(path), as_argument(one.name)));
    widest = std::max(widest, commands.back().size());
    figures["series"].push_back(
        {{"name", one.name}, {"uid", one.uid}, {"modality", one.kind}, {"files", one.files}});
  }
  for (std::size_t i = 0; i < series.size(); ++i)
    session.console.print("  {:<{}}   {}, {}\n", commands[i], widest,
                          series[i].kind.empty() ? "images" : series[i].kind,
                          counted(series[i].files, "file"));
  session.console.print(
      "\n--array is an option of all commands on volumes; --labels, --fraction and --field name series "
      "too\n");
  return figures;
}

void run(const Options& given, Session& session) {
  Options all{needed_main_file(given.input, "a FILE"), given.volume};
  share_raw_options(all.input, all.volume);
  share_time(all.input.path, all.input, all.volume);
  session.outputs.protect(all.input.path);
  if (const Figures listed = print_folder_series(all, session); !listed.empty()) {
    write_figures(listed, session);
    return session.commit();
  }
  const std::vector<VolumeInputStep> steps = steps_of(all);
  const Figures figures = steps.empty() ? print_one(all, session) : print_series(all, steps, session);
  write_figures(figures, session);
  session.commit();
}

}  // namespace

void add_info(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "info", "What is in a file", "adamas info cth.vtr", run);
  command.add_file(
      "input", "FILE",
      "Any file that can be read: " + grid_files() + ", " + mesh_files() +
          ", a mesh from adamas resample (.vtu), a saved hierarchy (.h5), interfaces (.vtp, .ply, .arec, "
          ".txt), a surface "
          "(.obj, .off, .ply, .stl) or a store (.adm). Or a series: a .pvd, a pattern of names in quotes, "
          "as \"run_%04d.vti\", or a file with several times",
      options.input.path);
  add_material_options(command, options.input);
  add_region_names(command, options.input);
  add_volume_options(command, options.volume, "--origin,--first-sample");
}

}  // namespace adamas::cli
