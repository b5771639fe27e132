#include "interfaces/ownership/interface_table.h"

#include <algorithm>

namespace adamas {

InterfaceTable::InterfaceTable(IdVector<BodyId, MaterialId> body_materials,
                               IdVector<InterfaceId, std::array<BodyId, 2>> sides)
    : body_materials_(std::move(body_materials)),
      sides_(std::move(sides)),
      neighbours_(body_materials_.size()) {
  for (InterfaceId i(0); i.value < sides_.size(); ++i.value) {
    const auto& [a, b] = sides_[i];
    neighbours_[a].emplace_back(b, i);
    neighbours_[b].emplace_back(a, i);
  }
  for (auto& list : neighbours_) std::sort(list.begin(), list.end());
}

std::optional<InterfaceId> InterfaceTable::find(BodyId a, BodyId b) const {
  if (neighbours_[b].size() < neighbours_[a].size()) std::swap(a, b);
  const auto& list = neighbours_[a];
  const auto found = std::lower_bound(list.begin(), list.end(), std::pair(b, InterfaceId(0)));
  if (found == list.end() || found->first != b) return std::nullopt;
  return found->second;
}

}  // namespace adamas
