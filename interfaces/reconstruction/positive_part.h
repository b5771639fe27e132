#pragma once

#include <array>

namespace adamas {

/// The part of a tetrahedron where a linear function with these values at its corners is positive.
struct PositivePart {
  double volume;                 ///< in relation to the tetrahedron's
  std::array<double, 4> growth;  ///< its derivatives by the values
};

PositivePart positive_part(const std::array<double, 4>& values);

}  // namespace adamas
