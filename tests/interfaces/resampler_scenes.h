#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/base/parallel.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/hierarchy_validation.h"
#include "tests/support/closed_surface.h"

namespace adamas::test {

using namespace datasets;
using namespace interfaces;

/// A scene with the form in which it is given and the options of resampling.
struct SceneCase {
  std::string name;
  std::uint64_t seed = 0;
  bool meshes = false;    ///< given as interface meshes, else as volume fractions
  std::size_t cells = 8;  ///< cells of the grid along each axis; also the resolution of the meshes
  bool reversed = false;  ///< materials are listed in the opposite order
  bool fields = false;
  ResamplingOptions options;
  int depth = 2;  ///< depth of the integration of fractions
};

inline void reverse_materials(MultiMaterialData& data) {
  std::reverse(data.materials.begin(), data.materials.end());
  std::reverse(data.fractions.begin(), data.fractions.end());
  for (std::uint16_t& label : data.labels)
    label = static_cast<std::uint16_t>(data.materials.size() - 1 - label);
  for (Field& field : data.fields) std::reverse(field.material_values.begin(), field.material_values.end());
}

inline void reverse_materials(InterfaceMesh& mesh) {
  std::reverse(mesh.materials.begin(), mesh.materials.end());
  for (InterfaceTriangle& t : mesh.triangles) {
    for (MaterialId* side : {&t.front, &t.back}) *side = MaterialId(mesh.materials.size() - 1 - side->value);
  }
}

/// A scene with its source and the refined resampler.
struct ResampledScene {
  explicit ResampledScene(const SceneCase& c) : scene(make_scene(c.name, c.seed)) {
    if (!c.meshes || c.fields) {
      SamplingOptions sampling;
      sampling.fields = c.fields;
      sampling.depth = c.depth;
      data = sample_scene(scene, {c.cells, c.cells, c.cells}, sampling);
      if (c.reversed) reverse_materials(data);
    }
    if (c.meshes) {
      // The meshes are finer than the grid, so that the spheres of a shell do not cross.
      mesh = scene_interfaces(scene, scene.spheres().empty() ? 1.0 / static_cast<double>(c.cells) : 1.0 / 24);
      if (c.reversed) reverse_materials(mesh);
      source = make_mesh_source(mesh, scene.box(), c.fields ? &data : nullptr);
    } else {
      source = make_grid_source(data);
    }
    resampler = std::make_unique<Resampler>(source, c.options);
    resampler->refine();
  }
  ResampledScene(const ResampledScene&) = delete;

  [[nodiscard]] const InterfaceTable& table() const { return source.network->table(); }
  [[nodiscard]] double tolerance() const { return 1e-11 * source.box.diagonal(); }
  [[nodiscard]] ExtractedInterfaces extracted() const {
    return extract_interfaces(table(), resampler->cells(), source.box);
  }
  /// Returns the volume of a material, given by name so that different orders of materials can be compared.
  [[nodiscard]] double material_volume(const std::string& material) const {
    const auto bodies = body_volumes(table(), resampler->cells());
    double sum = 0;
    for (BodyId b(0); b.value < bodies.size(); ++b.value) {
      if (source.materials[table().material(b)] == material) sum += bodies[b];
    }
    return sum;
  }

  Scene scene;
  MultiMaterialData data;
  InterfaceMesh mesh;
  ResamplingSource source;
  std::unique_ptr<Resampler> resampler;
};

/// Expects the laws: the hierarchy is sound; the volumes of the pieces add up to the domain's; the extracted
/// interfaces are closed up to the boundary of the domain, with two triangles at every inner edge or as many
/// as bodies meet there; and the volumes that they enclose are those of the pieces.
inline void expect_laws(const ResampledScene& resampled, double volume_tolerance = 1e-9) {
  const Resampler& resampler = *resampled.resampler;
  ASSERT_NO_THROW(validate(resampler.hierarchy()));
  const Box3& box = resampled.source.box;
  const auto bodies = body_volumes(resampled.table(), resampler.cells());
  double sum = 0;
  for (const double volume : bodies) {
    EXPECT_GE(volume, 0);
    sum += volume;
  }
  EXPECT_NEAR(sum, box.volume(), 1e-12 * box.volume());

  const ExtractedInterfaces found = resampled.extracted();
  std::vector<SidedTriangle> triangles;
  for (std::size_t t = 0; t < found.bodies.size(); ++t) {
    triangles.push_back({found.mesh.triangles[t].points, found.bodies[t][0].value, found.bodies[t][1].value});
  }
  const EdgeReport edges = check_edges(found.mesh.points, triangles, box, resampled.tolerance());
  EXPECT_EQ(edges.open, 0u) << edges.first;
  EXPECT_EQ(edges.lonely, 0u) << edges.first;
  EXPECT_EQ(edges.uneven, 0u) << "of " << edges.inner_edges;
  EXPECT_EQ(edges.degenerate, 0u);

  std::uint32_t corner = 0;
  const auto& hierarchy = resampler.hierarchy();
  hierarchy.for_each_vertex([&](VertexId v) {
    if (hierarchy.lattice(v) == hierarchy.domain().extent())
      corner = hierarchy.payload(v).distances.body.value;
  });
  const auto enclosed =
      enclosed_volumes(found.mesh.points, triangles, bodies.size(), box, corner, resampled.tolerance());
  for (BodyId b(0); b.value < bodies.size(); ++b.value)
    EXPECT_NEAR(enclosed[b.value], bodies[b], volume_tolerance * box.volume()) << "body " << b.value;
}

}  // namespace adamas::test
