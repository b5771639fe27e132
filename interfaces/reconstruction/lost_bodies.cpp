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
    std::size_t looked_at = 0;
    for (const std::uint32_t site : values_.mixed_sites()) {
      if (looked_at++ % 64 == 0) LoopProgress::check();
      for (const Entry& entry : values_.at(site)) {
        const MaterialId material = values_.material(entry.material);
        // One of several regions of a material represents it.
        if (&entry != held_.find(site, material) || held_.group(site, material) != HeldCells::kNone) continue;
        held_.collect(site, material, group_);
        double held = 0;
        for (const auto& [at, fraction] : group_) held += fraction;
        if (held > kLeastHeld && !shows(material)) lost.push_back(describe(material));
      }
    }
    return lost;
  }

 private:
  /// Returns whether a material owns a part of a cell of the group. The owners of the sites are checked
  /// first, since most materials own a site.
  bool shows(MaterialId material) {
    const bool at_site = std::any_of(group_.begin(), group_.end(), [&](const auto& member) {
      const auto own = values_.at(member.first);
      const auto most = std::max_element(own.begin(), own.end(),
                                         [](const Entry& a, const Entry& b) { return a.value < b.value; });
      return values_.material(most->material) == material;
    });
    return at_site || std::any_of(group_.begin(), group_.end(), [&](const auto& member) {
             cell_.set_site(member.first);
             const std::vector<double>& volumes = cell_.measure();
             for (std::size_t m = 0; m < volumes.size(); ++m) {
               if (values_.material(cell_.materials()[m].number) == material && volumes[m] > kNothing)
                 return true;
             }
             return false;
           });
  }

  [[nodiscard]] LostBody describe(MaterialId material) const {
    LostBody body{material, 0, group_.size(), {}, 0};
    for (const auto& [site, fraction] : group_) {
      const double volume = fraction * sites_.cell(site).volume();
      body.volume += volume;
      body.place += volume * sites_.cell(site).center();
      body.fraction = std::max(body.fraction, fraction);
    }
    body.place *= 1 / body.volume;
    return body;
  }

  const SiteValues& values_;
  GridSites sites_;
  HeldCells held_;
  CellVolumes cell_;
  std::vector<std::pair<std::size_t, double>> group_;  // sites with their fractions
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
