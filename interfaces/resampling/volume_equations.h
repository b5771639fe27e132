#pragma once

#include <array>
#include <functional>
#include <vector>

#include "interfaces/input/resampling_source.h"
#include "interfaces/resampling/exchanged_volumes.h"

namespace adamas::interfaces {

/// Volumes agree if they differ by at most this, relative to the domain's volume.
constexpr double kVolumesAgree = 2e-11;

/// What is known of a body's volume while interfaces are moved.
struct UnknownVolume {
  double missing = 0;  ///< the body's volume in the input, scaled, minus that in the mesh
  double damping = 0;  ///< makes the body's steps smaller
  int failures = 0;    ///< the last steps that have not brought the body nearer to its volume
  BodyId heir;         ///< the body that gets what this one cannot have; none if that gets lost

  [[nodiscard]] bool is_given_up() const;
  void give_up();
  /// Changes the damping after a large step that leaves this volume missing. `small`: what is no failure.
  void judge(double now, double small);
};
using UnknownVolumes = IdVector<BodyId, UnknownVolume>;

/// Returns, for each body, the largest one of those that exchange volume with it, directly or not; for one
/// that is alone, itself. Those that are given up count as smaller.
IdVector<BodyId, BodyId> largest_bodies(const std::vector<Exchange>& exchanges,
                                        const UnknownVolumes& unknowns,
                                        const IdVector<BodyId, double>& wanted);
/// Returns the volumes of a source's bodies, scaled so that they fill the domain.
IdVector<BodyId, double> filling_volumes(const ResamplingSource& source);

/// How the volumes of bodies depend on moves of interfaces, one move for each.
struct VolumeEquations {
  using Moves = IdVector<InterfaceId, double>;

  const InterfaceTable& table;
  const IdVector<BodyId, double>& wanted;
  double enough = 0;        ///< a body has its volume if it lacks at most this
  int most_steps = 0;       ///< the greatest number of steps
  int most_idle_steps = 0;  ///< steps end when so many of them, one after another, have left nearly as much
  /// Returns the least and the greatest move of an interface.
  std::function<std::array<double, 2>(InterfaceId)> range;
  /// Computes the volumes and exchanges after moves.
  std::function<ExchangedVolumes(const Moves&)> measure;
};

/// Changes the moves by Newton's method, all interfaces of a body together, until volumes agree or get no
/// better; bodies whose volumes cannot be met are given up. `unknowns`: what is known of the bodies after the
/// moves.
void solve_equations(const VolumeEquations& equations, VolumeEquations::Moves& moves,
                     UnknownVolumes& unknowns);

}  // namespace adamas::interfaces
