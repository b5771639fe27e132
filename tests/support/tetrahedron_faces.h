#pragma once

#include <utility>
#include <vector>

#include "core/geometry/ownership_problem.h"

namespace adamas::test {

/// Returns the face of the unit weights tetrahedron opposite to a vertex, counter-clockwise seen from
/// outside.
inline std::vector<Weights> outward_face(std::size_t opposite) {
  std::vector<Weights> face;
  for (std::size_t v = 0; v < 4; ++v) {
    if (v == opposite) continue;
    face.push_back({});
    face.back()[v] = 1;
  }
  if (opposite % 2 == 1) std::swap(face[0], face[1]);
  return face;
}

}  // namespace adamas::test
