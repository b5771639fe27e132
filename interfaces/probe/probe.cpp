#include "interfaces/probe/probe.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/fields/grid_field_source.h"
#include "interfaces/mesh/interface_extraction.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kChunk = 256, kFewPoints = 4;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::size_t row_size(const std::vector<FieldInfo>& fields) {
  return fields.empty() ? 0 : fields.back().end();
}

PointSample unknown(const Vec3& p, std::size_t values) {
  return {p, PointSample::kNoMaterial, std::vector<double>(values, kNothing), kNothing};
}

/// Returns a tree of the triangles between materials that cells of the mesh show.
ClosestPointTree interface_tree(const ResampledMesh& mesh, const CellSet& cells) {
  const InterfaceMesh interfaces = extract_interfaces(mesh.table, cells, mesh.box).mesh;
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

/// Returns the distance of a point from the nearest interface, which is extracted from the cells near the
/// point; none if these are more than `most`.
std::optional<double> distance_nearby(const ResampledMesh& mesh, const CellLocator& locator, const Vec3& p,
                                      std::size_t most) {
  if (!is_finite(p)) return kNothing;
  const CellSet all = mesh.cell_set();
  std::vector<std::uint32_t> cells;
  for (double reach = mesh.box.diagonal() / std::cbrt(static_cast<double>(mesh.cells.size()));; reach *= 2) {
    locator.cells_near(p, reach, cells);
    if (cells.size() > most) return {};
    const CellSet some{cells.size(), [&](std::size_t i) { return all.corners(cells[i]); }, all.position,
                       all.distances};
    const double found = distance_from(interface_tree(mesh, some), p);
    if (found <= reach) return found;
  }
}

/// Finds the distances of a few points from the nearest interfaces; returns none if it is less work to
/// extract all interfaces.
std::optional<std::vector<double>> distances_nearby(const ResampledMesh& mesh, const CellLocator& locator,
                                                    std::span<const Vec3> points) {
  constexpr std::size_t kCellsPerPoint = 2048, kParts = 8;
  if (points.size() > mesh.cells.size() / kCellsPerPoint) return {};
  std::vector<double> distances;
  for (const Vec3& p : points) {
    const auto distance = distance_nearby(mesh, locator, p, mesh.cells.size() / kParts);
    if (!distance) return {};
    distances.push_back(*distance);
  }
  return distances;
}

/// Samples a point of an input that lies in its domain.
void sample_body(BodyId body, MaterialId material, const FieldSource* fields, PointSample& sample) {
  sample.body = body.value, sample.material = material.value;
  if (fields != nullptr) fields->values(material, sample.point, sample.values);
}

/// Returns the distances of points from the nearest interfaces of labels; none if some are far from all.
std::optional<std::vector<double>> distances_nearby(const LabelParts& parts, std::span<const Vec3> points) {
  std::vector<double> distances(points.size());
  std::atomic<bool> known = true;
  parallel_for(points.size(), kFewPoints, [&](std::size_t i) {
    if (!known) return;
    const std::optional<double> distance = parts.interface_distance(points[i]);
    if (distance)
      distances[i] = *distance;
    else
      known = false;
  });
  if (!known) return {};
  return distances;
}

/// Makes the fields of labels, each of whose sites keeps its label.
std::unique_ptr<const FieldSource> label_fields(const MultiMaterialData& data) {
  if (data.fields.empty()) return nullptr;
  std::vector<MaterialId> owners(data.grid.site_count());
  const SiteArray<std::uint16_t> labels = data.labels.dense();
  for (std::size_t site = 0; site < owners.size(); ++site) owners[site] = MaterialId(labels[site]);
  return std::make_unique<GridFieldSource>(data, owners);
}

}  // namespace

std::vector<PointSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points) {
  const std::size_t values = row_size(mesh.fields);
  if (points.empty()) return {};
  const std::optional<std::vector<double>> distances = distances_nearby(mesh, locator, points);
  const ClosestPointTree interfaces = distances ? ClosestPointTree() : interface_tree(mesh, mesh.cell_set());
  std::vector<PointSample> samples(points.size());
  parallel_chunks(points.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellOwnership ownership;
    for (std::size_t i = first; i < last; ++i) {
      PointSample& sample = samples[i] = unknown(points[i], values);
      sample.interface_distance = distances ? (*distances)[i] : distance_from(interfaces, points[i]);
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
    sample_body(body, source.network->table().material(body), source.fields.get(), sample);
  });
  return samples;
}

std::optional<std::vector<PointSample>> probe(const MultiMaterialData& data, const LabelParts& parts,
                                              std::span<const Vec3> points) {
  const std::optional<std::vector<double>> distances = distances_nearby(parts, points);
  if (!distances) return {};
  const std::unique_ptr<const FieldSource> fields = label_fields(data);
  const Box3 box = data.grid.domain();
  std::vector<PointSample> samples(points.size());
  parallel_for(points.size(), kChunk, [&](std::size_t i) {
    PointSample& sample = samples[i] = unknown(points[i], fields ? fields->row_size() : 0);
    sample.interface_distance = (*distances)[i];
    if (!box.contains(points[i])) return;
    const BodyId body = parts.bodies().body_at(points[i]);
    sample_body(body, parts.bodies().body_materials()[body], fields.get(), sample);
  });
  return samples;
}

}  // namespace adamas::interfaces
