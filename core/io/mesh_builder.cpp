#include "core/io/mesh_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace adamas::io {

const CellFaces kTetrahedronFaces{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
const CellFaces kPyramidFaces{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
const CellFaces kWedgeFaces{{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
const CellFaces kHexahedronFaces{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                 {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

std::optional<std::uint32_t> PointMerger::find(const Vec3& p) const {
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
  return {};
}

std::uint32_t PointMerger::number(const Vec3& p) {
  if (const auto known = find(p)) return *known;
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
  if (first + points.size() > std::numeric_limits<std::uint32_t>::max())
    fail("expected a mesh with fewer than {} points of faces, found more",
         std::numeric_limits<std::uint32_t>::max());
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

bool end_cell(MeshFile& file) {
  const std::size_t first = file.cell_ends.empty() ? 0 : file.cell_ends.back(),
                    begin = first == 0 ? 0 : file.face_ends[first - 1];
  std::vector<std::vector<std::uint32_t>> faces, sorted;
  for (std::size_t f = first, at = begin; f < file.face_ends.size(); at = file.face_ends[f++]) {
    std::vector<std::uint32_t> points(
        file.face_points.begin() + static_cast<std::ptrdiff_t>(at),
        file.face_points.begin() + static_cast<std::ptrdiff_t>(file.face_ends[f]));
    std::vector<std::uint32_t> order = points;
    std::ranges::sort(order);
    const auto twin = std::ranges::find(sorted, order);
    if (twin == sorted.end()) {
      faces.push_back(std::move(points));
      sorted.push_back(std::move(order));
      continue;
    }
    faces.erase(faces.begin() + (twin - sorted.begin()));
    sorted.erase(twin);
  }
  const bool stays = faces.size() >= (file.flat ? 1u : 4u);
  if (stays && faces.size() == file.face_ends.size() - first) {
    file.cell_ends.push_back(static_cast<std::uint32_t>(file.face_ends.size()));
    return true;
  }
  file.face_points.resize(begin);
  file.face_ends.resize(first);
  if (!stays) return false;
  for (const auto& points : faces) append_face(points, file);
  file.cell_ends.push_back(static_cast<std::uint32_t>(file.face_ends.size()));
  return true;
}

}  // namespace adamas::io
