// Compares the certificate with the distance that CGAL computes by another method, up to the precision that
// is asked of it.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

#include "tests/interfaces/simplification_scenes.h"

namespace adamas {

using namespace interfaces;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// Converts to CGAL's mesh. Each triangle has points of its own, since three may meet at an edge.
Surface to_surface(const InterfaceMesh& mesh) {
  Surface surface;
  for (const InterfaceTriangle& t : mesh.triangles) {
    std::array<Surface::Vertex_index, 3> v;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.points[t.points[c]];
      v[c] = surface.add_vertex(Kernel::Point_3(p.x, p.y, p.z));
    }
    surface.add_face(v[0], v[1], v[2]);
  }
  return surface;
}

TEST(SimplificationCertificate, IsNoLessThanTheDistanceThatCgalFinds) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  for (const auto& [scene, cells, error] :
       {std::tuple{"sphere", 10, 0.02}, std::tuple{"random", 6, 0.04}, std::tuple{"tjunction", 6, 0.03}}) {
    const ResamplingSource source = test::reconstructed_scene(scene, static_cast<std::size_t>(cells), 2);
    const SimplifiedNetwork found = simplify_interfaces(source, test::simplification(error));
    const Surface before = to_surface(test::interfaces_of(source)), after = to_surface(found.mesh);
    const double precision = 0.02 * error;
    double cgal = 0;
    for (const auto& [from, to] : {std::pair{&before, &after}, std::pair{&after, &before}})
      cgal =
          std::max(cgal, pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(*from, *to, precision));
    EXPECT_GE(found.certificate.networks.upper, cgal - precision) << scene;
    EXPECT_LE(found.certificate.networks.lower, cgal + precision) << scene;
  }
}

}  // namespace
}  // namespace adamas
