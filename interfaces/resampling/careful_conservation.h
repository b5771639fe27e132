#pragma once

#include <array>
#include <vector>

#include "interfaces/resampling/movable_interfaces.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/resampling/volume_equations.h"

namespace adamas::interfaces {

/// Finds moves of the interfaces of a state, one offset per body, with which each body has its volume in the
/// input (docs/method.md, Conservation). No cell is split, no interface moves by more than the wanted
/// interface error, and all bodies keep their shapes but for where their boundaries run. The state must
/// outlive this object, its leaves must stay as long as it is used, and what they show must be known.
class CarefulConservation {
 public:
  explicit CarefulConservation(ResamplingState& state);

  /// Finds the moves, within the limits of interfaces(). Bodies that cannot have their volumes keep no others
  /// from theirs; if little is missing, the largest body of their material gets it, so that the material has
  /// its volume.
  void solve();
  /// Returns whether an interface is to be moved.
  [[nodiscard]] bool has_moves() const;
  /// Returns the sum of what bodies lack after solve().
  [[nodiscard]] double missing() const;
  /// Returns the greatest part of a material's volume that is missing after solve().
  [[nodiscard]] double missing_part() const;
  /// Returns whether, after solve(), each body has its volume that has it with the other moves, and little
  /// more is missing.
  [[nodiscard]] bool is_as_good_as(const CarefulConservation& other) const;
  [[nodiscard]] const MovableInterfaces::Moves& moves() const { return moves_; }
  [[nodiscard]] const MovableInterfaces& interfaces() const { return interfaces_; }
  /// Changes what limits the moves that the next solve() finds.
  [[nodiscard]] MovableInterfaces& limits() { return interfaces_; }
  /// Moves the interfaces, unless others would own a part of a leaf by it: vertices that bring that about are
  /// held, and the moves are found anew. Changes the state's distances at vertices and its shifts.
  void move();
  /// Moves all interfaces back to where they were in the beginning.
  void move_back();

 private:
  [[nodiscard]] double enough() const;
  [[nodiscard]] std::array<double, 2> range(InterfaceId i) const;
  void take_steps();
  [[nodiscard]] bool find_heirs();

  ResamplingState& state_;
  MovableInterfaces interfaces_;
  IdVector<BodyId, double> wanted_;       ///< the volumes of the input, which fill the domain
  IdVector<InterfaceId, double> before_;  ///< the state's shifts in the beginning
  MovableInterfaces::Moves moves_;
  UnknownVolumes unknowns_;  ///< what is missing after the moves
};

}  // namespace adamas::interfaces
