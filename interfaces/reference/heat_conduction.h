#pragma once

#include <functional>
#include <vector>

#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// A problem of steady heat conduction, by which the quality of a mesh for solvers is measured: div(k grad T)
/// = 0 with linear finite elements, a conductivity per body and given temperatures on the box.
struct HeatProblem {
  Box3 box;
  std::vector<double> conductivity;  ///< by body
  std::function<double(const Vec3&)> boundary;
};

/// Returns the temperatures at the points of the mesh, by conjugate gradients, exact to round-off.
std::vector<double> solve_heat_conduction(const ConformingMesh& mesh, const HeatProblem& problem);

/// Estimates, from below, the condition number of the matrix of heat conduction with one conductivity,
/// without the points on the box, from the tridiagonal matrix of conjugate gradients (Golub and Van Loan,
/// 10.2). It is infinite if a tetrahedron is flat or inverted, and 1 if no points are inside the box.
double stiffness_condition_number(const ConformingMesh& mesh, const Box3& box);

}  // namespace adamas::interfaces
