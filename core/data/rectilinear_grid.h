#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// Where the values of a grid live.
enum class Centering { kCells, kPoints };

/// A rectilinear grid: ascending node coordinates per axis. Its *sites* are what values belong to: the cell
/// centres or the nodes. Sites are numbered x fastest.
struct RectilinearGrid {
  std::array<std::vector<double>, 3> nodes;
  Centering centering = Centering::kCells;

  /// Number of sites along an axis.
  [[nodiscard]] std::size_t sites(int axis) const {
    const std::size_t n = nodes[static_cast<std::size_t>(axis)].size();
    return centering == Centering::kPoints || n == 0 ? n : n - 1;
  }
  [[nodiscard]] std::size_t site_count() const { return sites(0) * sites(1) * sites(2); }
  [[nodiscard]] std::size_t site_index(std::size_t i, std::size_t j, std::size_t k) const {
    return i + sites(0) * (j + sites(1) * k);
  }
  /// Coordinate of site i along an axis.
  [[nodiscard]] double site_coordinate(int axis, std::size_t i) const {
    const auto& n = nodes[static_cast<std::size_t>(axis)];
    return centering == Centering::kPoints ? n[i] : 0.5 * (n[i] + n[i + 1]);
  }
  [[nodiscard]] Vec3 site(std::size_t i, std::size_t j, std::size_t k) const {
    return {site_coordinate(0, i), site_coordinate(1, j), site_coordinate(2, k)};
  }
  /// The box spanned by the nodes.
  [[nodiscard]] Box3 domain() const {
    return {{nodes[0].front(), nodes[1].front(), nodes[2].front()},
            {nodes[0].back(), nodes[1].back(), nodes[2].back()}};
  }
  /// The least distance of neighbouring nodes along any axis.
  [[nodiscard]] double least_spacing() const;
  /// Volume that site (i, j, k) stands for: its cell, or the part of the domain nearer to it than to other
  /// sites along each axis.
  [[nodiscard]] double site_volume(std::size_t i, std::size_t j, std::size_t k) const;
};

}  // namespace adamas
