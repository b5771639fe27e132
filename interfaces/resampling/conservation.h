#pragma once

#include <array>
#include <vector>

#include "interfaces/resampling/exchanged_volumes.h"
#include "interfaces/resampling/kept_distances.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/resampling/volume_equations.h"

namespace adamas::interfaces {

/// Moves the interfaces of a state, by one offset per body, until each body has its volume in the input
/// (docs/method.md, Conservation). No cell is split, and no interface moves by more than the wanted interface
/// error. The state must outlive this object, and its leaves must stay as long as it is used.
class Conservation {
 public:
  explicit Conservation(ResamplingState& state);

  /// Moves the interfaces. This changes only the state's shifts and the distances at vertices. Bodies that
  /// cannot have their volumes keep no others from theirs.
  void conserve();
  /// Returns whether an interface has been moved.
  [[nodiscard]] bool has_moved() const { return has_moved_; }
  /// Moves all interfaces at the corners of these leaves, and of leaves round them, back to where they were
  /// in the beginning, for good, and closes the volumes again: by moves in a small part of the other leaves,
  /// or, where that is not enough, in all. `rings`: the number of layers of leaves round them.
  void hold(const std::vector<TetrahedronId>& leaves, int rings);
  /// Returns the leaves in which one of the marked bodies has now a part and had none in the beginning, or
  /// the other way round.
  [[nodiscard]] std::vector<TetrahedronId> leaves_gained_or_lost(const IdVector<BodyId, char>& bodies);
  /// Adds the leaves, near interfaces, whose vertices know one of the marked bodies.
  void add_leaves_of(const IdVector<BodyId, char>& bodies, std::vector<TetrahedronId>& leaves) const;
  /// Moves all interfaces back to where they were in the beginning.
  void move_back();

 private:
  using Shifts = IdVector<InterfaceId, double>;

  [[nodiscard]] std::array<double, 2> range(InterfaceId i) const;
  void move_to(const Shifts& moves);
  void begin_moves(const IdVector<VertexId, double>& gains);
  void hold_vertices(const std::vector<TetrahedronId>& leaves, int rings);
  [[nodiscard]] IdVector<VertexId, double> gains_of_few() const;
  void keep_moves();
  void forget_contacts(const LeavesNearInterfaces& leaves);
  UnknownVolumes move(const LeavesNearInterfaces& leaves);

  ResamplingState& state_;
  LeavesNearInterfaces leaves_;
  IdVector<BodyId, double> wanted_;   ///< the volumes of the input, which fill the domain
  KeptDistances before_;              ///< the distances at all vertices in the beginning
  KeptDistances bases_;               ///< those when the present moves began
  IdVector<VertexId, double> gains_;  ///< the part of the present moves that each vertex takes
  Shifts moves_;                      ///< the present moves
  IdVector<VertexId, char> held_;     ///< vertices that are not moved
  UnknownVolumes unknowns_;           ///< what is missing after the last moves
  bool has_moved_ = false;
};

}  // namespace adamas::interfaces
