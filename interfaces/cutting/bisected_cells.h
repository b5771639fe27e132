#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/cell_locator.h"

namespace adamas::interfaces {

/// The cells of a resampled mesh, bisected further at their longest edges until each edge changes its owner
/// at most once and every body in a cell owns one of its corners, except for parts that are small relative to
/// the cell or smaller than a tolerance. The mesh stays conforming, and interfaces do not move: a part of a
/// cell uses the functions of the whole cell.
class BisectedCells {
 public:
  struct Cell {
    std::array<std::uint32_t, 4> vertices;  ///< positively oriented
    std::uint32_t origin;                   ///< the cell of the resampled mesh
    std::array<Weights, 4> corners;         ///< the vertices in barycentric coordinates of that cell
  };

  /// `tolerance`: a length. The mesh must outlive this object.
  BisectedCells(const ResampledMesh& mesh, double tolerance, Progress& progress);

  [[nodiscard]] const ResampledMesh& mesh() const { return mesh_; }
  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  /// Returns the owner of each point.
  [[nodiscard]] const std::vector<BodyId>& owners() const { return owners_; }
  /// Returns the leaves and the cells that have been bisected.
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
  [[nodiscard]] bool is_leaf(std::size_t cell) const { return is_bisected_[cell] == 0; }
  /// Bisects cells of several bodies that hold these points, down to half their size, unless they are about
  /// as small as the tolerance. Returns whether any cell was bisected.
  bool bisect_at(const std::vector<Vec3>& places, Progress& progress);
  /// Returns the point at which an edge changes its owner, as the weight, in (0, 1), of its vertex with the
  /// higher number; one half for an edge with one owner.
  [[nodiscard]] double owner_change(std::uint32_t a, std::uint32_t b) const;
  /// Returns the ownership problem of the mesh's cell of which a cell of several bodies is a part.
  [[nodiscard]] const OwnershipProblem& problem(const Cell& cell) const { return problems_.at(cell.origin); }

 private:
  struct Edge {
    double owner_change = 0.5;
    double hidden = 0;  ///< the length that belongs neither to the first nor to the last owner
  };

  void find_owners();
  [[nodiscard]] double size(const Cell& cell) const;
  [[nodiscard]] bool may_be_bisected(const Cell& cell) const;
  void bisect_where_needed(std::vector<std::uint32_t> wanted, Progress& progress);
  void examine_edges(const Cell& cell);
  [[nodiscard]] Edge examine_edge(const OwnershipProblem& problem, const Cell& cell, std::size_t i,
                                  std::size_t j) const;
  /// Returns whether two bodies touch in a cell of the mesh.
  [[nodiscard]] bool touch(std::uint32_t origin, BodyId a, BodyId b);
  [[nodiscard]] bool hides_body(const Cell& cell) const;
  [[nodiscard]] bool needs_bisection(std::uint32_t cell);
  [[nodiscard]] std::array<std::size_t, 2> longest_edge(const Cell& cell) const;
  void cells_at_edge(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& result) const;
  void bisect(std::uint32_t cell);
  void bisect_edge(std::uint32_t a, std::uint32_t b, const std::vector<std::uint32_t>& cells);

  const ResampledMesh& mesh_;
  CellLocator locator_;
  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<BodyId> owners_;
  std::vector<Cell> cells_;
  std::vector<char> is_bisected_;                     ///< by cell: whether it has been bisected
  std::vector<std::vector<std::uint32_t>> cells_at_;  ///< by vertex; ascending
  std::unordered_map<std::uint64_t, Edge> edges_;     ///< the edges in cells of several bodies
  std::unordered_map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>> contacts_;
  /// The problems of the mesh's cells of several bodies.
  std::unordered_map<std::uint32_t, OwnershipProblem> problems_;
};

}  // namespace adamas::interfaces
