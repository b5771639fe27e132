#include "interfaces/reconstruction/lost_bodies.h"

#include <algorithm>

#include "core/base/loop_progress.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/held_cells.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// Volumes in cells: a group counts if it holds more than kLeastHeld; volumes up to kNothing count as 0.
constexpr double kLeastHeld = 1e-3, kNothing = 1e-12;

class LostBodySearch {
 public:
  LostBodySearch(const MultiMaterialData& data, const SiteValues& values, const SiteCells& cells)
      : values_(values), sites_(data.grid), held_(data, values), cell_(data.grid, values, cells) {}

  std::vector<LostBody> run() {
    std::vector<LostBody> lost;
    for (std::uint32_t group = 0; group < held_.group_count(); ++group) {
      if (group % 64 == 0) LoopProgress::check();
      if (holds_more_than_traces(group) && !shows(group)) lost.push_back(describe(group));
    }
    return lost;
  }

 private:
  [[nodiscard]] bool holds_more_than_traces(std::uint32_t group) const {
    double held = 0;
    return !held_.for_each_cell(group, [&](std::size_t, double fraction) {
      held += fraction;
      return held <= kLeastHeld;
    });
  }

  /// Returns whether a material owns a part of a cell of a group. The owners of the sites are checked first,
  /// since most materials own a site.
  bool shows(std::uint32_t group) {
    const MaterialId material = held_.material(group);
    const bool nowhere = held_.for_each_cell(group, [&](std::size_t site, double) {
      return values_.material(std::ranges::max_element(values_.at(site), {}, &Entry::value)->material) !=
             material;
    });
    return !nowhere || !held_.for_each_cell(group, [&](std::size_t site, double) {
      cell_.set_site(site);
      const std::vector<double>& volumes = cell_.measure();
      for (std::size_t m = 0; m < volumes.size(); ++m) {
        if (values_.material(cell_.materials()[m].number) == material && volumes[m] > kNothing) return false;
      }
      return true;
    });
  }

  [[nodiscard]] LostBody describe(std::uint32_t group) const {
    LostBody body{held_.material(group), 0, 0, {}, 0};
    held_.for_each_cell(group, [&](std::size_t site, double fraction) {
      const double volume = fraction * sites_.cell(site).volume();
      ++body.cells;
      body.volume += volume;
      body.place += volume * sites_.cell(site).center();
      body.fraction = std::max(body.fraction, fraction);
      return true;
    });
    body.place *= 1 / body.volume;
    return body;
  }

  const SiteValues& values_;
  GridSites sites_;
  HeldCells held_;
  CellVolumes cell_;
};

}  // namespace

bool is_one_step(double fraction, const FractionReport& report) {
  constexpr double kScaled = 1.5;  // less than two steps
  return fraction <= kScaled * report.step;
}

std::vector<LostBody> find_lost_bodies(const MultiMaterialData& data, const SiteValues& values,
                                       const SiteCells& cells) {
  return LostBodySearch(data, values, cells).run();
}

}  // namespace adamas::interfaces
