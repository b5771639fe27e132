#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "tests/support/ownership_problems.h"

namespace adamas::test {

using namespace interfaces;

/// The cells of a mesh, for questions that are answered by a look at every one of them.
struct MeshCells {
  explicit MeshCells(const ResampledMesh& mesh) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      frames.emplace_back(mesh.corners(c));
      owners.emplace_back();
      mesh.ownership(c, owners.back());
    }
  }

  /// Returns the cell that holds a point.
  [[nodiscard]] std::size_t find(const Vec3& p) const {
    std::size_t best = 0;
    double inside = -1e300;
    for (std::size_t c = 0; c < frames.size(); ++c) {
      const Weights w = frames[c].weights(p);
      const double least = std::min({w[0], w[1], w[2], w[3]});
      if (least > inside) inside = least, best = c;
    }
    return best;
  }

  /// Returns the body that owns a point of a cell, by brute force.
  [[nodiscard]] BodyId owner(std::size_t cell, const Weights& w) const {
    const auto& problem = owners[cell].problem;
    return BodyId(owners[cell].pure() ? problem.candidates[0].owner : brute_owner(problem, w, 0).owner);
  }

  std::vector<Tetrahedron> frames;
  std::vector<CellOwnership> owners;
};

}  // namespace adamas::test
