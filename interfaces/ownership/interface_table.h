#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/typed_id.h"

namespace adamas::interfaces {

/// The material of each body and the interfaces between bodies that touch. Interfaces are numbered in the
/// order of their pairs of bodies, of which the lower one is the first.
class InterfaceTable {
 public:
  InterfaceTable() = default;
  InterfaceTable(IdVector<BodyId, MaterialId> body_materials,
                 IdVector<InterfaceId, std::array<BodyId, 2>> sides);

  [[nodiscard]] std::size_t body_count() const { return body_materials_.size(); }
  [[nodiscard]] std::size_t interface_count() const { return sides_.size(); }
  [[nodiscard]] MaterialId material(BodyId body) const { return body_materials_[body]; }
  [[nodiscard]] const IdVector<BodyId, MaterialId>& body_materials() const { return body_materials_; }
  /// Returns the two bodies of an interface; signed distances are positive towards the first.
  [[nodiscard]] const std::array<BodyId, 2>& sides(InterfaceId i) const { return sides_[i]; }
  /// Returns the interface between two bodies, if they touch.
  [[nodiscard]] std::optional<InterfaceId> find(BodyId a, BodyId b) const;
  /// Returns the neighbours of a body, by id, and the interfaces with them.
  [[nodiscard]] const std::vector<std::pair<BodyId, InterfaceId>>& neighbours(BodyId body) const {
    return neighbours_[body];
  }

 private:
  IdVector<BodyId, MaterialId> body_materials_;
  IdVector<InterfaceId, std::array<BodyId, 2>> sides_;
  IdVector<BodyId, std::vector<std::pair<BodyId, InterfaceId>>> neighbours_;
};

inline InterfaceTable::InterfaceTable(IdVector<BodyId, MaterialId> body_materials,
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

inline std::optional<InterfaceId> InterfaceTable::find(BodyId a, BodyId b) const {
  if (neighbours_[b].size() < neighbours_[a].size()) std::swap(a, b);
  const auto& list = neighbours_[a];
  const auto found = std::lower_bound(list.begin(), list.end(), std::pair(b, InterfaceId(0)));
  if (found == list.end() || found->first != b) return std::nullopt;
  return found->second;
}

}  // namespace adamas::interfaces
