#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace adamas::inline core {

/// A named part of a mesh that a file has beside its cells: a side set, which consists of sides of cells, or
/// a node set. Sides are faces, or edges where cells are flat.
struct MeshSet {
  std::string name;
  bool of_nodes = false;
  /// The numbers of points: of the sides, one after the other, each in order round it; or of a node set.
  std::vector<std::uint32_t> points{};
  std::vector<std::uint32_t> side_ends{};  ///< where each side ends in `points`; empty for a node set

  /// The number of sides, or of nodes.
  [[nodiscard]] std::size_t size() const { return of_nodes ? points.size() : side_ends.size(); }
  [[nodiscard]] std::span<const std::uint32_t> side(std::size_t n) const {
    const std::size_t begin = n == 0 ? 0 : side_ends[n - 1];
    return std::span(points).subspan(begin, side_ends[n] - begin);
  }
  void add_side(std::span<const std::uint32_t> side) {
    points.insert(points.end(), side.begin(), side.end());
    side_ends.push_back(static_cast<std::uint32_t>(points.size()));
  }
};

}  // namespace adamas::inline core
