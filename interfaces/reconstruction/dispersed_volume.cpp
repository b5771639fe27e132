#include "interfaces/reconstruction/dispersed_volume.h"

#include <algorithm>

#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/dispersed_criterion.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;
using Is = DispersedCriterion;

class DispersedSearch {
 public:
  DispersedSearch(const MultiMaterialData& data, const ThinSheets& sheets, SiteValues& values)
      : data_(data), sheets_(sheets), values_(values), sites_(data.grid) {}

  std::vector<double> run(bool keep) {
    std::vector<double> taken(data_.materials.size(), 0);
    if (!data_.labels.empty()) return taken;
    std::vector<std::vector<std::uint32_t>> little(data_.materials.size());
    for (const std::uint32_t site : values_.mixed_sites()) {
      for (const Entry& entry : values_.at(site)) {
        if (!entry.is_pure() && entry.fraction < Is::kLittle) little[entry.material].push_back(site);
      }
    }
    std::vector<std::uint32_t> changed;
    for (std::uint16_t number = 0; number < little.size(); ++number) {
      if (little[number].empty()) continue;
      for (const std::uint32_t site : dispersed(number, little[number])) {
        Entry& entry = *find_entry(values_.at(site), number);
        // A cell's only material is not taken out.
        if (!holds_another(values_.at(site), number)) continue;
        changed.push_back(site);
        if (keep) {
          for (Entry& each : values_.at(site)) each.width = 0;
          continue;
        }
        taken[values_.material(number).value] +=
            sites_.cell(site).volume() * static_cast<double>(entry.fraction);
        entry.fraction = 0;
        entry.width = 0;
      }
    }
    if (keep) return taken;
    sort_unique(changed);
    for (const std::uint32_t site : changed) {
      if (!give_to_others(values_.at(site))) continue;
      for (Entry& entry : values_.at(site)) {
        if (entry.fraction > 0) entry.width = 0;
      }
    }
    return taken;
  }

 private:
  /// Returns those of the sites that hold little of a material where it is dispersed.
  std::vector<std::uint32_t> dispersed(std::uint16_t number, const std::vector<std::uint32_t>& little) {
    const SiteArray<float>& fractions = data_.fractions[values_.material(number)];
    double widest = 0;
    for (const std::uint32_t site : little)
      widest = std::max(widest, values_.width(*find_entry(values_.at(site), number)));
    const int reach = Is::reach(widest / data_.grid.least_spacing());
    const SiteBox box = SiteBox::round(data_.grid, little, static_cast<std::size_t>(reach));
    std::vector<std::uint8_t> much(box.size());
    box.for_each([&](std::size_t place, std::size_t site) { much[place] = fractions[site] >= Is::kLittle; });
    for (const SheetPlace& place : sheets_.places) {
      if (place.material == number && box.contains(place.site)) much[box.place(place.site)] = 1;
    }
    box.dilate(much, reach);
    std::vector<std::uint32_t> found;
    for (const std::uint32_t site : little) {
      if (much[box.place(site)] != 0) continue;
      if (is_everywhere(site, fractions)) found.push_back(site);
    }
    return found;
  }

  /// Returns whether most of the cells near a site hold about as much as it does.
  [[nodiscard]] bool is_everywhere(std::size_t site, const SiteArray<float>& fractions) const {
    std::size_t holding = 0, cells = 0;
    sites_.for_each_within(site, Is::kNear, [&](std::size_t other, int, int, int) {
      holding += Is::is_alike(fractions[other], fractions[site]) ? 1 : 0;
      ++cells;
    });
    return Is::is_most(holding, cells);
  }

  const MultiMaterialData& data_;
  const ThinSheets& sheets_;
  SiteValues& values_;
  GridSites sites_;
};

}  // namespace

bool is_all_dispersed(const FractionFindings& findings, MaterialId material, double volume) {
  constexpr double kRoundOff = 1e-9;
  return material.value < findings.dispersed.size() && findings.dispersed[material.value] > 0 &&
         findings.dispersed[material.value] >= (1 - kRoundOff) * volume;
}

std::vector<double> take_dispersed(const MultiMaterialData& data, const ThinSheets& sheets, bool keep,
                                   SiteValues& values) {
  return DispersedSearch(data, sheets, values).run(keep);
}

}  // namespace adamas::interfaces
