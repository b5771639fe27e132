#include "tests/support/bisection_reference.h"

#include <algorithm>

namespace adamas::test {
namespace {

std::int64_t squared_length(LatticePoint a, LatticePoint b) {
  std::int64_t sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t d = std::int64_t{a[axis]} - b[axis];
    sum += d * d;
  }
  return sum;
}

/// Adds the six tetrahedra of a cube, one for each way from one end of the cube's diagonal to the other along
/// its edges. Diagonals start where the corner's coordinates, in roots, are all even.
void add_cube(std::array<int, 3> cube, std::vector<ReferenceTetrahedron>& mesh) {
  constexpr std::int32_t kSide = std::int32_t{1} << kRootBits;
  std::array<int, 3> axes{0, 1, 2};
  do {
    LatticePoint p{};
    for (int axis = 0; axis < 3; ++axis) {
      const int x = cube[static_cast<std::size_t>(axis)];
      p[axis] = (x % 2 == 0 ? x : x + 1) * kSide;
    }
    ReferenceTetrahedron t{p, p, p, p};
    for (std::size_t step = 0; step < 3; ++step) {
      const int axis = axes[step];
      p[axis] += cube[static_cast<std::size_t>(axis)] % 2 == 0 ? kSide : -kSide;
      t[step + 1] = p;
    }
    mesh.push_back(sorted(t));
  } while (std::next_permutation(axes.begin(), axes.end()));
}

}  // namespace

ReferenceTetrahedron sorted(ReferenceTetrahedron t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::array<std::size_t, 2> longest_edge(const ReferenceTetrahedron& t) {
  std::array<std::size_t, 2> best{0, 1};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      if (squared_length(t[a], t[b]) > squared_length(t[best[0]], t[best[1]])) best = {a, b};
    }
  }
  return best;
}

LatticePoint midpoint(LatticePoint a, LatticePoint b) {
  return {(a.i + b.i) / 2, (a.j + b.j) / 2, (a.k + b.k) / 2};
}

BisectionReference::BisectionReference(std::array<int, 3> roots, int generations) {
  for (int k = 0; k < roots[2]; ++k) {
    for (int j = 0; j < roots[1]; ++j) {
      for (int i = 0; i < roots[0]; ++i) add_cube({i, j, k}, mesh_);
    }
  }
  for (int generation = 0; generation <= generations; ++generation) {
    std::vector<ReferenceTetrahedron> finer;
    for (const ReferenceTetrahedron& t : mesh_) {
      const auto [a, b] = longest_edge(t);
      const LatticePoint p = midpoint(t[a], t[b]);
      ReferenceDiamond& diamond = diamonds_[p];
      diamond.phase = generation % 3;
      diamond.level = generation / 3;
      diamond.split_edge = {t[a], t[b]};
      diamond.tetrahedra.insert(t);
      if (generation == generations) continue;
      for (const std::size_t replaced : {a, b}) {
        ReferenceTetrahedron half = t;
        half[replaced] = p;
        finer.push_back(sorted(half));
        const auto [x, y] = longest_edge(half);
        const LatticePoint child = midpoint(half[x], half[y]);
        diamond.children.insert(child);
        diamonds_[child].parents.insert(p);
      }
    }
    if (generation < generations) mesh_.swap(finer);
  }
}

}  // namespace adamas::test
