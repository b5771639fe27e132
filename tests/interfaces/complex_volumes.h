#pragma once

#include <cstddef>

#include "interfaces/comparison/piecewise_linear_complex.h"

namespace adamas::interfaces {

/// Returns the volume inside the boundary of each body of a complex. `bodies`: the number of bodies.
inline IdVector<BodyId, double> enclosed_volumes(const PiecewiseLinearComplex& complex, std::size_t bodies) {
  IdVector<BodyId, double> volumes(bodies, 0.0);
  const Vec3 middle = complex.box.center();
  for (const PiecewiseLinearComplex::Triangle& t : complex.triangles) {
    const double volume = signed_volume(complex.points[t.points[0]], complex.points[t.points[1]],
                                        complex.points[t.points[2]], middle);
    // Normals point out of the body on the triangle's back.
    if (complex.patches[t.patch].front.valid()) volumes[complex.patches[t.patch].front] += volume;
    if (complex.patches[t.patch].back.valid()) volumes[complex.patches[t.patch].back] -= volume;
  }
  return volumes;
}

}  // namespace adamas::interfaces
