#include "cli/data_summary.h"

#include <cstdint>

#include "adamas/series.h"
#include "cli/store_options.h"

namespace adamas::cli {

namespace {

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

/// A line on the axes where they are not x, y and z in this order, and one on the space, where it has a name.
void print_axes(const VolumeGrid& grid, Console& console) {
  if (!grid.is_straight()) {
    const auto& [i, j, k] = grid.directions;
    console.print("  axes {}, {}, {}, first sample at {}{}\n", place_text(i), place_text(j), place_text(k),
                  place_text(grid.origin), grid.is_left_handed() ? ", left-handed" : "");
  }
  if (!grid.space.empty()) console.print("  coordinates are {}\n", grid.space);
}

void print_places(const VolumeGrid& grid, Console& console) {
  console.print("  {}, spacing {:.6g}, {:.6g}, {:.6g}\n", box_text(grid.box()), grid.spacing.x,
                grid.spacing.y, grid.spacing.z);
  print_axes(grid, console);
}

/// `directions` (unit vectors of the axes), `space` (null where nothing says).
void add_axes(const VolumeGrid& grid, Figures& figures) {
  figures["directions"] = Figures::array();
  for (const Vec3& direction : grid.directions) figures["directions"].push_back(place_figures(direction));
  figures["space"] = grid.space.empty() ? Figures(nullptr) : Figures(grid.space);
}

/// `box`, `spacing`, `origin` (of the first sample), and the axes.
void add_places(const VolumeGrid& grid, Figures& figures) {
  figures["box"] = box_figures(grid.box());
  figures["spacing"] = place_figures(grid.spacing);
  figures["origin"] = place_figures(grid.origin);
  add_axes(grid, figures);
}

}  // namespace

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
  print_axes(places, console);
  if (!places.is_straight() || !s.space.empty()) add_axes(places, figures);
}

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
                    ranged ? fmt::format("{:.6g}", a.min) : "-",
                    ranged ? fmt::format("{:.6g}", a.max) : "-"});
  }
  if (rows.size() > 1) console.table(rows);
}

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

Figures print_store(const std::string& path, Session& session) {
  session.outputs.protect(path);
  VolumeStore store = VolumeStore::open(path);
  const StoreFacts facts = store.facts();
  const VolumeGrid& grid = store.grid();
  const auto [nx, ny, nz] = grid.dimensions;
  Console& console = session.console;
  const std::uint64_t before = grid.bytes() * store.steps();
  const StoredBytes& bytes = facts.bytes;
  const int levels = store.levels();
  const CodingText coding = coding_text(facts.coding);
  console.print("{}: stored {}\n", path, store.steps() > 1 ? "series of volumes" : "volume");
  console.print("  {} x {} x {} samples, {}\n", nx, ny, nz, sample_name(grid.type));
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
                  {"slope", grid.slope},
                  {"intercept", grid.intercept},
                  {"steps", store.steps()},
                  {"blocks", facts.blocks},
                  {"group_pages", facts.group_pages},
                  {"times", times},
                  {"levels", levels},
                  {"pages", facts.pages},
                  {"coding", coding.name},
                  {"gradients", facts.gradients},
                  {"bytes_input", before},
                  {"bytes_data", bytes.samples},
                  {"bytes_errors", bytes.bounds},
                  {"bytes_gradients", bytes.gradients},
                  {"bytes_file", facts.file_bytes}};
  add_places(grid, figures);
  print_range(store, path, console, figures);
  const std::uint64_t pages = facts.pages;
  const std::string coarsest =
      levels > 1 ? fmt::format(" to one in {} along each axis", std::uint64_t{1} << (levels - 1)) : "";
  console.print("  levels 0 to {}, all samples{}; {}{}\n", levels - 1, coarsest, counted(pages, "page"),
                store.steps() > 1 ? fmt::format(" a step, {} in all", pages * store.steps()) : "");
  console.print("  coding {}, {} gradients: {}\n\n", coding.name, facts.gradients ? "with" : "without",
                coding.meaning);
  print_store_bytes(before, bytes, facts.file_bytes, console);
  return figures;
}

}  // namespace adamas::cli
