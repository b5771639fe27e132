#pragma once

#include <gtest/gtest.h>

#include <string>

#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/simplification/interface_simplification.h"
#include "tests/support/surface_distance.h"

namespace adamas::test {

using namespace datasets;
using namespace interfaces;

/// Returns the interfaces that are reconstructed from the volume fractions of a scene.
inline ResamplingSource reconstructed_scene(const std::string& name, std::size_t cells,
                                            std::uint64_t seed = 0) {
  SamplingOptions sampling;
  sampling.depth = 2;
  const MultiMaterialData data = sample_scene(make_scene(name, seed), {cells, cells, cells}, sampling);
  Reconstruction result(data);
  return source_of_interfaces(result.mesh(), data.grid.domain(), result.bodies(), result.body_materials());
}

inline SimplificationOptions simplification(double error, bool lines = true, bool smooth = false) {
  SimplificationOptions options;
  options.error = error;
  options.lines = lines;
  options.smooth = smooth;
  return options;
}

inline std::vector<TriangleIndices> corners_of(const InterfaceMesh& mesh) {
  std::vector<TriangleIndices> corners;
  for (const InterfaceTriangle& t : mesh.triangles) corners.push_back(t.points);
  return corners;
}

inline InterfaceMesh interfaces_of(const ResamplingSource& source) {
  return network_mesh(*source.network, source.materials, source.name);
}

/// Returns the triangles that bound a material.
inline std::vector<TriangleIndices> boundary_of(const InterfaceMesh& mesh, MaterialId m) {
  std::vector<TriangleIndices> corners;
  for (const InterfaceTriangle& t : mesh.triangles) {
    if (t.front == m || t.back == m) corners.push_back(t.points);
  }
  return corners;
}

}  // namespace adamas::test
