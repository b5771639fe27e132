#pragma once

#include <span>
#include <vector>

#include "core/base/typed_id.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/cell_locator.h"

namespace adamas::interfaces {

/// The material, the field values and the distance from an interface at a point.
struct ProbeSample {
  Vec3 point;
  /// Whether the point lies in the domain; if not, material and body are invalid and the values NaN.
  bool inside = false;
  MaterialId material;
  BodyId body;
  /// The components of all fields, laid out as FieldInfo::offset says; NaN for a field that the material does
  /// not have.
  std::vector<double> values;
  /// The distance from the nearest interface of the mesh or the source, in units of length; NaN if there is
  /// no interface or the point is not finite.
  double interface_distance = 0;
};

/// Samples a resampled mesh at points, with each material's field up to its interfaces. The result does not
/// depend on the number of threads.
std::vector<ProbeSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points);
std::vector<ProbeSample> probe(const ResampledMesh& mesh, std::span<const Vec3> points);

/// Samples the input; a source of data on a grid is made by make_grid_source.
std::vector<ProbeSample> probe(const ResamplingSource& source, std::span<const Vec3> points);

}  // namespace adamas::interfaces
