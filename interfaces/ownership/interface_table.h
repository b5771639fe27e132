#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/typed_id.h"

namespace adamas {

/// Which bodies touch, and what they are made of. Interfaces are numbered by their pair of bodies, smaller
/// first.
class InterfaceTable {
 public:
  InterfaceTable() = default;
  InterfaceTable(IdVector<BodyId, MaterialId> body_materials,
                 IdVector<InterfaceId, std::array<BodyId, 2>> sides);

  [[nodiscard]] std::size_t body_count() const { return body_materials_.size(); }
  [[nodiscard]] std::size_t interface_count() const { return sides_.size(); }
  [[nodiscard]] MaterialId material(BodyId body) const { return body_materials_[body]; }
  /// The two bodies of an interface; signed distances are positive towards the first.
  [[nodiscard]] const std::array<BodyId, 2>& sides(InterfaceId i) const { return sides_[i]; }
  /// The interface between two bodies, if they touch.
  [[nodiscard]] std::optional<InterfaceId> find(BodyId a, BodyId b) const;
  /// Neighbours of a body, by id, and the interfaces with them.
  [[nodiscard]] const std::vector<std::pair<BodyId, InterfaceId>>& neighbours(BodyId body) const {
    return neighbours_[body];
  }

 private:
  IdVector<BodyId, MaterialId> body_materials_;
  IdVector<InterfaceId, std::array<BodyId, 2>> sides_;
  IdVector<BodyId, std::vector<std::pair<BodyId, InterfaceId>>> neighbours_;
};

}  // namespace adamas
