// Splits a hierarchy towards a corner of the unit cube and checks that it is sound.

#include <cstdio>
#include <vector>

#include "interfaces/hierarchy/hierarchy.h"

int main() {
  adamas::Hierarchy<> hierarchy(adamas::Domain({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1}));
  std::vector<adamas::Split> done;
  for (int i = 0; i < 30; ++i) {
    adamas::TetrahedronId corner;
    hierarchy.for_each_leaf([&](adamas::TetrahedronId t) {
      for (const adamas::VertexId v : hierarchy.vertices(t)) {
        if (hierarchy.position(v) == adamas::Vec3{0, 0, 0}) corner = t;
      }
    });
    hierarchy.split(corner, done);
  }
  hierarchy.validate();
  std::printf("%zu tetrahedra\n", hierarchy.leaf_count());
  return hierarchy.leaf_count() > 60 ? 0 : 1;
}
