#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Walls of a mesh: materials that fill each cell that holds them, as a mould does. What the others would be
/// there nobody knows, so that their steps and gradients are those of the other cells alone
/// (docs/method.md, Any mesh).
class MeshWalls {
 public:
  using Index = MeshSubdivision::Index;
  MeshWalls() = default;  ///< no walls
  explicit MeshWalls(const MeshValues& values);

  /// Whether there is a wall and a material that is none in a mixed cell.
  [[nodiscard]] bool any() const { return any_; }
  /// Whether a wall fills a cell.
  [[nodiscard]] bool fills(Index cell) const { return any_ && filled_[cell] != 0; }
  /// Keeps the values of walls as distances from their faces.
  void keep_distances(const MeshValues& values);
  /// Continues the values of the other materials into walls, and sets those of walls so that these own what
  /// lies behind their faces, whatever the others' values are.
  void set_values(MeshValues& values) const;

 private:
  bool any_ = false;
  std::vector<char> is_wall_;      // by number of a material
  std::vector<char> filled_;       // by cell
  std::vector<double> distances_;  // of walls, by entry of active cells
};

}  // namespace adamas::interfaces
