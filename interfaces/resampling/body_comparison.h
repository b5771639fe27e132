#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/network/body_topology.h"

namespace adamas::interfaces {

/// Returns the topology of `bodies` bodies as extracted interfaces show them.
IdVector<BodyId, BodyTopology> body_topology(ExtractedInterfaces shown, std::size_t bodies,
                                             const Box3& domain);

/// The topology of the input's bodies in the input and in a mesh.
struct BodyReport {
  IdVector<BodyId, BodyTopology> input, mesh;
  /// Whether the Euler characteristics of the two can be compared, because the input's interfaces are closed
  /// within the domain.
  bool comparable = true;
  /// The pairs, ascending, of bodies that touch in the mesh but nowhere in the input.
  std::vector<std::array<BodyId, 2>> contacts;

  /// Returns whether the mesh shows a body in as many pieces as the input, with the same holes and handles.
  [[nodiscard]] bool keeps_topology(BodyId body) const {
    return mesh[body].pieces == input[body].pieces && (!comparable || mesh[body].euler == input[body].euler);
  }
  /// Returns by how many the pieces, holes and handles of a body in the mesh are too many or too few.
  [[nodiscard]] std::size_t torn(BodyId body) const;
};

/// The number of faults of the bodies of a mesh.
struct BodyFaults {
  /// Bodies that the mesh does not show, and contacts that the input does not have.
  std::size_t lost_or_joined = 0;
  std::size_t torn = 0;  ///< pieces, holes and handles that are too many or too few
};

/// Compares the bodies of the input with those that a mesh shows.
class BodyComparison {
 public:
  /// The source must outlive this object.
  explicit BodyComparison(const ResamplingSource& source);

  /// What was found of the bodies of some interfaces.
  struct Findings {
    BodyReport report;
    std::vector<std::uint32_t> contact_triangles;  ///< those between bodies that do not touch in the input
  };

  /// Compares the bodies of these interfaces of a mesh. Later calls of report() and faults() refer to them.
  void measure(const ExtractedInterfaces& shown);
  [[nodiscard]] const Findings& findings() const { return findings_; }
  /// Returns to earlier findings.
  void go_back(Findings findings) { findings_ = std::move(findings); }
  [[nodiscard]] const BodyReport& report() const { return findings_.report; }
  /// Returns the diagonal of a body's bounding box in the input.
  [[nodiscard]] double size(BodyId body) const { return sizes_[body]; }
  /// Returns the faults of the bodies whose size is greater than `size`.
  [[nodiscard]] BodyFaults faults(double size) const;

 private:
  void find_touching();

  const ResamplingSource& source_;
  std::vector<std::array<BodyId, 2>> touching_;  ///< pairs that share a point in the input; ascending
  IdVector<BodyId, double> sizes_;
  Findings findings_;
};

}  // namespace adamas::interfaces
