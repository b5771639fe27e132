#include "cli/volume_places.h"

#include <nlohmann/json.hpp>

namespace adamas {

namespace {

Figures vector_figures(const Vec3& v) { return Figures{v.x, v.y, v.z}; }

}  // namespace

void print_places(const VolumeGrid& grid, Console& console) {
  console.print("  {}, spacing {:.6g}, {:.6g}, {:.6g}\n", box_text(grid.box()), grid.spacing.x,
                grid.spacing.y, grid.spacing.z);
  print_axes(grid, console);
}

void print_axes(const VolumeGrid& grid, Console& console) {
  if (!grid.is_straight()) {
    const auto& [i, j, k] = grid.directions;
    console.print("  axes {}, {}, {}, first sample at {}{}\n", place_text(i), place_text(j), place_text(k),
                  place_text(grid.origin), grid.is_left_handed() ? ", left-handed" : "");
  }
  if (!grid.space.empty()) console.print("  coordinates are {}\n", grid.space);
}

void add_places(const VolumeGrid& grid, Figures& figures) {
  figures["box"] = box_figures(grid.box());
  figures["spacing"] = vector_figures(grid.spacing);
  figures["origin"] = vector_figures(grid.origin);
  figures["directions"] = Figures::array();
  for (const Vec3& direction : grid.directions) figures["directions"].push_back(vector_figures(direction));
  figures["space"] = grid.space.empty() ? Figures(nullptr) : Figures(grid.space);
}

}  // namespace adamas
