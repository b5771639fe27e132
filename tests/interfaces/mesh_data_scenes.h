#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/data/mesh_data.h"
#include "tests/support/hexahedra.h"

namespace adamas::test {

/// Data on a mesh with `count` materials "a", "b", ..., of which material_at(p) tells the number of that at a
/// point. Fractions are those of points spread evenly over the tetrahedra of the cells, which is independent
/// of how interfaces are reconstructed.
inline MeshData sampled_materials(const PolyhedralMesh& mesh, std::size_t count,
                                  const std::function<std::size_t(const Vec3&)>& material_at,
                                  int per_edge = 6) {
  MeshData data;
  data.source = "scene";
  data.mesh = mesh;
  std::vector<std::vector<float>> fractions(count);
  std::vector<double> inside(count);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    std::ranges::fill(inside, 0);
    double all = 0;
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
          inside[material_at(p)] += volume;
        }
      }
    }
    float rest = 1;
    for (std::size_t m = 0; m + 1 < count; ++m) {
      fractions[m].push_back(static_cast<float>(inside[m] / all));
      rest -= fractions[m].back();
    }
    fractions.back().push_back(std::max(rest, 0.0f));
  }
  for (std::size_t m = 0; m < count; ++m) {
    data.materials.push_back(std::string(1, static_cast<char>('a' + m)));
    data.fractions.push_back(std::move(fractions[m]));
  }
  data.normalise();
  return data;
}

/// Data on a mesh whose materials are "a" where f >= 0 and "b" elsewhere.
inline MeshData sampled_data(const PolyhedralMesh& mesh, const std::function<double(const Vec3&)>& f,
                             int per_edge = 6) {
  return sampled_materials(
      mesh, 2, [&](const Vec3& p) -> std::size_t { return f(p) >= 0 ? 0 : 1; }, per_edge);
}

}  // namespace adamas::test
