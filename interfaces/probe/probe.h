#pragma once

#include <span>
#include <vector>

#include "core/base/typed_id.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/cell_locator.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

/// The material, the field values and the distance from an interface at a point.
struct ProbeSample {
  Vec3 point;
  bool inside = false;  ///< in the domain; if not, material and body are invalid and the values NaN
  MaterialId material;
  BodyId body;
  /// All components of all fields, laid out as FieldInfo::offset says; NaN for a field that the material has
  /// not.
  std::vector<double> values;
  /// From the nearest interface that the mesh shows or the source has, in units of length, from wherever the
  /// point lies; NaN where there is no interface, or the point is not finite.
  double interface_distance = 0;
};

/// The samples of a resampled mesh at some points; each material's field up to its interfaces. The same on
/// any number of threads.
std::vector<ProbeSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points);
std::vector<ProbeSample> probe(const ResampledMesh& mesh, std::span<const Vec3> points);

/// The samples of the input itself: of gridded data by make_grid_source.
std::vector<ProbeSample> probe(const ResamplingSource& source, std::span<const Vec3> points);

/// `count` points from a to b, both included, at equal distances. Throws Error for numbers that are not
/// finite and for less than two points or more than 10^8.
std::vector<Vec3> line_points(const Vec3& a, const Vec3& b, std::size_t count);

}  // namespace adamas::interfaces
