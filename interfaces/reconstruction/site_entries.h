#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// The entry with a number among those of a site; null where there is none.
template <class Entry>
Entry* find_entry(std::span<Entry> entries, std::uint16_t number) {
  const auto found = std::ranges::find_if(entries, [&](const Entry& e) { return e.material == number; });
  return found == entries.end() ? nullptr : &*found;
}

/// The place among all entries of a site's first entry of a material, which it has, or of its regions.
inline std::size_t first_entry(const SiteValues& values, std::size_t site, std::uint16_t material) {
  const std::span<const SiteValues::Entry> own = values.at(site);
  const auto found =
      std::ranges::find_if(own, [&](const auto& e) { return values.whole(e.material) == material; });
  return values.index(*found);
}

/// What the data say of a site's entries, before errors are smoothed away, but without what is dispersed:
/// `given[e]` is the fraction of the material of the e-th entry, 0 for all but the first of a material and
/// its regions. The sum is 1 where there is any.
inline void find_given_fractions(const MultiMaterialData& data, const SiteValues& values, std::size_t site,
                                 std::vector<double>& given) {
  const std::span<const SiteValues::Entry> own = values.at(site);
  given.assign(own.size(), 0);
  double sum = 0;
  for (std::size_t e = 0; e < own.size(); ++e) {
    const std::uint16_t whole = values.whole(own[e].material);
    bool first = true, held = false;
    for (std::size_t o = 0; o < own.size(); ++o) {
      if (values.whole(own[o].material) != whole) continue;
      first = first && o >= e;
      held = held || own[o].fraction > 0;
    }
    if (first && held) given[e] = static_cast<double>(data.fraction(values.material(whole), site));
    sum += given[e];
  }
  for (double& g : given) g = sum > 0 ? g / sum : g;
}

}  // namespace adamas::interfaces
