#pragma once

#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// Estimates, from below, the condition number of the matrix of heat conduction by linear finite elements
/// with one conductivity, without the points on the box, from the tridiagonal matrix of conjugate gradients
/// (Golub and Van Loan, 10.2). It is infinite if a tetrahedron is flat or inverted, and 1 if no points are
/// inside the box.
double stiffness_condition_number(const ConformingMesh& mesh, const Box3& box);

}  // namespace adamas::interfaces
