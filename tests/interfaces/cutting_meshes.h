#pragma once

#include <cmath>
#include <functional>

#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas::test {

using namespace interfaces;

/// Returns a scene that is resampled from volume fractions.
inline ResampledMesh resampled_scene(const std::string& name, std::uint64_t seed, std::size_t cells,
                                     double part_of_diagonal) {
  SceneCase wish;
  wish.name = name;
  wish.seed = seed;
  wish.cells = cells;
  wish.options.interface_error = part_of_diagonal * std::sqrt(3.0);
  ResampledScene resampled(wish);
  ResampledMesh mesh = resampled_mesh(*resampled.resampler);
  return mesh;
}

/// Returns the unit cube as n^3 cubes of six tetrahedra each. There is one interface, between body 0, where
/// the distance is positive, and body 1.
inline ResampledMesh uniform_mesh(std::uint32_t n, const std::function<double(const Vec3&)>& distance) {
  ResampledMesh mesh;
  mesh.source = "uniform";
  mesh.box = {{0, 0, 0}, {1, 1, 1}};
  mesh.materials.assign(2, "");
  mesh.materials[MaterialId(0)] = "outside";
  mesh.materials[MaterialId(1)] = "inside";
  IdVector<BodyId, MaterialId> bodies{MaterialId(0), MaterialId(1)};
  IdVector<InterfaceId, std::array<BodyId, 2>> sides{{BodyId(0), BodyId(1)}};
  mesh.table = InterfaceTable(std::move(bodies), std::move(sides));
  const double h = 1.0 / n;
  const auto number = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return i + (n + 1) * (j + (n + 1) * k);
  };
  for (std::uint32_t k = 0; k <= n; ++k) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i) {
        mesh.points.push_back({i * h, j * h, k * h});
        VertexRecord vertex;
        const double d = distance(mesh.points.back());
        vertex.distances.body = BodyId(d > 0 ? 0 : 1);
        vertex.distances.radius = std::sqrt(3.0) * h;
        if (std::abs(d) <= vertex.distances.radius) vertex.distances.near = {{InterfaceId(0), d}};
        list_known_bodies(mesh.table, vertex.distances);
        mesh.vertices.push_back(vertex);
      }
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (std::uint32_t k = 0; k < n; ++k) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::size_t o = 0; o < 6; ++o) {
          std::array<std::uint32_t, 3> at{i, j, k};
          ResampledMesh::Cell cell{{}, 0, 0, 0.0};
          for (std::size_t step = 0; step < 4; ++step) {
            cell.vertices[step] = number(at[0], at[1], at[2]);
            if (step < 3) ++at[static_cast<std::size_t>(kOrders[o][step])];
          }
          // The last three orders are odd permutations.
          if (o >= 3) std::swap(cell.vertices[2], cell.vertices[3]);
          mesh.cells.push_back(cell);
        }
      }
    }
  }
  mesh.validate("uniform mesh");
  return mesh;
}

}  // namespace adamas::test
