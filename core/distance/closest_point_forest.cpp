#include "core/distance/closest_point_forest.h"

#include <numeric>
#include <utility>

namespace adamas::inline core {

ClosestPointForest::ClosestPointForest(std::vector<Vec3> points, std::vector<Triangle> triangles,
                                       std::size_t groups,
                                       const std::function<std::uint32_t(std::uint32_t)>& group_of,
                                       std::vector<std::vector<std::uint32_t>> sets)
    : groups_(groups) {
  auto hierarchy = std::make_shared<TriangleHierarchy>();
  hierarchy->points = std::move(points);
  hierarchy->triangles = std::move(triangles);
  sets.emplace_back(groups);
  std::iota(sets.back().begin(), sets.back().end(), 0u);
  const auto roots = build_nodes(*hierarchy, groups, group_of, sets);
  hierarchy_ = hierarchy;

  std::vector<std::size_t> counts(groups, 0);
  std::vector<Box3> boxes(groups);
  for (std::uint32_t t = 0; t < hierarchy->triangles.size(); ++t) {
    const std::uint32_t group = group_of ? group_of(t) : 0;
    ++counts[group];
    for (const Vec3& p : hierarchy->corners(t)) boxes[group].extend(p);
  }
  trees_.reserve(roots.size());
  for (std::size_t g = 0; g < groups; ++g)
    trees_.push_back(ClosestPointTree(hierarchy_, roots[g], counts[g], boxes[g]));
  for (std::size_t s = 0; s < sets.size(); ++s) {
    std::size_t count = 0;
    Box3 box;
    for (const std::uint32_t g : sets[s]) {
      if (counts[g] == 0) continue;
      count += counts[g];
      box.extend(boxes[g].min);
      box.extend(boxes[g].max);
    }
    trees_.push_back(ClosestPointTree(hierarchy_, roots[groups + s], count, box));
  }
}

}  // namespace adamas::inline core
