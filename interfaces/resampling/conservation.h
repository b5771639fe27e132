#pragma once

#include <vector>

#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Moves the interfaces of a state, by one offset per body, until each body has its volume in the input. No
/// interface moves by more than the wanted interface error.
class Conservation {
 public:
  /// The state must outlive this object.
  explicit Conservation(ResamplingState& state);

  /// Moves the interfaces. This changes only the state's shifts and the distances at vertices.
  void conserve();
  /// Returns leaves whose splitting may bring bodies closer to their volumes: those with the greatest
  /// estimates among the leaves at bodies whose volumes conserve() could not reach. There are none if an
  /// error of volumes is given, as it is a better criterion.
  [[nodiscard]] std::vector<TetrahedronId> leaves_of_unconserved_bodies() const;
  /// Reduces the bounds of the shifts of all interfaces of bodies that are too far from the input's although
  /// cells are as fine as they may be. Returns whether any interface was shifted by more.
  bool allow_smaller_shifts(const ExtractedInterfaces& shown, const InterfaceComparison& comparison);

 private:
  void shift_interfaces(const IdVector<BodyId, double>& raised);

  ResamplingState& state_;
  IdVector<InterfaceId, double> most_shifts_;  ///< bounds of the state's shifts
  IdVector<BodyId, char> unconserved_;         ///< marks the bodies whose volumes could not be reached
};

}  // namespace adamas::interfaces
