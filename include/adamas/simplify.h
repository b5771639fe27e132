#pragma once

#include <cstddef>
#include <optional>

#include "adamas/certified_distance.h"
#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

class AdaptiveMesh;
class Input;

/// Options that say how interfaces get fewer triangles (docs/method.md, Simplified interfaces).
struct SimplifyOptions {
  /// The greatest distance between the interfaces before and after, both ways: a length, a part of the
  /// domain's diagonal, or in voxels of the input's grid. None: interfaces are not simplified.
  std::optional<ErrorTarget> error{};
  bool smooth = false;  ///< move points so that triangles become more alike, within the same error
};

/// Describes the result of simplification.
struct SimplificationReport {
  double error_target = 0;  ///< in units of length
  bool smooth = false;
  InterfaceDistances distances;  ///< distances from the interfaces before
  std::size_t triangles_before = 0, triangles = 0;
  double smallest_angle_before = 0, smallest_angle = 0;  ///< smallest angles of a triangle, in degrees
  std::size_t changed_bodies = 0;  ///< bodies with another number of pieces or another Euler characteristic
  std::size_t contacts = 0;        ///< pairs of triangles that touch, as they did before
  std::size_t runs = 0;            ///< number of runs; more than one where measured distances were too great
  double seconds = 0;              ///< duration (wall clock)
  double processor_seconds = 0;    ///< of all threads together
};

/// Simplified interfaces.
struct SimplifiedInterfaces {
  InterfaceTriangles mesh;
  SimplificationReport report;
};

/// Checks options. Throws Error (kUsage) where they do not suit an input: an error that is not positive or
/// not less than the domain's diagonal, or in voxels where the input has no grid; `smooth` without an error.
void check(const SimplifyOptions& options, const Input& input);

/// Simplifies the interfaces that a mesh shows, on top of the mesh's interface error. The result does not
/// depend on the number of threads. Throws Error as check() does, and for options without an error; Cancelled
/// where the progress says so.
SimplifiedInterfaces simplify(const AdaptiveMesh& mesh, const SimplifyOptions& options,
                              Progress& progress = SilentProgress::instance());

}  // namespace adamas
