#include <gtest/gtest.h>

#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Two grains, far apart for their size, lie in one body of the material round them.
TEST(TinyBodies, LieInOneSurrounding) {
  for (const double size : {1e-2, 1e-3, 1e-4}) {
    InterfaceMesh mesh = test::mesh_with_materials(3);
    test::add_sphere(mesh, {0.71, 0.37, 0.25}, size, MaterialId(0), MaterialId(1), 3);
    test::add_sphere(mesh, {0.75, 0.75, 0.5}, 0.1 * size, MaterialId(0), MaterialId(2), 3);
    const InterfaceNetwork network(mesh, test::unit_box());
    EXPECT_EQ(network.table().body_count(), 3u) << size;
  }
}

}  // namespace
}  // namespace adamas
