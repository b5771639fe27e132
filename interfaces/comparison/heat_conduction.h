#pragma once

#include <functional>
#include <vector>

#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// Steady heat conduction by linear finite elements, which shows how good a mesh is for a solver:
/// div(k grad T) = 0 with a conductivity per body and given temperatures on the box.
struct HeatProblem {
  Box3 box;
  std::vector<double> conductivity;  ///< by body
  std::function<double(const Vec3&)> boundary;
};

/// Solves for the temperatures at the points of the mesh, by conjugate gradients to round-off.
std::vector<double> solve_heat_conduction(const ConformingMesh& mesh, const HeatProblem& problem);

/// Estimates, from below, the condition number of the matrix of heat conduction of one conductivity,
/// without the points on the box: from the tridiagonal matrix of conjugate gradients (Golub and Van Loan,
/// 10.2). Infinite where a tetrahedron is flat or inside out; 1 where no points are inside the box.
double stiffness_condition_number(const ConformingMesh& mesh, const Box3& box);

}  // namespace adamas::interfaces
