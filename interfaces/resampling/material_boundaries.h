#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_forest.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The part of each material among the boundaries that are compared. Two materials that share all their
/// triangles have one part; those without interfaces have none (kNoPart).
struct MaterialParts {
  static constexpr std::uint32_t kNoPart = 0xffffffffu;
  IdVector<MaterialId, std::uint32_t> part_of;
  std::size_t count = 0;
};

/// The interfaces of the input or of a mesh in trees: the boundary of each part, all of them together, and
/// the junction lines, where at least three materials meet, as triangles whose last two points are equal. The
/// boundaries share their triangles.
class MaterialBoundaries {
 public:
  MaterialBoundaries() = default;
  /// The boundaries of a welded mesh. `with_lines`: whether junction lines are found.
  MaterialBoundaries(const InterfaceMesh& mesh, const MaterialParts& parts, bool with_lines);
  /// The boundaries of a network, whose trees are used.
  MaterialBoundaries(std::shared_ptr<const InterfaceNetwork> network, const MaterialParts& parts,
                     bool with_lines);

  /// Returns the tree of all triangles; in all trees but that of lines they have the numbers of the mesh.
  [[nodiscard]] const ClosestPointTree& all() const { return all_; }
  /// Returns the number of trees: those of the parts, and that of the junction lines, which is the last one.
  [[nodiscard]] std::size_t size() const { return trees_.size(); }
  [[nodiscard]] const ClosestPointTree& tree(std::size_t part) const { return trees_[part]; }
  [[nodiscard]] const ClosestPointTree& lines() const { return trees_.back(); }
  /// Returns the parts in front of a triangle and behind it.
  [[nodiscard]] const std::array<std::uint32_t, 2>& parts_of(std::uint32_t triangle) const {
    return parts_of_group_[groups()[triangle]];
  }

 private:
  [[nodiscard]] std::span<const InterfaceId> groups() const {
    return network_ ? network_->interfaces_of_triangles() : std::span<const InterfaceId>(group_of_);
  }
  void add_lines(const IdVector<InterfaceId, std::array<MaterialId, 2>>& sides, bool with_lines);

  std::shared_ptr<const InterfaceNetwork> network_;  ///< null if these are the boundaries of a mesh
  std::vector<InterfaceId> group_of_;                ///< by triangle; empty if the network has its groups
  IdVector<InterfaceId, std::array<std::uint32_t, 2>> parts_of_group_;
  ClosestPointTree all_;
  std::vector<ClosestPointTree> trees_;
};

}  // namespace adamas::interfaces
