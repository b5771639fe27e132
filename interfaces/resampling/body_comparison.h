#pragma once

#include <array>
#include <vector>

#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/network/body_topology.h"

namespace adamas::interfaces {

/// The topology of so many bodies as extracted interfaces show them.
IdVector<BodyId, BodyTopology> body_topology(const ExtractedInterfaces& shown, std::size_t bodies,
                                             const Box3& domain);

/// What became of the bodies of the input in a mesh.
struct BodyReport {
  IdVector<BodyId, BodyTopology> input, mesh;
  /// Whether the characteristics of the two can be compared: the input's interfaces are closed within the
  /// domain.
  bool comparable = true;
  /// Pairs of bodies that touch in the mesh, but nowhere in the input; ascending.
  std::vector<std::array<BodyId, 2>> contacts;

  /// Whether the mesh shows a body in as many pieces as the input, with the same holes and handles.
  [[nodiscard]] bool kept(BodyId body) const {
    return mesh[body].pieces == input[body].pieces && (!comparable || mesh[body].euler == input[body].euler);
  }
};

/// The number of faults of the bodies of a mesh.
struct BodyFaults {
  std::size_t lost_or_joined =
      0;                 ///< bodies that the mesh does not show, and contacts that the input does not have
  std::size_t torn = 0;  ///< pieces, holes and handles that are too many or too few
};

/// Compares the bodies of the input with those that a mesh shows.
class BodyComparison {
 public:
  /// The source must outlive this object.
  explicit BodyComparison(const ResamplingSource& source);

  /// Compares the bodies of these interfaces of a mesh; report() and faults() are about them from then on.
  void measure(const ExtractedInterfaces& shown);
  [[nodiscard]] const BodyReport& report() const { return report_; }
  /// The measured triangles between bodies that do not touch in the input.
  [[nodiscard]] const std::vector<std::uint32_t>& contact_triangles() const { return contact_triangles_; }
  /// The diagonal of a body's bounding box in the input.
  [[nodiscard]] double size(BodyId body) const { return sizes_[body]; }
  /// The faults of the bodies whose size is greater than this.
  [[nodiscard]] BodyFaults faults(double size) const;

 private:
  void find_touching();

  const ResamplingSource& source_;
  std::vector<std::array<BodyId, 2>> touching_;  ///< pairs that share a point in the input; ascending
  IdVector<BodyId, double> sizes_;
  BodyReport report_;
  std::vector<std::uint32_t> contact_triangles_;
};

}  // namespace adamas::interfaces
