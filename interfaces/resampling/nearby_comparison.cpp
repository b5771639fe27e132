#include "interfaces/resampling/nearby_comparison.h"

#include "interfaces/resampling/far_points.h"

namespace adamas::interfaces {

namespace {

/// Returns sample points of lines in a box that are farther than `target` from others.
std::vector<Vec3> far_points_in(const Box3& box, const ClosestPointTree& lines,
                                const ClosestPointTree& others, double target) {
  std::vector<Vec3> result;
  std::vector<std::uint32_t> found;
  lines.overlapping(box, found);
  for (const std::uint32_t line : found) {
    const auto [a, b, end] = lines.triangle(line);
    for_each_sample(a, b, target, [&](const Vec3& p) {
      if (box.contains(p) && !others.is_within(p, target)) result.push_back(p);
    });
  }
  return result;
}

}  // namespace

NearbyComparison::NearbyComparison(const InterfaceComparison& comparison, const InterfaceMesh& shown)
    : comparison_(comparison), shown_(shown, comparison.parts(), comparison.knows_junctions()) {}

bool NearbyComparison::has_far_point(std::uint32_t triangle, const Tetrahedron& cell) const {
  const MaterialBoundaries& input = comparison_.input();
  const auto& [front, back] = input.parts_of(triangle);
  const auto is_far_from = [&](std::uint32_t part) {
    return has_far_point_in(cell, input.all().triangle(triangle), shown_.tree(part), comparison_.target());
  };
  return is_far_from(front) || (back != front && is_far_from(back));
}

std::vector<Vec3> NearbyComparison::far_input_junctions(const Box3& box) const {
  return far_points_in(box, comparison_.input().lines(), shown_.lines(), comparison_.target());
}

std::vector<Vec3> NearbyComparison::far_shown_junctions(const Box3& box) const {
  return far_points_in(box, shown_.lines(), comparison_.input().lines(), comparison_.target());
}

}  // namespace adamas::interfaces
