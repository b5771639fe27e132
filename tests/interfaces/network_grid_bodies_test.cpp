#include <gtest/gtest.h>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/grid_bodies.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

RectilinearGrid uneven_grid(const Box3& box, std::array<std::size_t, 3> cells, Centering centering) {
  RectilinearGrid grid;
  grid.centering = centering;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i <= cells[a]; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(cells[a]);
      const int axis = static_cast<int>(a);
      grid.nodes[a].push_back(box.min[axis] + box.size()[axis] * (0.7 * t + 0.3 * t * t));
    }
  }
  return grid;
}

void expect_same_as_one_by_one(const InterfaceNetwork& network, const RectilinearGrid& grid) {
  const auto found = bodies_at_sites(network, grid);
  ASSERT_EQ(found.size(), grid.site_count());
  std::size_t wrong = 0, site = 0;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i, ++site)
        wrong += found[site] == network.body_at(grid.site(i, j, k)) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(GridBodies, AreThoseOfEachSite) {
  for (const char* name : {"shell3", "shell2", "plate", "tjunction", "voronoi10"}) {
    const Scene scene = make_scene(name);
    const InterfaceNetwork network(scene_interfaces(scene, 0.05), scene.box());
    for (const Centering centering : {Centering::kCells, Centering::kPoints})
      expect_same_as_one_by_one(network, uneven_grid(scene.box(), {37, 33, 5}, centering));
    expect_same_as_one_by_one(network, uneven_grid(scene.box(), {1, 70, 2}, Centering::kCells));
  }
}

TEST(GridBodies, OpenBordersAreAskedForSiteBySite) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  // A patch ends inside the box; bodies end at its border without a triangle.
  test::add_patch(mesh, {0.2, 0.2, 0.5}, {0.5, 0, 0}, {0, 0.5, 0}, MaterialId(0), MaterialId(1));
  const InterfaceNetwork network(mesh, test::unit_box());
  EXPECT_TRUE(network.has_open_border());
  expect_same_as_one_by_one(network, uneven_grid(test::unit_box(), {20, 20, 20}, Centering::kCells));
}

TEST(GridBodies, BordersOnTheBoxAreNotOpen) {
  for (const char* name : {"tjunction", "voronoi10", "sphere", "plate"}) {
    const Scene scene = make_scene(name);
    EXPECT_FALSE(InterfaceNetwork(scene_interfaces(scene, 0.1), scene.box()).has_open_border()) << name;
  }
}

}  // namespace
}  // namespace adamas
