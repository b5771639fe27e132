#include "interfaces/reconstruction/held_cells.h"

#include "core/base/loop_progress.h"

namespace adamas::interfaces {

HeldCells::HeldCells(const MultiMaterialData& data, const SiteValues& values)
    : sites_(data.grid), values_(values), group_of_(values.entries().size(), kNone) {}

const SiteValues::Entry* HeldCells::find(std::size_t site, MaterialId material) const {
  const SiteValues::Entry* found = nullptr;
  for (const SiteValues::Entry& entry : values_.at(site)) {
    if (values_.material(entry.material) == material && entry.fraction > kFractionTrace &&
        (found == nullptr || entry.fraction > found->fraction))
      found = &entry;
  }
  return found;
}

std::uint32_t HeldCells::group(std::size_t site, MaterialId material) const {
  const SiteValues::Entry* entry = find(site, material);
  return entry == nullptr ? kNone : group_of_[index(entry)];
}

void HeldCells::collect(std::size_t site, MaterialId material,
                        std::vector<std::pair<std::size_t, double>>& cells) {
  const SiteValues::Entry* first = find(site, material);
  cells.assign(1, {site, static_cast<double>(first->fraction)});
  group_of_[index(first)] = groups_;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    if (next > 0) LoopProgress::check_step(next);
    sites_.for_each_neighbour(cells[next].first, [&](std::size_t other, int, int, int) {
      const SiteValues::Entry* entry = find(other, material);
      if (entry == nullptr || group_of_[index(entry)] != kNone) return;
      group_of_[index(entry)] = groups_;
      cells.emplace_back(other, static_cast<double>(entry->fraction));
    });
  }
  ++groups_;
}

}  // namespace adamas::interfaces
