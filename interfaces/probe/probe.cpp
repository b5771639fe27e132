#include "interfaces/probe/probe.h"

#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kChunk = 256;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::size_t row_size(const std::vector<FieldInfo>& fields) {
  return fields.empty() ? 0 : fields.back().end();
}

PointSample unknown(const Vec3& p, std::size_t values) {
  return {p, PointSample::kNoMaterial, std::vector<double>(values, kNothing), kNothing};
}

/// Returns a tree of the triangles between materials that the mesh shows.
ClosestPointTree interface_tree(const ResampledMesh& mesh) {
  const InterfaceMesh interfaces = approximated_interfaces(mesh).mesh;
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(interfaces.triangles.size());
  for (const InterfaceTriangle& t : interfaces.triangles) {
    if (t.front != t.back) triangles.push_back(t.points);
  }
  return {interfaces.points, triangles};
}

double distance_from(const ClosestPointTree& interfaces, const Vec3& p) {
  const auto closest = interfaces.closest(p);
  return closest ? std::sqrt(closest->squared_distance) : kNothing;
}

}  // namespace

std::vector<PointSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points) {
  const std::size_t values = row_size(mesh.fields);
  if (points.empty()) return {};
  const ClosestPointTree interfaces = interface_tree(mesh);
  std::vector<PointSample> samples(points.size());
  parallel_chunks(points.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellOwnership ownership;
    for (std::size_t i = first; i < last; ++i) {
      PointSample& sample = samples[i] = unknown(points[i], values);
      sample.interface_distance = distance_from(interfaces, points[i]);
      const auto location = locator.locate(points[i]);
      if (!location) continue;
      mesh.ownership(location->cell, ownership);
      const std::uint32_t owner = ownership.pure() ? ownership.problem.candidates[0].owner
                                                   : ownership.problem.owner(location->weights);
      sample.body = owner;
      sample.material = mesh.table.material(BodyId(owner)).value;
      for (std::size_t c = 0; c < values; ++c)
        sample.values[c] = mesh.value(location->cell, BodyId(owner), c, location->weights);
    }
  });
  return samples;
}

std::vector<PointSample> probe(const ResampledMesh& mesh, std::span<const Vec3> points) {
  return probe(mesh, CellLocator(mesh), points);
}

std::vector<PointSample> probe(const ResamplingSource& source, std::span<const Vec3> points) {
  const std::size_t values = source.fields ? source.fields->row_size() : 0;
  std::vector<PointSample> samples(points.size());
  parallel_for(points.size(), kChunk, [&](std::size_t i) {
    const Vec3& p = points[i];
    PointSample& sample = samples[i] = unknown(p, values);
    sample.interface_distance = distance_from(source.network->tree(), p);
    if (!source.box.contains(p)) return;
    const BodyId body = source.body_at(p, nullptr);
    const MaterialId material = source.network->table().material(body);
    sample.body = body.value, sample.material = material.value;
    if (source.fields) source.fields->values(material, p, sample.values);
  });
  return samples;
}

}  // namespace adamas::interfaces
