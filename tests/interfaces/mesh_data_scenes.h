#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/data/mesh_data.h"
#include "tests/support/hexahedra.h"

namespace adamas::test {

/// Data on a mesh whose materials are "a" where f >= 0 and "b" elsewhere; fractions are those of points
/// spread evenly over the tetrahedra of the cells, which is independent of how interfaces are reconstructed.
inline MeshData sampled_data(const PolyhedralMesh& mesh, const std::function<double(const Vec3&)>& f,
                             int per_edge = 6) {
  MeshData data;
  data.source = "scene";
  data.mesh = mesh;
  data.materials.push_back("a");
  data.materials.push_back("b");
  std::vector<float> a, b;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    double inside = 0, all = 0;
    for (const auto face : mesh.faces_of_cell(c)) {
      const auto points = mesh.face(face);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::array<Vec3, 4> x{mesh.cell_center(c), mesh.face_center(face), mesh.points()[points[i]],
                                    mesh.points()[points[(i + 1) % points.size()]]};
        const double volume = std::abs(signed_volume(x[0], x[1], x[2], x[3]));
        for (int n = 0; n < per_edge * per_edge * per_edge; ++n) {
          // Folded points of a cube spread evenly over the tetrahedron (Rocchini and Cignoni, 2000).
          double s = (n % per_edge + 0.5) / per_edge, t = (n / per_edge % per_edge + 0.5) / per_edge,
                 u = (n / (per_edge * per_edge) + 0.5) / per_edge;
          if (s + t > 1) s = 1 - s, t = 1 - t;
          if (t + u > 1) {
            const double old = u;
            u = 1 - s - t;
            t = 1 - old;
          } else if (s + t + u > 1) {
            const double old = u;
            u = s + t + u - 1;
            s = 1 - t - old;
          }
          const Vec3 p = (1 - s - t - u) * x[0] + s * x[1] + t * x[2] + u * x[3];
          all += volume;
          if (f(p) >= 0) inside += volume;
        }
      }
    }
    a.push_back(static_cast<float>(inside / all));
    b.push_back(1 - a.back());
  }
  data.fractions.push_back(std::move(a));
  data.fractions.push_back(std::move(b));
  data.normalise();
  return data;
}

}  // namespace adamas::test
