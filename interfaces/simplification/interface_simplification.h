#pragma once

#include <cstddef>
#include <vector>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

struct SimplificationOptions {
  /// The greatest distance, both ways, of the whole network, of each material's boundary, and of the lines
  /// where three materials meet.
  double error = 0;
  /// Whether the lines where bodies meet and the borders in the sides of the domain are shortened too;
  /// otherwise all points on borders of interfaces stay.
  bool lines = true;
  /// Whether the remaining points are moved to make triangles more regular.
  bool smooth = false;
  /// The least angle of triangles, in degrees. Smaller angles are only allowed where there were such angles
  /// before.
  double least_angle = 8;
};

/// A network of interfaces with fewer triangles.
struct SimplifiedNetwork {
  InterfaceMesh mesh;
  std::vector<std::array<BodyId, 2>> bodies;  ///< the bodies in front of each triangle and behind it
  InterfaceCertificate certificate;           ///< the distances from the original interfaces
  std::size_t triangles_before = 0;
  /// The smallest angle of a triangle before and after, in degrees.
  double smallest_angle_before = 0, smallest_angle = 0;
  /// The number of bodies whose number of pieces or Euler characteristic has changed.
  std::size_t changed_bodies = 0;
  /// The number of pairs of triangles in contact; there are none unless the input had some.
  std::size_t contacts = 0;
  std::size_t runs = 0;  ///< the number of runs; more than one if measured distances were too great
};

/// Returns a source that has only interfaces, in a box: it has no fields and no body_at().
ResamplingSource source_of_interfaces(const InterfaceMesh& mesh, const Box3& box,
                                      std::vector<std::array<BodyId, 2>> sides,
                                      const IdVector<BodyId, MaterialId>& body_materials);

/// Simplifies the interfaces of a source, of which it uses the name, box, materials and network: each
/// interface is decimated by error quadrics and edges are flipped where angles become greater, all within the
/// error (docs/method.md, Simplified interfaces). Bodies keep their topology, no triangles come in contact,
/// and points where lines end or meet stay. The result does not depend on the number of threads. Throws
/// Cancelled if `progress` requests it.
SimplifiedNetwork simplify_interfaces(const ResamplingSource& source, const SimplificationOptions& options,
                                      Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
