#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>
#include <vector>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/mending.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas::test {

using namespace datasets;
using namespace interfaces;

struct Closed {
  InterfaceMesh mesh;
  Box3 box;
};

/// Meshes without fault: spheres, sheets that end at the domain, and many triple lines.
inline std::vector<Closed> closed_meshes() {
  std::vector<Closed> all(1);
  all[0].mesh = mesh_with_materials(3);
  add_sphere(all[0].mesh, {0.5, 0.5, 0.5}, 0.4, MaterialId(0), MaterialId(1));
  add_sphere(all[0].mesh, {0.5, 0.5, 0.5}, 0.2, MaterialId(1), MaterialId(2));
  all[0].box = unit_box();
  for (const char* name : {"voronoi10", "tjunction", "plate"}) {
    const Scene scene = make_scene(name, 2);
    all.push_back({scene_interfaces(scene, 0.15), scene.box()});
  }
  return all;
}

using Corner = std::array<double, 3>;
using Piece = std::tuple<std::array<Corner, 3>, MaterialId, MaterialId>;

/// The triangles by their corners, whatever their order and numbers.
inline std::multiset<Piece> pieces(const InterfaceMesh& mesh) {
  std::multiset<Piece> all;
  for (const InterfaceTriangle& t : mesh.triangles) {
    std::array<Corner, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.points[t.points[i]];
      c[i] = {p.x, p.y, p.z};
    }
    const bool odd = (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2]));
    std::sort(c.begin(), c.end());
    all.insert(odd ? Piece{c, t.back, t.front} : Piece{c, t.front, t.back});
  }
  return all;
}

inline void expect_same(const InterfaceMesh& mended, const InterfaceMesh& whole) {
  EXPECT_EQ(mended.points, whole.points);
  EXPECT_EQ(mended.triangles, whole.triangles);
}

inline std::size_t changes(const InterfaceMending& m) {
  return m.gaps.points_on_faces.count + m.gaps.welded_points.count + m.gaps.split_edges.count +
         m.coincident.duplicates.count + m.coincident.thin_layers.count + m.coincident.cancelled.count +
         m.coincident.contradictions.count + m.turned.count;
}

}  // namespace adamas::test
