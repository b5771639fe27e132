#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// Two bodies that touch in a mesh, the lower number first, and the derivative of the volume that they
/// exchange with respect to the difference of their functions.
using Exchange = std::pair<std::array<BodyId, 2>, double>;

/// The volumes of the bodies in the leaves of a state, and what bodies exchange where they touch.
struct ExchangedVolumes {
  IdVector<BodyId, double> volumes;
  std::vector<Exchange> exchanges;  ///< one for each pair of bodies that touch, ascending
};

/// The leaves of a state in which interfaces run, or will run if they are moved a little. Only these are
/// looked at when volumes are computed again after a move.
class LeavesNearInterfaces {
 public:
  /// `reach`: interfaces will not be moved by more than this from where they are now. The state must outlive
  /// this object, and its leaves must stay.
  LeavesNearInterfaces(const ResamplingState& state, double reach);

  /// Computes the volumes and exchanges with the distances that the vertices have now. `gains`: by how much
  /// the functions rise at each vertex where those of a body are raised by 1. `at_contacts`: what is
  /// exchanged in leaves with more than one interface, where that takes exact geometry; it is computed if it
  /// is not set, and serves, nearly right, for further moves with the same gains.
  [[nodiscard]] ExchangedVolumes measure(const IdVector<VertexId, double>& gains,
                                         std::optional<std::vector<Exchange>>& at_contacts) const;
  /// Looks, from now on, only at leaves that have one of these vertices: the others stay as they are.
  void keep_those_at(const IdVector<VertexId, char>& vertices);
  /// Returns those of the marked bodies that own a part of each leaf now, ascending.
  [[nodiscard]] std::vector<std::vector<BodyId>> owners(const IdVector<BodyId, char>& bodies) const;
  [[nodiscard]] const std::vector<TetrahedronId>& leaves() const { return leaves_; }
  /// Returns the leaves at which two bodies exchange volume now, in order.
  [[nodiscard]] std::vector<std::pair<std::array<BodyId, 2>, TetrahedronId>> exchanging_leaves() const;

 private:
  const ResamplingState& state_;
  std::vector<TetrahedronId> leaves_;
  IdVector<BodyId, double> elsewhere_;  ///< the volumes of the bodies in all other leaves
};

}  // namespace adamas::interfaces
