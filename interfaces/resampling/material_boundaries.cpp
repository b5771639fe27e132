#include "interfaces/resampling/material_boundaries.h"

#include <algorithm>
#include <utility>

#include "core/base/sort_unique.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

using Sides = std::array<MaterialId, 2>;

IdVector<InterfaceId, std::array<std::uint32_t, 2>> parts_of_groups(const IdVector<InterfaceId, Sides>& sides,
                                                                    const MaterialParts& parts) {
  IdVector<InterfaceId, std::array<std::uint32_t, 2>> result;
  for (const auto& [front, back] : sides) result.push_back({parts.part_of[front], parts.part_of[back]});
  return result;
}

}  // namespace

MaterialBoundaries::MaterialBoundaries(const InterfaceMesh& mesh, const MaterialParts& parts,
                                       bool with_lines) {
  IdVector<InterfaceId, Sides> sides;
  for (const InterfaceTriangle& t : mesh.triangles) {
    if (sides.empty() || sides.back() != Sides{t.front, t.back}) sides.push_back({t.front, t.back});
  }
  sort_unique(sides);
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  group_of_.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    const auto found = std::lower_bound(sides.begin(), sides.end(), Sides{t.front, t.back});
    group_of_.push_back(InterfaceId(static_cast<std::size_t>(found - sides.begin())));
    triangles.push_back(t.points);
  }
  parts_of_group_ = parts_of_groups(sides, parts);
  std::vector<std::vector<std::uint32_t>> sets(parts.count);
  for (InterfaceId g(0); g.value < sides.size(); ++g.value) {
    const auto& [front, back] = parts_of_group_[g];
    sets[front].push_back(g.value);
    if (back != front) sets[back].push_back(g.value);
  }
  const ClosestPointForest forest(
      mesh.points, std::move(triangles), sides.size(), [this](std::uint32_t t) { return group_of_[t].value; },
      sets);
  all_ = forest.all();
  for (std::size_t p = 0; p < parts.count; ++p) trees_.push_back(forest.set(p));
  add_lines(sides, with_lines);
}

MaterialBoundaries::MaterialBoundaries(std::shared_ptr<const InterfaceNetwork> network,
                                       const MaterialParts& parts, bool with_lines)
    : network_(std::move(network)), all_(network_->tree()) {
  const InterfaceTable& table = network_->table();
  IdVector<InterfaceId, Sides> sides;
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value) {
    const auto& [front, back] = table.sides(i);
    sides.push_back({table.material(front), table.material(back)});
  }
  parts_of_group_ = parts_of_groups(sides, parts);
  trees_.assign(parts.count, all_);
  for (MaterialId m(0); m.value < parts.part_of.size() && parts.count > 1; ++m.value) {
    if (parts.part_of[m] != MaterialParts::kNoPart) trees_[parts.part_of[m]] = network_->tree(m);
  }
  add_lines(sides, with_lines);
}

/// Adds the tree of the junction lines. `sides`: the materials of each group.
void MaterialBoundaries::add_lines(const IdVector<InterfaceId, Sides>& sides, bool with_lines) {
  std::vector<ClosestPointTree::Triangle> lines;
  if (with_lines) {
    const auto triangle_at = [&](std::uint32_t t) {
      const auto& [front, back] = sides[groups()[t]];
      return InterfaceTriangle{all_.triangles()[t], front, back};
    };
    for (const auto& [a, b] : junction_lines(all_.points().size(), all_.triangles().size(), triangle_at))
      lines.push_back({a, b, b});
  }
  trees_.emplace_back(all_.points(), lines);
}

}  // namespace adamas::interfaces
