#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/input.h"
#include "adamas/progress.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// The material and the field values at a point.
struct PointSample {
  static constexpr std::uint32_t kNoMaterial = 0xffffffffu, kNoBody = 0xffffffffu;

  Vec3 point;
  std::uint32_t material = kNoMaterial;  ///< its number; kNoMaterial outside of the domain
  /// The components of all fields, in the order of the fields; NaN outside of the domain, and for a field
  /// that the material does not have.
  std::vector<double> values;
  /// The distance from the nearest interface, in units of length; NaN where there is no interface or the
  /// point is not finite.
  double interface_distance = 0;
  /// The body (InterfaceTriangles::bodies) in the mesh or the input; kNoBody outside of the domain.
  std::uint32_t body = kNoBody;

  /// Returns whether the point lies in the domain.
  [[nodiscard]] bool inside() const { return material != kNoMaterial; }
};

/// The materials and the field values at several points.
struct PointSamples {
  std::vector<std::string> materials;    ///< their names, by number
  std::vector<FieldDescription> fields;  ///< descriptions of the fields of `values`
  std::vector<PointSample> points;       ///< the samples, in the order in which points were asked for
};

/// Returns `count` points from a to b, both included, at equal distances. Throws Error for numbers that are
/// not finite and for less than two points or more than 10^8.
std::vector<Vec3> line_points(const Vec3& a, const Vec3& b, std::size_t count);

/// Writes samples as a table of comma-separated values: x, y, z, material, interface distance and the
/// components of all fields, below a line of names with units. Cells without a value are empty.
std::string to_csv(const PointSamples& samples);

/// Returns the material that owns each point of a mesh, and its fields there, each up to its interfaces. The
/// result does not depend on the number of threads. Notes how many points lie outside of the domain.
PointSamples probe(const AdaptiveMesh& mesh, std::span<const Vec3> points,
                   Progress& progress = SilentProgress::instance());

/// Returns the material that owns each point of an input according to its reconstructed or given interfaces,
/// and the fields there. Notes how many points lie outside of the domain. Throws Error where the options do
/// not suit the input, at interfaces that cannot be used (resample()), and Cancelled where the progress says
/// so.
PointSamples probe(const Input& input, std::span<const Vec3> points, const ReconstructOptions& options = {},
                   Progress& progress = SilentProgress::instance());

/// The volume of a material, and the integrals of its fields over its part of the domain.
struct MaterialTotals {
  std::string name;
  double volume = 0;  ///< in the cube of the unit of length
  /// The integral and the mean of each component of all fields, in the order of the fields; NaN for a field
  /// that the material does not have, means also where it has no volume.
  std::vector<double> integrals, means;
};

/// Integrates over a mesh. The result is exact but for round-off: fields are linear on each part of a cell.
std::vector<MaterialTotals> material_totals(const AdaptiveMesh& mesh);

/// Returns the volumes and integrals of the input that a mesh was made of: for data on a grid with materials
/// those of the next function, else only the volumes that closed interfaces enclose, or that a hierarchy was
/// saved with. Empty where they are not known or the input is not kept.
std::vector<MaterialTotals> input_totals(const AdaptiveMesh& mesh);

/// Integrates over data on a grid: sums over the sites of volume times fraction times value. The value of a
/// mixed field counts for each material of the site. Throws Error as check() does.
std::vector<MaterialTotals> material_totals(const GridData& data);

/// The samples of an input at points and the integrals over its domain.
struct InputProbe {
  PointSamples samples;
  /// The integrals of each material: for data on a grid those of material_totals(); for given interfaces
  /// without materials on a grid only the volumes, and empty where the interfaces are not closed.
  std::vector<MaterialTotals> totals;
  /// The triangles and areas of given interfaces without materials on a grid; none for other inputs.
  std::optional<std::vector<InterfaceArea>> interfaces;
};

/// Samples an input as probe() does, and integrates over it; interfaces are reconstructed, or mended, once.
InputProbe probe_and_integrate(const Input& input, std::span<const Vec3> points,
                               const ReconstructOptions& options = {},
                               Progress& progress = SilentProgress::instance());

}  // namespace adamas
