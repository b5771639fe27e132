#include "interfaces/mesh_reconstruction/mesh_held_cells.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"

namespace adamas::interfaces {

namespace {

using Entry = MeshValues::Entry;

}  // namespace

MeshHeldCells::MeshHeldCells(const MeshValues& values, const std::function<bool(const Place&)>& chooses)
    : values_(values),
      place_of_cell_(values.subdivision().mesh().cell_count(), kNone),
      firsts_(first_active_entries(values)) {
  const PolyhedralMesh& mesh = values.subdivision().mesh();
  const std::vector<Index>& active = values.active_cells();
  for (std::uint32_t n = 0; n < active.size(); ++n) place_of_cell_[active[n]] = n;
  const auto holds = [&](const Place& place, const Entry& entry) {
    return entry.fraction > kFractionTrace && (!chooses || chooses(place));
  };
  DisjointSets sets(firsts_.back());
  std::vector<std::uint32_t> first_of_material(values.material_count());
  for (std::size_t p = 0; p < mesh.points().size(); ++p) {
    std::ranges::fill(first_of_material, kNone);
    for (const Index c : mesh.cells_round(p)) {
      if (place_of_cell_[c] == kNone) continue;
      const std::span<const Entry> own = values.at(c);
      for (std::uint32_t e = 0; e < own.size(); ++e) {
        if (!holds({place_of_cell_[c], e}, own[e])) continue;
        std::uint32_t& first = first_of_material[values.whole(own[e].material)];
        const std::uint32_t here = firsts_[place_of_cell_[c]] + e;
        if (first == kNone) first = here;
        sets.join(first, here);
      }
    }
  }
  const std::vector<std::uint32_t> roots = std::move(sets).roots();
  group_.assign(firsts_.back(), kNone);
  std::vector<std::uint32_t> counts;
  const auto for_each_held = [&](const auto& visit) {
    for (std::uint32_t n = 0; n < active.size(); ++n) {
      const std::span<const Entry> own = values.at(active[n]);
      for (std::uint32_t e = 0; e < own.size(); ++e) {
        if (holds({n, e}, own[e])) visit(Place{n, e}, firsts_[n] + e);
      }
    }
  };
  for_each_held([&](const Place&, std::uint32_t at) {
    std::uint32_t& of_root = group_[roots[at]];
    if (of_root == kNone) {
      of_root = static_cast<std::uint32_t>(counts.size());
      counts.push_back(0);
    }
    group_[at] = of_root;
    ++counts[of_root];
  });
  first_places_.push_back(0);
  for (const std::uint32_t count : counts) first_places_.push_back(first_places_.back() + count);
  places_.resize(first_places_.back());
  std::vector<std::uint32_t> next(first_places_.begin(), first_places_.end() - 1);
  for_each_held([&](const Place& place, std::uint32_t at) { places_[next[group_[at]]++] = place; });
}

std::uint32_t MeshHeldCells::group(Index cell, std::uint16_t material) const {
  const std::uint32_t n = place_of_cell_[cell];
  if (n == kNone) return kNone;
  const std::span<const Entry> own = values_.at(cell);
  const auto found = std::ranges::find(own, material, &Entry::material);
  return found == own.end() ? kNone : group_[firsts_[n] + static_cast<std::uint32_t>(found - own.begin())];
}

}  // namespace adamas::interfaces
