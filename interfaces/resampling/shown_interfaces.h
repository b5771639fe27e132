#pragma once

#include <vector>

#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/resampling/conservation.h"
#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The interfaces that the leaves of a state show, compared with those of the input.
class ShownInterfaces {
 public:
  /// The state and the conservation must outlive this object.
  ShownInterfaces(ResamplingState& state, Conservation& conservation)
      : state_(state),
        conservation_(conservation),
        comparison_(state.source, state.options.interface_error) {}

  /// Measures the interfaces as the leaves show them now, once volumes agree. `each`: triangles that are too
  /// far are looked for even where no cell may be split for them.
  void measure(bool each = false);
  /// What was last measured.
  [[nodiscard]] const ExtractedInterfaces& extracted() const { return extracted_; }
  [[nodiscard]] const InterfaceComparison& comparison() const { return comparison_; }
  /// Makes the bounds of what was last measured as tight as reports want them.
  [[nodiscard]] InterfaceCertificate finish();
  /// Frees the memory of what was last measured.
  void clear() { extracted_ = {}; }
  /// The leaves where what was measured is, or may be, farther away than wanted.
  [[nodiscard]] std::vector<TetrahedronId> failing_leaves() const;

 private:
  [[nodiscard]] std::vector<TetrahedronId> leaves_with_far_input() const;

  ResamplingState& state_;
  Conservation& conservation_;
  InterfaceComparison comparison_;
  ExtractedInterfaces extracted_;
};

}  // namespace adamas::interfaces
