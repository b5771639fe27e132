#pragma once

#include <cstddef>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

struct SimplificationOptions {
  /// Greatest distance, both ways, of the whole network, of each material's boundary, and of the lines where
  /// three materials meet.
  double error = 0;
  /// Shortens the lines where bodies meet and the borders in the sides of the domain as well; otherwise all
  /// points on borders of interfaces stay.
  bool lines = true;
  /// Moves points that are left so that triangles become more alike.
  bool smooth = false;
  /// Triangles do not get a smaller angle than that where there was none, in degrees.
  double least_angle = 8;
};

/// A network of interfaces with fewer triangles.
struct SimplifiedInterfaces {
  InterfaceMesh mesh;
  std::vector<std::array<BodyId, 2>> bodies;  ///< in front and behind each triangle
  InterfaceCertificate certificate;           ///< against what was simplified
  std::size_t triangles_before = 0;
  double smallest_angle_before = 0, smallest_angle = 0;  ///< of triangles, in degrees
  /// Bodies whose pieces or Euler characteristic are not what they were.
  std::size_t changed_bodies = 0;
  /// Pairs of triangles in contact, which there were before too.
  std::size_t contacts = 0;
  std::size_t runs = 0;  ///< more than one where distances came out too great somewhere
};

/// A network within its box, for those who have interfaces alone; without fields, and nobody is asked who
/// owns a point.
ResamplingSource source_of_interfaces(const InterfaceMesh& mesh, const Box3& box,
                                      std::vector<std::array<BodyId, 2>> sides,
                                      const IdVector<BodyId, MaterialId>& body_materials);

/// The same of the interfaces that the leaves of a resampler show.
ResamplingSource source_of_approximated_interfaces(const Resampler& resampler,
                                                   Progress& progress = SilentProgress::instance());

/// Fewer triangles for the interfaces of a source, of which only its name, box, materials and network are
/// looked at: interface by interface decimated by error quadrics, edges flipped where angles become greater,
/// all within the error (docs/method.md, Simplified interfaces). Bodies keep their topology, no triangles
/// come in contact, and points where lines end or meet stay. The result does not depend on the number of
/// threads. Throws Cancelled where `progress` says so.
SimplifiedInterfaces simplify_interfaces(const ResamplingSource& source, const SimplificationOptions& options,
                                         Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
