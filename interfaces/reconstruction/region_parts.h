#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// The parts of materials' regions, as disjoint sets that become bodies. A part holds lattice points and has
/// their number, or the number of their run (LabelRuns); an inner part, which lies inside tetrahedra and
/// holds no lattice point, has a number above all those.
class RegionParts {
 public:
  using Part = std::uint32_t;

  RegionParts() = default;
  /// `parents`: by part that is no inner one, a part with the same or a lower number that it is joined to.
  /// `material_of`: the material of such a part.
  RegionParts(std::vector<Part> parents, std::function<MaterialId(Part)> material_of)
      : parent_(std::move(parents)), material_of_(std::move(material_of)) {}

  [[nodiscard]] bool is_inner(Part part) const { return part >= parent_.size(); }
  [[nodiscard]] MaterialId material_of(Part part) const;
  Part find(Part part);
  void join(Part a, Part b);

  /// Adds inner parts, in any order and more than once, before settle() is called.
  void add_inner(const std::vector<std::pair<Part, MaterialId>>& parts) {
    inner_parts_.insert(inner_parts_.end(), parts.begin(), parts.end());
  }
  /// Drops inner parts that no triangle touches: they own nothing. Triangles with one material on both sides,
  /// which remain where welding has closed a thin part, are dropped too, and the parts on their sides are
  /// joined. `front` and `back` of triangles are parts.
  void settle(InterfaceMesh& mesh);
  /// Joins parts of one material that meet at an edge with nothing between them.
  void join_round_edges(const InterfaceMesh& mesh, const Box3& domain);

  /// The bodies that parts belong to, in the order of their first parts.
  struct Bodies {
    IdVector<BodyId, MaterialId> materials;
    std::vector<BodyId> of_part;
    std::unordered_map<Part, BodyId> of_inner_part;
    [[nodiscard]] bool is_inner(Part part) const { return part >= of_part.size(); }
    [[nodiscard]] BodyId of(Part part) const {
      return part < of_part.size() ? of_part[part] : of_inner_part.at(part);
    }
    /// Changes the parts on the sides of triangles to materials, and returns the bodies there.
    [[nodiscard]] std::vector<std::array<BodyId, 2>> name_sides(
        std::vector<InterfaceTriangle>& triangles) const;
  };
  /// Numbers the bodies.
  [[nodiscard]] Bodies bodies();

 private:
  std::vector<std::uint64_t> loose_edges(const InterfaceMesh& mesh);

  std::vector<Part> parent_;
  std::function<MaterialId(Part)> material_of_;
  std::unordered_map<Part, Part> inner_parents_;
  std::vector<std::pair<Part, MaterialId>> inner_parts_;  ///< in the order of their numbers
};

/// Removes points without triangles, which are on contacts of a material with itself.
void drop_unused_points(InterfaceMesh& mesh);

}  // namespace adamas::interfaces
