#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "core/lattice/lattice_point.h"

namespace adamas::test {

/// The corners of a tetrahedron in ascending order.
using ReferenceTetrahedron = std::array<LatticePoint, 4>;

/// All tetrahedra that are bisected at one point.
struct ReferenceDiamond {
  int phase = 0, level = 0;
  std::array<LatticePoint, 2> split_edge{};  ///< in ascending order
  std::set<ReferenceTetrahedron> tetrahedra;
  std::set<LatticePoint> children, parents;
};

/// Uniform bisection by brute force: tetrahedra are plain lists of corners, each is cut at the midpoint of
/// its longest edge, and a diamond is the set of tetrahedra that are cut at the same point. It uses none of
/// the library's tables.
class BisectionReference {
 public:
  /// Bisects a x b x c root cubes of side 2^kRootBits in `generations` rounds.
  BisectionReference(std::array<int, 3> roots, int generations);

  /// Returns the diamonds by split vertex: those bisected in the rounds, and those that would be bisected in
  /// the next one.
  [[nodiscard]] const std::map<LatticePoint, ReferenceDiamond>& diamonds() const { return diamonds_; }
  /// Returns the mesh after all rounds.
  [[nodiscard]] const std::vector<ReferenceTetrahedron>& mesh() const { return mesh_; }

 private:
  std::map<LatticePoint, ReferenceDiamond> diamonds_;
  std::vector<ReferenceTetrahedron> mesh_;
};

/// Returns a tetrahedron's corners in ascending order.
ReferenceTetrahedron sorted(ReferenceTetrahedron t);
/// Returns the indices of the ends of the longest edge; lengths are in lattice units.
std::array<std::size_t, 2> longest_edge(const ReferenceTetrahedron& t);
LatticePoint midpoint(LatticePoint a, LatticePoint b);

}  // namespace adamas::test
