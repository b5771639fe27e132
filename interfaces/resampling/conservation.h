#pragma once

#include <vector>

#include "interfaces/resampling/interface_comparison.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Moves the interfaces of a state, by one offset per body, until each body has the volume that it has in the
/// input. No interface moves by more than the interface error that is wanted.
class Conservation {
 public:
  /// The state must outlive this object.
  explicit Conservation(ResamplingState& state);

  /// Moves the interfaces; changes the state's shifts and the distances at vertices alone.
  void conserve();
  /// Leaves whose finer parts may bring bodies closer to their volumes: those with the greatest estimates
  /// among the leaves at bodies that conserve() could not give theirs. None where an error of volumes is
  /// wanted, which is a better guide.
  [[nodiscard]] std::vector<TetrahedronId> leaves_of_unconserved_bodies() const;
  /// Lets volumes give way where interfaces are too far from the input's though cells are as fine as they may
  /// be: all interfaces of the bodies there may be moved less from now on. Returns whether any was moved by
  /// more.
  bool allow_smaller_shifts(const ExtractedInterfaces& shown, const InterfaceComparison& comparison);

 private:
  void shift_interfaces(const IdVector<BodyId, double>& raised);

  ResamplingState& state_;
  IdVector<InterfaceId, double> most_shifts_;  ///< bounds of the state's shifts
  IdVector<BodyId, char> unconserved_;         ///< bodies that could not be given their volumes
};

}  // namespace adamas::interfaces
