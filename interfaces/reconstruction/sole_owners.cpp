#include "interfaces/reconstruction/sole_owners.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/parallel.h"

namespace adamas::interfaces {

SoleOwners::SoleOwners(const RectilinearGrid& grid, const SiteValues& values)
    : sites_(grid),
      values_(values),
      n_{grid.sites(0), grid.sites(1), grid.sites(2)},
      greatest_(grid.site_count(), kEmpty),
      has_region_(values.has_regions() ? grid.site_count() : 0, 0) {
  parallel_for(greatest_.size(), 1 << 14, [&](std::size_t site) { find_greatest(site); });
}

void SoleOwners::find_greatest(std::size_t site) {
  const std::span<const SiteValues::Entry> own = values_.at(site);
  if (own.empty()) return;
  double most = own[0].value;
  std::uint16_t number = own[0].material;
  for (std::size_t e = 1; e < own.size(); ++e) {
    if (own[e].value < most) continue;
    number = own[e].value > most ? own[e].material : kNone;
    most = own[e].value;
  }
  // The two greatest numbers have a meaning of their own here.
  greatest_[site] = number < kEmpty ? number : kNone;
  if (has_region_.empty()) return;
  for (const SiteValues::Entry& entry : own) {
    if (values_.material_number(entry.material) != entry.material) has_region_[site] = 1;
  }
}

std::uint16_t SoleOwners::owner(std::size_t site) const {
  const std::uint16_t number = greatest_[site];
  if (number >= kEmpty) return kNone;
  const std::array<std::size_t, 3> p = sites_.indices(site);
  for (std::size_t a = 0; a < 3; ++a) {
    if (p[a] == 0 || p[a] + 1 == n_[a]) return kNone;
  }
  // If a material has regions near the site, it has no value of its own in the cell, but those of its
  // regions.
  const bool is_whole = !has_region_.empty() && values_.material_number(number) == number;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t row = site - 1 + n_[0] * (j + n_[1] * k) - n_[0] * (1 + n_[1]);
      for (std::size_t other = row; other < row + 3; ++other) {
        if (greatest_[other] != number && greatest_[other] != kEmpty) return kNone;
        if (is_whole && has_region_[other] != 0) return kNone;
      }
    }
  }
  return number;
}

double SoleOwners::greatest_difference(std::size_t site, std::uint16_t owner) const {
  const std::uint16_t whole = values_.material_number(owner);
  double own = 0, others = 0;
  for (const SiteValues::Entry& entry : values_.at(site)) {
    double& most = values_.material_number(entry.material) == whole ? own : others;
    most = std::max(most, static_cast<double>(entry.fraction));
  }
  return std::max(std::abs(1 - own), others);
}

}  // namespace adamas::interfaces
