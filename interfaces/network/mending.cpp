#include "interfaces/network/mending.h"

#include "interfaces/network/check.h"

namespace adamas::interfaces {

namespace {

double size_of(const InterfaceMesh& mesh, const Box3* domain) {
  if (domain != nullptr) return domain->diagonal();
  Box3 box;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const std::uint32_t p : t.points) box.extend(mesh.points[p]);
  }
  return box.diagonal();
}

}  // namespace

InterfaceMending mend_interface_mesh(InterfaceMesh& mesh, const Box3* domain,
                                     const InterfaceMendingOptions& options) {
  check_interface_arrays(mesh);
  InterfaceMending result;
  result.gaps = close_gaps(mesh, domain, options.gaps * size_of(mesh, domain));
  result.coincident = merge_coincident_triangles(mesh, domain, options.tolerant);
  result.turned = turn_wrong_triangles(mesh, domain);
  return result;
}

}  // namespace adamas::interfaces
