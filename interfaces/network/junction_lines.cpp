#include "interfaces/network/junction_lines.h"

#include <algorithm>

namespace adamas {

std::vector<std::array<std::uint32_t, 2>> junction_lines(const InterfaceMesh& mesh) {
  struct Use {
    std::array<std::uint32_t, 2> edge;
    std::uint32_t triangle;
  };
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(p[i], p[(i + 1) % 3]);
      uses.push_back({{low, high}, t});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.edge < b.edge; });
  std::vector<std::array<std::uint32_t, 2>> lines;
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    const InterfaceTriangle& one = mesh.triangles[uses[first].triangle];
    bool third = false;
    for (; last < uses.size() && uses[last].edge == uses[first].edge; ++last) {
      for (const MaterialId m :
           {mesh.triangles[uses[last].triangle].front, mesh.triangles[uses[last].triangle].back})
        third = third || (m != one.front && m != one.back);
    }
    if (third && uses[first].edge[0] != uses[first].edge[1]) lines.push_back(uses[first].edge);
  }
  return lines;
}

}  // namespace adamas
