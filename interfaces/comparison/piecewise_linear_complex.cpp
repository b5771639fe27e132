#include "interfaces/comparison/piecewise_linear_complex.h"

#include <algorithm>
#include <tuple>

#include "core/base/error.h"

namespace adamas::interfaces {

void PiecewiseLinearComplex::check_closed() const {
  // An entry is an edge of a body's boundary, from its lower point to the other one (1) or back (-1).
  std::vector<std::tuple<BodyId, std::uint32_t, std::uint32_t, int>> edges;
  for (const Triangle& t : triangles) {
    const Patch& patch = patches[t.patch];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t.points[i], b = t.points[(i + 1) % 3];
      const int way = a < b ? 1 : -1;
      if (patch.front.valid()) edges.emplace_back(patch.front, std::min(a, b), std::max(a, b), -way);
      if (patch.back.valid()) edges.emplace_back(patch.back, std::min(a, b), std::max(a, b), way);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    const auto& [body, a, b, first] = edges[begin];
    int sum = 0;
    while (end < edges.size() && std::get<0>(edges[end]) == body && std::get<1>(edges[end]) == a &&
           std::get<2>(edges[end]) == b)
      sum += std::get<3>(edges[end++]);
    if (sum == 0) continue;
    fail("{}: expected interfaces that close with the box, found an open edge at ({:.6g}, {:.6g}, {:.6g})",
         source, points[a].x, points[a].y, points[a].z);
  }
}

}  // namespace adamas::interfaces
