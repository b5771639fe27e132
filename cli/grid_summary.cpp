#include "cli/grid_summary.h"

#include <nlohmann/json.hpp>

#include "cli/volume_places.h"

namespace adamas {

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
  if (!places.is_straight() || !s.space.empty()) {
    Figures all;
    add_places(places, all);
    figures["directions"] = all["directions"];
    figures["space"] = all["space"];
  }
}

void print_arrays(const FileSummary& s, Console& console, Figures& figures) {
  figures["arrays"] = Figures::array();
  std::vector<std::vector<std::string>> rows{{"array", "on", "type", "components", "from", "to"}};
  for (const ArraySummary& a : s.arrays) {
    const bool ranged = a.min <= a.max;
    figures["arrays"].push_back({{"name", a.name},
                                 {"on", a.of},
                                 {"type", a.type},
                                 {"components", a.components},
                                 {"min", ranged ? Figures(a.min) : Figures(nullptr)},
                                 {"max", ranged ? Figures(a.max) : Figures(nullptr)}});
    rows.push_back({a.name, a.of, a.type, std::to_string(a.components),
                    ranged ? fmt::format("{:.6g}", a.min) : "-",
                    ranged ? fmt::format("{:.6g}", a.max) : "-"});
  }
  if (rows.size() > 1) console.table(rows);
}

}  // namespace adamas
