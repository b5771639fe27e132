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
/// its longest edge, and diamonds are what is cut at the same point. Knows nothing of the library's tables.
class BisectionReference {
 public:
  /// `generations` rounds of bisection of a x b x c root cubes of side 2^kRootBits.
  BisectionReference(std::array<int, 3> roots, int generations);

  /// By split vertex: those bisected in the rounds, and those that would be in the next one.
  [[nodiscard]] const std::map<LatticePoint, ReferenceDiamond>& diamonds() const { return diamonds_; }
  /// The mesh after all rounds.
  [[nodiscard]] const std::vector<ReferenceTetrahedron>& mesh() const { return mesh_; }

 private:
  std::map<LatticePoint, ReferenceDiamond> diamonds_;
  std::vector<ReferenceTetrahedron> mesh_;
};

/// A tetrahedron's corners in ascending order.
ReferenceTetrahedron sorted(ReferenceTetrahedron t);
/// Indices of the ends of the longest edge, in lattice units.
std::array<std::size_t, 2> longest_edge(const ReferenceTetrahedron& t);
LatticePoint midpoint(LatticePoint a, LatticePoint b);

}  // namespace adamas::test
