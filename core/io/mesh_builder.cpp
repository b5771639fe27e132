#include "core/io/mesh_builder.h"

#include <bit>
#include <cmath>

namespace adamas::io {

std::uint32_t PointMerger::number(const Vec3& p) {
  const double reach = 0.25 * cell_;
  for (const double x : {p.x - reach, p.x + reach}) {
    for (const double y : {p.y - reach, p.y + reach}) {
      for (const double z : {p.z - reach, p.z + reach}) {
        const auto [begin, end] = places_.equal_range(key({x, y, z}));
        for (auto at = begin; at != end; ++at) {
          if (distance(points_[at->second], p) <= reach) return at->second;
        }
      }
    }
  }
  const auto number = static_cast<std::uint32_t>(points_.size());
  places_.emplace(key(p), number);
  points_.push_back(p);
  return number;
}

/// Returns a number for the box of the size `cell_` that holds a place.
std::uint64_t PointMerger::key(const Vec3& p) const {
  std::uint64_t result = 0;
  for (int axis = 0; axis < 3; ++axis) {
    // The sum with 0 makes one zero of both.
    const double place = std::floor(p[axis] / cell_) + 0.0;
    result = (result ^ std::bit_cast<std::uint64_t>(place)) * 0x9e3779b97f4a7c15ull;
    result ^= result >> 29;
  }
  return result;
}

void append_face(std::span<const std::uint32_t> points, MeshFile& file) {
  const std::size_t first = file.face_points.size();
  for (const std::uint32_t p : points) {
    if (file.face_points.size() == first || file.face_points.back() != p) file.face_points.push_back(p);
  }
  while (file.face_points.size() > first + 1 && file.face_points.back() == file.face_points[first])
    file.face_points.pop_back();
  if (file.face_points.size() < first + 3) {
    file.face_points.resize(first);
    return;
  }
  file.face_ends.push_back(static_cast<std::uint32_t>(file.face_points.size()));
}

}  // namespace adamas::io
